#pragma once
// Doubles: triangles with the same three vertices as an earlier triangle, for example a sheet modeled from both sides.
// A packed stream stores them as runs of references to the earlier triangles.

#include <cstdint>
#include <optional>
#include <vector>

#include "lacedring/lacedring.hpp"

namespace lacedring {

struct Doubles {
    struct Double {
        std::uint32_t triangle;  ///< its number in the mesh
        std::uint32_t of;        ///< the first triangle with the same vertices
        /// Rank among the triangles with these vertices, from 0; doubles are sorted by it.
        std::uint32_t turn;
        bool turned;  ///< has the opposite orientation of `of`
    };
    std::vector<Double> doubles;
    std::vector<std::uint32_t> triangle;  ///< the mesh's number of each triangle of `table`
    CornerTable table;                    ///< the mesh without its doubles
};

/// Returns nothing if there are too few doubles to save space. A mesh without non-manifold edges is not searched: a
/// double there can only form a component of two triangles. Cost: O(T) time, 20 bytes per triangle.
std::optional<Doubles> find_doubles(const CornerTable& table);

/// Turns a stream of doubles.table into a stream of the whole mesh.
void add_doubles(EncodedPacked& stream, const Doubles& doubles);

}  // namespace lacedring
