#pragma once
// The normals of the surface, as octahedral integers: the storage form codes how far stored normals are from them.
// Internal to lrcore; docs/storage-format.md has it to the bit.

#include <cstdint>
#include <span>
#include <vector>

#include "lrcore/codec/storage/vertex_places.h"

namespace lacedring::storage {

/// The weights of the triangles whose normals are summed for a copy, and the set of these triangles.
struct NormalBase {
    bool by_angle = false;   ///< by the angle at the copy
    bool by_area = false;    ///< by their area
    bool of_vertex = false;  ///< those of all copies of the vertex
};

/// Two octahedral integers of `bits` bits, 2 to 16, for each of `copies`, which have places. `triangles` name copies.
/// Cost: O(triangles + copies); some 50 bytes a copy.
std::vector<std::uint32_t> surface_normals(const VertexPlaces& places, std::span<const std::uint32_t> triangles,
                                           std::uint32_t copies, const NormalBase& base, std::uint32_t bits);

/// Makes differences from the base of octahedral integers, two a copy each. Where the base points down, both are turned
/// over first: else points that are near each other could lie at opposite borders of the square.
void subtract_normals(std::span<std::uint32_t> values, std::span<const std::uint32_t> base, std::uint32_t bits);
void add_normals(std::span<std::uint32_t> values, std::span<const std::uint32_t> base, std::uint32_t bits);

/// The base from which normals differ least, by the bits of the differences.
NormalBase nearest_base(const VertexPlaces& places, std::span<const std::uint32_t> triangles,
                        std::span<const std::uint32_t> values, std::uint32_t bits);

}  // namespace lacedring::storage
