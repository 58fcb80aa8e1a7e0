#pragma once
// How half-edges find each other. Internal to corner_table/.

#include <cstdint>
#include <vector>

#include "lacedring/topology.hpp"

namespace lacedring {

/// Half-edges (named by the corner that faces them) of the edges that have more than two triangles, edge after edge.
struct NonManifoldEdges {
    std::vector<CornerId> corners;
    std::vector<std::uint32_t> first{0};  ///< where each edge begins in `corners`; one more entry at the end
};

/// Joins the two half-edges of every edge of two triangles, whatever their directions, and lists the edges of more.
/// Counts border and non-manifold edges. O must be all null. Returns whether some joined pair runs the same way.
bool join_edges(CornerTable& table, NonManifoldEdges& nonmanifold);

/// Flips triangles so that joined half-edges are opposed; unjoins those for which no choice fits.
void orient(CornerTable& table);

/// Pairs opposed half-edges of each non-manifold edge, those first that merge fans at both ends.
void pair_nonmanifold(CornerTable& table, const NonManifoldEdges& nonmanifold);

/// The edge that corner c faces, from its start to its end in the triangle's orientation.
inline VertexId edge_start(const CornerTable& table, CornerId c) {
    return table.vertex(next(c));
}
inline VertexId edge_end(const CornerTable& table, CornerId c) {
    return table.vertex(previous(c));
}

}  // namespace lacedring
