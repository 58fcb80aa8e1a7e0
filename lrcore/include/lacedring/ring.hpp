#pragma once
// From a corner table to rings.

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "lacedring/base.hpp"
#include "lacedring/topology.hpp"

namespace lacedring {

// The rings: cycles of mesh edges that visit most vertices once and part the triangles into two sides.
// Paper: LR 2011, section 4.2 (RING-EXPANDER).

struct Expansion;  // below

struct RingOptions {
    std::uint32_t seeds = 1;  ///< seed corners tried per component; the one with the cheapest ring is kept
    std::uint64_t random_seed = 1;
    std::uint32_t k = 0;         ///< 0: RING-EXPANDER; else HYBRID-RING-EXPANDER, breadth first every k triangles
    bool one_per_shell = false;  ///< never a further ring among vertices that a shell's ring left out
    /// Where the ring of its component begins, and which ring is the first; null: each at its first triangle.
    CornerId start = kNullCorner;
    unsigned threads = 1;  ///< try seeds on at most that many, including the calling one; the same rings for any
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

    std::size_t count() const { return first.empty() ? 0 : first.size() - 1; }
    std::span<const RingEdge> ring(std::size_t r) const {
        return std::span(edges).subspan(first[r], first[r + 1] - first[r]);
    }
};

/// RING-EXPANDER, depth first (section 4.2), or with k HYBRID-RING-EXPANDER (section 6.1), over every component. A
/// vertex is on at most one ring, once. Differs from the paper: the seed is a triangle whose three edges are all
/// followed, borders are opposite(c) == null with no dummy triangles, ring edges are emitted while the invaded region
/// is walked, and a component whose ring left three unvisited vertices in one triangle gets a further ring there. Cost:
/// O(T) time per seed; 20 bytes a ring vertex for the result; while it runs V/8 + T/8 bytes and a stack of up to 20
/// bytes a ring vertex; with more seeds than one, 40 bytes a vertex of the largest component on top, for each thread.
/// `expansion`, if given, gets the order in which triangles were invaded; costs nothing where it is not.
Rings expand_rings(const CornerTable& table, const RingOptions& options = {}, Expansion* expansion = nullptr);

/// Checks that every ring is one cycle of mesh edges that visits no vertex twice. Empty if all is well.
std::string check_rings(const CornerTable& table, const Rings& rings);

// Rings with fewer triangles off the ring: local changes to any set of rings, by simulated annealing.

/// What a ring costs, in any unit. A T0 beside a T2 (across its edge that is not on the ring) is a wart.
struct RingCost {
    std::int32_t t0 = 3;         ///< a T0 beside no T2; > 0
    std::int32_t t0_wart = 0;    ///< a T0 beside a T2
    std::int32_t isolated = -2;  ///< a vertex off the rings; negative where its two slots are worth more than it costs
};

/// In references: three a verbatim T0, two a ring vertex.
constexpr RingCost kLeanRingCost{3, 0, -2};
/// In references: a T0 has six, its three neighbors are irregular and have three more each; two a ring vertex, one an
/// isolated one.
constexpr RingCost kLrRingCost{15, 0, -1};
/// In tenths of bits: what SPLIT, WART and FAR events take in packed streams of real meshes.
constexpr RingCost kPackedRingCost{110, 66, 300};

struct OptimizeOptions {
    RingCost cost = {};
    std::uint32_t passes = 24;  ///< more give better rings; 0: none
    std::uint64_t random_seed = 1;
    bool anneal = true;    ///< else no change that raises the cost is made
    unsigned threads = 1;  ///< run on at most that many, including the calling one; the result is the same for any
    /// Called after each pass, by the calling thread, with how many are done; false: stop, the best rings so far are
    /// the result.
    std::function<bool(std::uint32_t)> progress = {};
};

/// Rings over the same triangles whose cost is lower, or the same cycles. There are as many rings as before, each one
/// cycle; vertices may move from ring to ring, off the rings and onto them. If the triangles on each ring's left were a
/// tree, all their vertices on the ring, as expand_rings makes them, they still are. The same result for the same seed,
/// on every machine and for any number of threads; meshes of few triangles run on few threads.
/// Cost: O(T) a pass, 1 to 50 ns a triangle: the more T0 are in no wart, the more. Ends early when none is left. Beside
/// the table 18 bytes a triangle, and 5 more while it begins. The rings given are freed (pass them with std::move)
/// before most of that is needed. 2^30 triangles and more are left as they are.
Rings optimize_rings(const CornerTable& table, Rings rings, const OptimizeOptions& options = {});

// How expand_rings came to its rings, to be watched. Paper: LR 2011, section 4.2, Figure 3.

/// The triangles that expand_rings invaded, in that order; of each ring those from the seed that it kept.
struct Expansion {
    /// Ring after ring: the seed, then for each triangle its corner c that faces the edge it was entered across (the
    /// paper's c). vertex(c) is on no ring until then; opposite(c) is in a triangle that was invaded before. A ring of
    /// n vertices has n - 2 of them.
    std::vector<CornerId> corners;
    std::vector<std::uint32_t> first;  ///< where each ring begins in `corners`; one more entry at the end

    bool operator==(const Expansion&) const = default;
};

/// A triangle that is never invaded has this bit in its step.
constexpr std::uint32_t kNeverInvaded = 0x80000000U;

/// When it is settled on which side each triangle lies. A triangle of step s is settled once more than s triangles are
/// invaded: by being the last of those, or, with kNeverInvaded, because its last vertex was reached through another
/// one. What has a vertex on no ring, or is degenerate, is settled with the last triangle invaded. So the rings so far,
/// after n triangles, are the edges between a triangle that is invaded (step < n) and one that is not (yet); such an
/// edge stays on its ring if that one is settled (step & ~kNeverInvaded < n), and may still be crossed if it is not.
/// Cost: O(T) time, 4 bytes a triangle for the result, 4 a vertex while it runs.
std::vector<std::uint32_t> settling_steps(const CornerTable& table, const Expansion& expansion);

}  // namespace lacedring
