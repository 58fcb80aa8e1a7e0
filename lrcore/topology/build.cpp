// Computes O from V (Rossignac's chapter), for any triangle soup.

#include "lacedring/topology.hpp"
#include "lrcore/base/message.h"
#include "lrcore/topology/edges.h"

namespace lacedring {

Result<CornerTable> build_corner_table(std::span<const std::uint32_t> indices, std::uint32_t vertex_count) {
    constexpr std::uint32_t kMostVertices = 1U << 29;
    // split_fans adds at most one vertex per corner; the total must fit in 32 bits.
    constexpr std::size_t kMostCorners = UINT32_MAX - 1;
    if (indices.size() % 3 != 0) {
        return Error{ErrorCode::invalid_argument,
                     detail::message(indices.size(), " indices are not a whole number of triangles")};
    }
    if (vertex_count > kMostVertices) {
        return Error{ErrorCode::too_large,
                     detail::message(vertex_count, " vertices; at most ", kMostVertices, " are supported")};
    }
    if (indices.size() > kMostCorners - vertex_count) {
        return Error{ErrorCode::too_large,
                     detail::message(indices.size() / 3, " triangles; at most ", (kMostCorners - vertex_count) / 3,
                                     " are supported with ", vertex_count, " vertices")};
    }
    CornerTable table;
    table.vertex_count = vertex_count;
    table.corners.resize(indices.size());
    for (std::size_t i = 0; i < table.corners.size(); ++i) {
        if (indices[i] >= vertex_count) {
            return Error{ErrorCode::malformed,
                         detail::message("triangle ", i / 3, ": vertex ", indices[i], " of ", vertex_count)};
        }
        table.corners[i] = {VertexId{indices[i]}, kNullCorner};
    }
    for (std::uint32_t t = 0; t < table.triangle_count(); ++t) {
        if (table.degenerate(TriangleId{t})) ++table.topology.degenerate;
    }
    NonManifoldEdges nonmanifold;
    if (join_edges(table, nonmanifold)) orient(table);
    pair_nonmanifold(table, nonmanifold);
    return table;
}

std::string check_corner_table(const CornerTable& table) {
    if (table.corners.size() % 3 != 0) return "not three corners per triangle";
    for (std::uint32_t i = 0; i < table.corners.size(); ++i) {
        if (table.corners[i].vertex.value >= table.vertex_count) return detail::message("V[", i, "] is no vertex");
        const CornerId c{i}, o = table.corners[i].opposite;
        if (o.is_null()) continue;
        if (o.value >= table.corners.size() || table.corners[o.value].opposite != c || o == c) {
            return detail::message("O[", i, "] is not an involution");
        }
        if (table.degenerate(triangle(c))) return detail::message("O[", i, "] joins a degenerate triangle");
        if (edge_start(table, c) != edge_end(table, o) || edge_end(table, c) != edge_start(table, o)) {
            return detail::message("O[", i, "] joins different edges or the same direction");
        }
    }
    return {};
}

}  // namespace lacedring
