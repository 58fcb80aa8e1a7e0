#pragma once
// Finds meshes for which meshoptimizer or Draco would take quadratic time.

#include <cstdint>
#include <span>
#include <string_view>

#include "lacedring/base.hpp"

namespace lacedring {

/// Numbers of triangles at the vertices of a mesh.
struct Valences {
    std::uint64_t squares = 0;  ///< sum of squares over the vertices
    std::uint64_t triangles = 0;
    std::uint32_t most = 0;  ///< largest number at one vertex

    /// Returns whether an algorithm that is quadratic in the valence may be run: the sum of squares is at most 64 a
    /// triangle (real meshes have 18 to 40), plus that of one vertex of 2,048 triangles.
    bool moderate() const { return squares <= 64 * triangles + std::uint64_t{2048} * 2048; }
};
/// Cost: O(T), 4 bytes a vertex.
Valences count_valences(std::span<const std::uint32_t> indices, std::uint32_t vertex_count);

/// Checks that the algorithms of `rival` take linear time. For each triangle, meshoptimizer's (vertex cache, strips,
/// meshlets) visit all remaining triangles at its vertices: a fan of 100,000 takes minutes. For each edge, Draco's
/// encoder visits all edges of its vertex. Cost: that of count_valences. Errors: too_large (the valences are not
/// moderate).
Result<void> check_valences(std::span<const std::uint32_t> indices, std::uint32_t vertex_count,
                            std::string_view rival = "meshoptimizer");

/// Checks that making meshlets of a mesh with many components takes linear time. After each component, meshoptimizer
/// searches a triangle by its centroid and visits all triangles that have this centroid. `positions` has 3 floats a
/// vertex. Cost: O(T log T), 8 bytes a triangle. Errors: too_large.
Result<void> check_places(std::span<const std::uint32_t> indices, std::span<const float> positions);

}  // namespace lacedring
