#pragma once
// Which triangles go with which vertex in a SQuad, and which two make a quad.

#include <cstdint>
#include <vector>

#include "lacedring/topology.hpp"

namespace lacedring {

struct SquadRecord {
    CornerId first;  ///< the corner at the record's vertex in its first triangle
    bool quad;       ///< swing(first) is in its second triangle
};

struct SquadMatching {
    std::vector<SquadRecord> records;  ///< of matched vertices, and from `matched` on of triangles that no vertex took
    std::vector<VertexId> unmatched;   ///< used vertices without a record
    std::uint32_t matched = 0;
};

/// Every triangle that is not degenerate is in one record; every used vertex has one record or is in `unmatched`.
///
/// First, a depth-first walk in the manner of RING-EXPANDER gives each triangle entered to its tip, if that is new:
/// then all vertices of a shell but two own a triangle. Those two take a free one, by an alternating path if need be.
///
/// Second, vertices pair their triangle with a free neighbour across one of the two edges at the vertex. Pairs that are
/// forced come first (Karp and Sipser); as no vertex has a third choice, that leaves as few without a pair as possible.
///
/// Third, a vertex without one takes a neighbour of its triangle from another vertex, which keeps its other triangle
/// and takes a neighbour of that, and so on until one is free: the shortest such path among the first `reach` vertices.
/// Last, free triangles that adjoin are paired with each other.
///
/// With `renumber`, records are in the order of the walk, otherwise in the order of the vertices.
///
/// Cost: O(T) time, of which the third step takes O(reach) for each vertex without a pair. Memory while it runs: 1 byte
/// a triangle, 4 a vertex, and stacks.
SquadMatching match_squad(const CornerTable& table, bool renumber, std::uint32_t reach);

}  // namespace lacedring
