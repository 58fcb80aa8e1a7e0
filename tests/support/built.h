#pragma once
// Builds a corner table, or fails the test.

#include <doctest/doctest.h>

#include <utility>
#include <vector>

#include "lacedring/mesh.hpp"
#include "lacedring/topology.hpp"

namespace lacedring::test {

inline CornerTable build(const std::vector<std::uint32_t>& indices, std::uint32_t vertex_count) {
    Result<CornerTable> table = build_corner_table(indices, vertex_count);
    REQUIRE(table);
    return std::move(*table);
}
inline CornerTable build(const Mesh& mesh) {
    return build(mesh.indices, mesh.vertex_count);
}

}  // namespace lacedring::test
