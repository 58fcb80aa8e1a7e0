#pragma once
// Rings with fewer triangles off the ring: local changes to any set of rings, by simulated annealing.

#include <cstdint>
#include <functional>

#include "lrcore/ring/ring.h"
#include "lrcore/topology/corner_table.h"

namespace lr {

/// What a ring costs, in any unit. A T0 beside a T2 (across its edge that is not on the ring) is a wart.
struct RingCost {
    std::int32_t t0 = 3;         ///< a T0 beside no T2; > 0
    std::int32_t t0_wart = 0;    ///< a T0 beside a T2
    std::int32_t isolated = -2;  ///< a vertex off the rings; negative where its two slots are worth more than it costs
};

/// In references: three a verbatim T0, two a ring vertex.
constexpr RingCost lean_ring_cost{3, 0, -2};
/// In references: a T0 has six, its three neighbours are irregular and have three more each; two a ring vertex, one an
/// isolated one.
constexpr RingCost lr_ring_cost{15, 0, -1};
/// In tenths of bits: what SPLIT, WART and FAR events take in packed streams of real meshes.
constexpr RingCost packed_ring_cost{110, 66, 300};

struct OptimizeOptions {
    RingCost cost = {};
    std::uint32_t passes = 24;  ///< more give better rings; 0: none
    std::uint64_t random_seed = 1;
    bool anneal = true;  ///< else no change that raises the cost is made
    /// Called after each pass with how many are done; false: stop, the best rings so far are the result.
    std::function<bool(std::uint32_t)> progress = {};
};

/// Rings over the same triangles whose cost is lower, or the same rings. There are as many rings as before, each one
/// cycle; vertices may move from ring to ring, off the rings and onto them. If the triangles on each ring's left were a
/// tree, all their vertices on the ring, as expand_rings makes them, they still are. The same result for the same seed.
/// Cost: O(T) a pass, 20 to 100 ns a triangle; beside table and rings 2 bytes a triangle and a quarter byte a vertex.
/// The rings given are freed (pass them with std::move) before those of the result are made.
Rings optimize_rings(const CornerTable& table, Rings rings, const OptimizeOptions& options = {});

}  // namespace lr
