#pragma once
// What meshoptimizer's orders can be asked for.

#include <cstdint>
#include <span>

#include "lrcore/base/result.h"

namespace lr {

/// How many triangles the vertices have.
struct Valences {
    std::uint64_t squares = 0;  ///< sum over the vertices
    std::uint64_t triangles = 0;
    std::uint32_t most = 0;  ///< at one vertex

    /// May what takes time quadratic in a vertex's triangles be run? 64 a triangle, where real meshes have 18 to 40,
    /// and what one vertex of 2,048 triangles has.
    bool moderate() const { return squares <= 64 * triangles + std::uint64_t{2048} * 2048; }
};
/// Cost: O(T), 4 bytes a vertex.
Valences count_valences(std::span<const std::uint32_t> indices, std::uint32_t vertex_count);

/// Is the mesh one for meshoptimizer's orders (for the vertex cache, for strips, of meshlets)? Each triangle that they
/// take makes them look at all that are left at its vertices: a fan of 100,000 takes minutes. Cost: that of
/// count_valences. Errors: too_large (the valences are not moderate).
Result<void> check_valences(std::span<const std::uint32_t> indices, std::uint32_t vertex_count);

/// Is the mesh one for meshlets, beside that? Where a component ends, the next triangle is looked for by its place,
/// among all that lie at the same one. `positions` has three a vertex. Cost: O(T log T), 8 bytes a triangle. Errors:
/// too_large, with the largest number of triangles at one place.
Result<void> check_places(std::span<const std::uint32_t> indices, std::span<const float> positions);

}  // namespace lr
