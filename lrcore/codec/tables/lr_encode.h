#pragma once
// From a corner table to LR tables, and to LR streams in one call, non-manifold vertices and all.

#include <cstdint>
#include <span>
#include <vector>

#include "lrcore/base/result.h"
#include "lrcore/codec/tables/lr_stream.h"
#include "lrcore/ring/optimize.h"
#include "lrcore/ring/ring.h"
#include "lrcore/topology/corner_table.h"

namespace lr {

struct LrOptions {
    bool wart_skipping = true;
};

/// Builds the tables from a pseudo-manifold corner table (split_fans) and its rings, one per shell
/// (RingOptions::one_per_shell). Degenerate triangles take no part.
/// Cost: O(T) time; 4 bytes a reference, and about 8 bytes a triangle while it runs. `map` may be null.
/// Errors: too_large (2^28 vertices).
Result<LrTable> build_lr(const CornerTable& table, const Rings& rings, const LrOptions& options = {},
                         LrMap* map = nullptr);

struct EncodedLr {
    std::vector<std::uint32_t> words;         ///< the stream (lr_stream.h)
    std::vector<std::uint32_t> vertex_order;  ///< vertex_order[LR vertex] = the table's; copies repeat their original's
    std::vector<std::uint32_t> triangle_order;  ///< the table's triangle of each one that decode_lr gives, in its order
    LrStatistics statistics;
    std::uint32_t copies = 0;  ///< vertices beyond the table's, for fans of non-manifold vertices
    std::uint32_t k = 0;       ///< of the ring that was kept; 0: depth first
};

/// The standard tables. `table` is any corner table; it is split into a pseudo-manifold here, and one ring made per
/// shell, optimised as `optimize` says. Cost: O(T) per seed and pass. Errors: those of build_lr.
Result<EncodedLr> encode_lr(CornerTable table, const RingOptions& ring, const OptimizeOptions& optimize = {.passes = 0},
                            bool wart_skipping = true);

/// The bit-efficient tables, with the best of `periods` (smallest_compact_lr).
Result<EncodedLr> encode_compact_lr(CornerTable table, const RingOptions& ring, std::span<const std::uint32_t> periods);

}  // namespace lr
