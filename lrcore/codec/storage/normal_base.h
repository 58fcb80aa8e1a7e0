#pragma once
// The normals of the surface, as octahedral integers. The storage form codes normals as differences from them. Internal
// to lrcore. Specified in docs/storage-format.md.

#include <cstdint>
#include <span>
#include <vector>

#include "lrcore/codec/storage/vertex_places.h"

namespace lacedring::storage {

/// Which triangle normals are summed for a copy, and their weights.
struct NormalBase {
    bool by_angle = false;   ///< weight by the angle at the copy
    bool by_area = false;    ///< weight by area
    bool of_vertex = false;  ///< sum the triangles of all copies of the vertex
};

/// Computes two octahedral integers of `bits` bits (2 to 16) for each of `copies`. Requires has_places(places, copies).
/// `triangles`: three copies each. Cost: O(triangles + copies); about 50 bytes per copy.
std::vector<std::uint32_t> surface_normals(const VertexPlaces& places, std::span<const std::uint32_t> triangles,
                                           std::uint32_t copies, const NormalBase& base, std::uint32_t bits);

/// Replaces octahedral integers, two per copy, by their differences from the base. If the base points down, both are
/// turned over first: otherwise close points could be at opposite borders of the square.
void subtract_normals(std::span<std::uint32_t> values, std::span<const std::uint32_t> base, std::uint32_t bits);
void add_normals(std::span<std::uint32_t> values, std::span<const std::uint32_t> base, std::uint32_t bits);

/// The base with the fewest bits of differences.
NormalBase nearest_base(const VertexPlaces& places, std::span<const std::uint32_t> triangles,
                        std::span<const std::uint32_t> values, std::uint32_t bits);

}  // namespace lacedring::storage
