#pragma once
// The rings: cycles of mesh edges that visit most vertices once and part the triangles into two sides.
// Paper: LR 2011, section 4.2 (RING-EXPANDER).

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lrcore/base/ids.h"
#include "lrcore/corner_table/corner_table.h"

namespace lr {

struct RingOptions {
    std::uint32_t seeds = 1;     ///< seed corners tried per component; the one with the cheapest ring is kept
    std::uint64_t random_seed = 1;
};

/// One ring is a run of `edges`; ring edge i goes from ring vertex i to the next of its ring.
/// edges[i] is the corner, in the invaded triangle to its left, that faces the edge; its opposite is on the right.
struct Rings {
    std::vector<CornerId> edges;       ///< ring after ring, in ring order
    std::vector<std::uint32_t> first;  ///< where each ring begins in `edges`; one more entry at the end

    std::size_t count() const { return first.size() - 1; }
    std::span<const CornerId> ring(std::size_t r) const {
        return std::span(edges).subspan(first[r], first[r + 1] - first[r]);
    }
};

/// Ring vertex at which the edge facing `left` starts (paper: v, of the edge v, v.n).
inline VertexId ring_vertex(const CornerTable& table, CornerId left) { return table.vertex(previous(left)); }

/// RING-EXPANDER, depth first, over every component. A vertex is on at most one ring, once.
/// Differs from the paper: the seed is a triangle whose three edges are all followed, borders are opposite(c) == null with
/// no dummy triangles, ring edges are emitted while the invaded region is walked, and a component whose ring left three
/// unvisited vertices in one triangle gets a further ring there.
/// Cost: O(T) time per seed; 2 bytes a triangle for the result and V/8 + T/8 bytes while it runs.
Rings expand_rings(const CornerTable& table, const RingOptions& options = {});

/// Checks that every ring is one cycle of mesh edges that visits no vertex twice. Empty if all is well.
std::string validate(const CornerTable& table, const Rings& rings);

}  // namespace lr
