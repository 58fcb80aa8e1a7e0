#pragma once
// Doubles: triangles whose three vertices an earlier triangle has, as where both sides of a sheet were modelled. A
// packed stream has them as runs of that other triangle's numbers.

#include <cstdint>
#include <optional>
#include <vector>

#include "lacedring/lacedring.hpp"

namespace lacedring {

struct Doubles {
    struct Double {
        std::uint32_t triangle;  ///< of the mesh
        std::uint32_t of;        ///< the first one with its vertices
        std::uint32_t turn;      ///< how many others come between, which is the order of their runs
        bool turned;             ///< the other way round than `of`
    };
    std::vector<Double> doubles;
    std::vector<std::uint32_t> triangle;  ///< of the mesh, of each triangle of `table`
    CornerTable table;                    ///< of the mesh without its doubles
};

/// None if there are too few to save anything. A mesh without non-manifold edges is not searched: two triangles of one
/// component that both have its only three edges are all that it could have. Cost: O(T) time, 20 bytes a triangle.
std::optional<Doubles> find_doubles(const CornerTable& table);

/// From a stream of doubles.table to one of the whole mesh.
void add_doubles(EncodedPacked& stream, const Doubles& doubles);

}  // namespace lacedring
