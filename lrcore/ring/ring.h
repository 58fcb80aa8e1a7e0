#pragma once
// The rings: cycles of mesh edges that visit most vertices once and part the triangles into two sides.
// Paper: LR 2011, section 4.2 (RING-EXPANDER).

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lrcore/base/ids.h"
#include "lrcore/topology/corner_table.h"

namespace lr {

struct Expansion;  // lrcore/ring/expansion.h

struct RingOptions {
    std::uint32_t seeds = 1;  ///< seed corners tried per component; the one with the cheapest ring is kept
    std::uint64_t random_seed = 1;
    std::uint32_t k = 0;         ///< 0: RING-EXPANDER; else HYBRID-RING-EXPANDER, breadth first every k triangles
    bool one_per_shell = false;  ///< never a further ring among vertices that a shell's ring left out
    /// Where the ring of its component begins, and which ring is the first; null: each at its first triangle.
    CornerId start = null_corner;
};

/// Seeds worth trying on a mesh of that size: more on small meshes, where chance weighs more and trying is cheap.
std::uint32_t recommended_seeds(std::size_t triangles);

/// The edge from ring vertex v to v.n, and the corners that face it from the triangles beside it.
struct RingEdge {
    VertexId start;      ///< v
    CornerId left;       ///< in the invaded triangle v.t_L, never null
    CornerId right;      ///< in v.t_R: opposite(left), null at a border
    VertexId left_tip;   ///< vertex(left): v.l
    VertexId right_tip;  ///< vertex(right): v.r, null at a border
};

/// One ring is a run of `edges`; edge i goes from ring vertex i to the next of its ring.
struct Rings {
    std::vector<RingEdge> edges;       ///< ring after ring, in ring order
    std::vector<std::uint32_t> first;  ///< where each ring begins in `edges`; one more entry at the end

    std::size_t count() const { return first.size() - 1; }
    std::span<const RingEdge> ring(std::size_t r) const {
        return std::span(edges).subspan(first[r], first[r + 1] - first[r]);
    }
};

/// RING-EXPANDER, depth first (section 4.2), or with k HYBRID-RING-EXPANDER (section 6.1), over every component. A
/// vertex is on at most one ring, once. Differs from the paper: the seed is a triangle whose three edges are all
/// followed, borders are opposite(c) == null with no dummy triangles, ring edges are emitted while the invaded region
/// is walked, and a component whose ring left three unvisited vertices in one triangle gets a further ring there. Cost:
/// O(T) time per seed; 20 bytes a ring vertex for the result; while it runs V/8 + T/8 bytes and a stack of up to 20
/// bytes a ring vertex; with more seeds than one, 40 bytes a vertex of the largest component on top.
/// `expansion`, if given, gets the order in which triangles were invaded; costs nothing where it is not.
Rings expand_rings(const CornerTable& table, const RingOptions& options = {}, Expansion* expansion = nullptr);

/// Checks that every ring is one cycle of mesh edges that visits no vertex twice. Empty if all is well.
std::string validate(const CornerTable& table, const Rings& rings);

}  // namespace lr
