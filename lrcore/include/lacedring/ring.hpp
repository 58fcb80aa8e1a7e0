#pragma once
// Rings over a corner table: making, checking and optimizing them.

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "lacedring/base.hpp"
#include "lacedring/topology.hpp"

namespace lacedring {

// Rings are cycles of mesh edges that visit most vertices once and divide the triangles into two sides.
// Paper: LR 2011, section 4.2 (RING-EXPANDER).

struct Expansion;  // below

struct RingOptions {
    /// Seed corners tried per component; the one with the cheapest ring is kept.
    std::uint32_t seeds = 1;
    std::uint64_t random_seed = 1;
    /// 0: RING-EXPANDER; else HYBRID-RING-EXPANDER with one breadth-first step every k triangles.
    std::uint32_t k = 0;
    /// Make no further ring among vertices that a shell's ring left out.
    bool one_per_shell = false;
    /// Seed corner of the first ring; null: start each component at its first triangle.
    CornerId start = kNullCorner;
    /// Maximum number of threads for trying seeds, including the calling thread; does not change the rings.
    unsigned threads = 1;
};

/// Number of seeds worth trying on a mesh of that size. More for small meshes: their result depends more on the seed,
/// and tries are cheap.
std::uint32_t recommended_seeds(std::size_t triangles);

/// The edge from ring vertex v to v.n, and the corners that face it from the triangles beside it.
struct RingEdge {
    VertexId start;      ///< v
    CornerId left;       ///< in the invaded triangle v.t_L, never null
    CornerId right;      ///< in v.t_R: opposite(left), null at a border
    VertexId left_tip;   ///< vertex(left): v.l
    VertexId right_tip;  ///< vertex(right): v.r, null at a border
};

/// One ring is a run of `edges`; edge i goes from ring vertex i to the next vertex of its ring.
struct Rings {
    std::vector<RingEdge> edges;       ///< ring after ring, in ring order
    std::vector<std::uint32_t> first;  ///< where each ring begins in `edges`; one more entry at the end

    std::size_t count() const { return first.empty() ? 0 : first.size() - 1; }
    std::span<const RingEdge> ring(std::size_t r) const {
        return std::span(edges).subspan(first[r], first[r + 1] - first[r]);
    }
};

/// Makes rings on every component by RING-EXPANDER, depth first (section 4.2), or with k != 0 HYBRID-RING-EXPANDER
/// (section 6.1). No vertex is on the rings twice. Differs from the paper: the seed is a triangle whose three edges are
/// all followed; borders are opposite(c) == null, without dummy triangles; ring edges are emitted by a walk along the
/// invaded region; and if a component's ring leaves out all three vertices of a triangle, another ring is made there.
/// Cost: O(T) time per seed; 20 bytes per ring vertex for the result; while it runs V/8 + T/8 bytes and a stack of up
/// to 20 bytes per ring vertex; with several seeds also 40 bytes per vertex of the largest component for each thread.
/// Writes the order of invasion to `expansion` if it is not null.
Rings expand_rings(const CornerTable& table, const RingOptions& options = {}, Expansion* expansion = nullptr);

/// Checks that every ring is one cycle of mesh edges that visits no vertex twice. Returns the fault; empty if there is
/// none.
std::string check_rings(const CornerTable& table, const Rings& rings);

// Improves rings, so that fewer triangles have no ring edge, by local changes and simulated annealing.

/// Cost of a ring, in any unit. A T0 is in a wart if it shares a T2's edge off the ring.
struct RingCost {
    std::int32_t t0 = 3;       ///< a T0 in no wart; > 0
    std::int32_t t0_wart = 0;  ///< a T0 in a wart
    /// A vertex off the rings; negative if the two slots saved outweigh its cost.
    std::int32_t isolated = -2;
};

/// In references: three per verbatim T0, two per ring vertex.
constexpr RingCost kLeanRingCost{3, 0, -2};
/// In references: six per T0 and three for each of its three neighbors, which are irregular; two per ring vertex, one
/// per isolated vertex.
constexpr RingCost kLrRingCost{15, 0, -1};
/// In tenths of bits: sizes of SPLIT, WART and FAR events in packed streams of real meshes.
constexpr RingCost kPackedRingCost{110, 66, 300};

struct OptimizeOptions {
    RingCost cost = {};
    std::uint32_t passes = 24;  ///< more give better rings; 0: none
    std::uint64_t random_seed = 1;
    bool anneal = true;  ///< false: never make a change that raises the cost
    /// Maximum, including the calling thread; does not change the result.
    unsigned threads = 1;
    /// The calling thread calls it after each pass with the number of passes done. If it returns false, the result is
    /// the best rings so far.
    std::function<bool(std::uint32_t)> progress = {};
};

/// Returns rings of lower cost over the same triangles, or the given cycles if it finds none. The number of rings stays
/// the same, each one cycle; vertices may move between rings, off the rings and onto them. If the triangles on each
/// ring's left were a tree with all their vertices on the ring (as expand_rings makes them), they still are. The result
/// depends only on the rings and the seed, not on the machine or the number of threads; small meshes use fewer threads.
/// Cost: O(T) per pass, 1 to 50 ns per triangle, more if many T0 are in no wart; ends early when none of these is left.
/// Memory beside the table: 18 bytes per triangle, and 5 more at the start. Frees `rings` (pass them with std::move)
/// before it allocates most of this. Meshes of 2^30 or more triangles are returned unchanged.
Rings optimize_rings(const CornerTable& table, Rings rings, const OptimizeOptions& options = {});

// The steps of expand_rings, for display. Paper: LR 2011, section 4.2, Figure 3.

/// The triangles that expand_rings invaded, in that order; for each ring only those of the seed it kept.
struct Expansion {
    /// Ring after ring: the seed, then for each triangle the corner c facing the edge across which it was entered (the
    /// paper's c). vertex(c) was on no ring before; opposite(c) is in a triangle invaded before. A ring of n vertices
    /// has n - 2 corners.
    std::vector<CornerId> corners;
    /// Where each ring begins in `corners`; one more entry at the end.
    std::vector<std::uint32_t> first;

    bool operator==(const Expansion&) const = default;
};

/// Bit set in the step of a triangle that is never invaded.
constexpr std::uint32_t kNeverInvaded = 0x80000000U;

/// For each triangle, a step s: the triangle's side of the ring is final as soon as s + 1 triangles are invaded.
/// Either the triangle is itself the one invaded at step s (counted from 0), or it has the bit kNeverInvaded and step s
/// reached its last vertex through another triangle. Triangles with a vertex on no ring and degenerate triangles become
/// final with the last triangle invaded. After n steps, the rings so far are the edges between an invaded triangle
/// (step < n) and a triangle that is not invaded (yet). Such an edge stays on its ring if the latter is final (step &
/// ~kNeverInvaded < n); otherwise it may still be crossed. Cost: O(T) time, 4 bytes per triangle for the result, 4 per
/// vertex while it runs.
std::vector<std::uint32_t> settling_steps(const CornerTable& table, const Expansion& expansion);

}  // namespace lacedring
