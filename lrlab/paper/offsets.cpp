#include "lrlab/paper/offsets.h"

namespace lacedring {

OffsetCounts count_offsets(const LrView& lr) {
    OffsetCounts out;
    out.t0 = static_cast<std::uint32_t>(lr.vo.size() / 6);
    for (std::uint32_t v = 0; v < lr.ring_vertices; ++v) {
        for (std::uint32_t side = 0; side < 2; ++side) {
            if ((lr.kind(v, side) & word::kSpecial) != 0) continue;
            const std::uint32_t tip = lr.tip(v, side);
            ++(tip < lr.ring_vertices ? out.bits[offset_bits(v, tip, lr.ring_vertices)] : out.off_ring);
        }
    }
    return out;
}

std::uint32_t count_long_tips(const CompactLrView& lr) {
    std::uint32_t count = 0;
    for (const std::uint32_t w : lr.lr) {
        if (!CompactLrView::is_long(w)) continue;
        count += (w & compact::kLongLeftIrregular) == 0 ? 1U : 0U;
        count += (w & compact::kLongRightIrregular) == 0 ? 1U : 0U;
    }
    return count;
}

}  // namespace lacedring
