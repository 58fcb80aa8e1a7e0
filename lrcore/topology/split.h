#pragma once
#include <cstdint>
#include <vector>

#include "lrcore/topology/corner_table.h"

namespace lr {

/// Gives every fan of triangles around a vertex a vertex of its own, so that vertices and adjacency agree (a
/// pseudo-manifold; Rossignac and Cardoze 1999). A vertex keeps its number for its first fan.
/// Returns the copies: entry i is the vertex that the new vertex (old vertex_count + i) is a copy of; empty if the
/// table was a pseudo-manifold. Cost: O(T) time, 3/8 byte a triangle while it runs.
std::vector<VertexId> split_fans(CornerTable& table);

}  // namespace lr
