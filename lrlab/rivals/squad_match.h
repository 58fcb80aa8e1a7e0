#pragma once
// Matches vertices with triangles for a SQuad, and pairs triangles to quads.

#include <cstdint>
#include <vector>

#include "lacedring/topology.hpp"

namespace lacedring {

struct SquadRecord {
    CornerId first;  ///< the corner at the record's vertex in its first triangle
    bool quad;       ///< swing(first) is in its second triangle
};

struct SquadMatching {
    std::vector<SquadRecord> records;  ///< of matched vertices; from `matched` on of triangles without an owner
    std::vector<VertexId> unmatched;   ///< used vertices without a record
    std::uint32_t matched = 0;
};

/// Each triangle that is not degenerate is in one record; each used vertex has a record or is in `unmatched`.
///
/// 1. A depth-first walk like RING-EXPANDER gives each entered triangle to its tip if the tip is new. Then all but two
/// vertices of a component own a triangle. These two take a free triangle, along an alternating path if necessary.
///
/// 2. Vertices pair their triangle with a free neighbor across one of the two edges at the vertex. Forced pairs come
/// first (Karp and Sipser). Since no vertex has a third choice, this leaves the fewest vertices without a pair.
///
/// 3. A vertex without a pair takes a neighbor of its triangle from another vertex, which keeps its other triangle and
/// takes a neighbor of it, and so on to a free triangle: the shortest such path among the first `reach` vertices.
///
/// 4. Adjacent free triangles are paired with each other.
///
/// With `renumber`, records are in the order of the walk, otherwise in the order of the vertices.
///
/// Cost: O(T) time; step 3 takes O(reach) for each vertex without a pair. Memory during the call: 1 byte a triangle, 4
/// bytes a vertex, and stacks.
SquadMatching match_squad(const CornerTable& table, bool renumber, std::uint32_t reach);

}  // namespace lacedring
