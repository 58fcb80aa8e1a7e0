#pragma once
// Triangle classes, offsets and lines for the views that show the ring. Paper: LR 2011, section 4.3 and Figure 1.

#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/streams.hpp"

namespace lacedring::gpu {

/// LR_CLASS_* (shaders/shared.h), one byte per slot. Cost: O(slots). The stream must be valid.
std::vector<std::uint8_t> slot_classes(const LeanView& lean);

/// Significant bits of each slot's offset along the rings (lrlab/paper/offsets.h), or LR_OFFSET_*. Paper: section 6.1
/// and Figure 8. Cost: O(slots). The stream must be valid.
std::vector<std::uint8_t> slot_offset_bits(const LeanView& lean);

/// Reorders one byte per slot to one byte per triangle of the mesh; LR_CLASS_NONE for triangles without a slot.
std::vector<std::uint8_t> of_triangles(std::span<const std::uint8_t> by_slot,
                                       std::span<const std::uint32_t> slot_triangle, std::size_t triangles);

/// Every edge of the triangles once, as pairs (smaller vertex, larger vertex), sorted. Cost: O(T log T), 24 bytes per
/// triangle.
std::vector<std::uint32_t> mesh_edges(std::span<const std::uint32_t> indices);

/// The seam edges: edges of the surface whose triangles use different vertices of the mesh. Returns pairs of mesh
/// vertices, sorted by surface edge; `surface` is Surface::vertex_of. Cost: O(T log T), 48 bytes per triangle.
std::vector<std::uint32_t> seam_lines(std::span<const std::uint32_t> indices, std::span<const std::uint32_t> surface);

/// The rings as pairs (v, v.n) of ring vertices.
std::vector<std::uint32_t> ring_lines(const LeanView& lean);

}  // namespace lacedring::gpu
