#pragma once
// The order in which RING-EXPANDER invades triangles, to be watched. Paper: LR 2011, section 4.2.

#include <cstdint>
#include <vector>

#include "lrcore/corner_table/corner_table.h"

namespace lr {

/// The step at which the paper's procedure, as it is printed, reaches each triangle, from the first triangle of each
/// component and with no further ring there; UINT32_MAX: not at all. expand_rings emits its rings without noting this.
/// Cost: O(T) time, 4 bytes a triangle for the result, V/8 + T/8 bytes and a stack while it runs.
std::vector<std::uint32_t> expansion_order(const CornerTable& table);

}  // namespace lr
