#pragma once
// Joins the half-edges of triangles into edges. Internal to lrcore/topology.

#include <cstdint>
#include <vector>

#include "lacedring/topology.hpp"

namespace lacedring {

/// The half-edges of all edges with more than two triangles, edge after edge. A half-edge is named by the corner facing
/// it.
struct NonManifoldEdges {
    std::vector<CornerId> corners;
    /// Where each edge begins in `corners`; one more entry at the end.
    std::vector<std::uint32_t> first{0};
};

/// Joins the half-edges of each edge of two triangles, whatever their directions; lists the edges of more triangles.
/// Counts border and non-manifold edges. O must be all null. Returns whether two joined half-edges have the same
/// direction.
bool join_edges(CornerTable& table, NonManifoldEdges& nonmanifold);

/// Flips triangles so that joined half-edges are opposed; unjoins half-edges if no orientation fits.
void orient(CornerTable& table);

/// Pairs opposed half-edges of each non-manifold edge; prefers pairs that merge fans at both ends.
void pair_nonmanifold(CornerTable& table, const NonManifoldEdges& nonmanifold);

/// The edge that corner c faces, from its start to its end in the triangle's orientation.
inline VertexId edge_start(const CornerTable& table, CornerId c) {
    return table.vertex(next(c));
}
inline VertexId edge_end(const CornerTable& table, CornerId c) {
    return table.vertex(previous(c));
}

}  // namespace lacedring
