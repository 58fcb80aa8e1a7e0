#include <utility>

#include "lacedring/lacedring.hpp"
#include "lrcore/base/try.h"

namespace lacedring {

std::vector<std::uint32_t> recommended_periods(std::size_t triangles) {
    // The best k in the paper's Table 1 range from 38 to 720.
    if (triangles <= 300'000) return {0, 720, 512, 420, 360, 300, 256, 226, 180, 128, 106, 90, 64, 45, 32, 23, 16};
    if (triangles <= 3'000'000) return {0, 256, 128, 90, 64, 45, 32, 23};
    return {128, 64, 32};
}

Result<CompactChoice> smallest_compact_lr(const CornerTable& table, const RingOptions& options,
                                          std::span<const std::uint32_t> periods) {
    CompactChoice best;
    bool any = false;
    for (const std::uint32_t k : periods) {
        RingOptions ring = options;
        ring.k = k;
        ring.one_per_shell = true;
        CompactChoice choice;
        choice.k = k;
        LR_ASSIGN(LrTable lr, build_lr(table, expand_rings(table, ring), {}, &choice.map));
        LR_ASSIGN(CompactLrTable compact, build_compact_lr(lr.view()));
        choice.lr = std::move(lr);
        choice.compact = std::move(compact);
        if (any && choice.compact.view().bytes() >= best.compact.view().bytes()) continue;
        best = std::move(choice);
        any = true;
    }
    if (!any) return Error{ErrorCode::invalid_argument, "no period to try"};
    return best;
}

}  // namespace lacedring
