#pragma once
// Which k makes the bit-efficient tables smallest. Paper: LR 2011, section 8: run several times, keep the best.

#include <cstdint>
#include <span>
#include <vector>

#include "lrcore/base/result.h"
#include "lrcore/codec/tables/compact_lr.h"
#include "lrcore/codec/tables/lr_table.h"
#include "lrcore/ring/ring.h"
#include "lrcore/topology/corner_table.h"

namespace lr {

/// Periods worth trying on a mesh of that size, 0 (depth first) among them: fewer on large meshes.
std::vector<std::uint32_t> recommended_periods(std::size_t triangles);

struct CompactChoice {
    std::uint32_t k = 0;
    LrTable lr;  ///< the tables that were packed
    LrMap map;
    CompactLrTable compact;
};

/// Builds and packs the tables with each k and keeps the smallest. `options.k` is ignored; one ring per shell is made.
/// Cost: that of the rings and tables, times the number of periods. Errors: those of build_lr and build_compact_lr.
Result<CompactChoice> smallest_compact_lr(const CornerTable& table, const RingOptions& options,
                                          std::span<const std::uint32_t> periods);

}  // namespace lr
