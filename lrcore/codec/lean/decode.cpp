#include <algorithm>
#include <cassert>

#include "lrcore/codec/lean/lean_format.h"
#include "lrcore/codec/lean/lean_stream.h"

namespace lr {
namespace {

constexpr std::uint32_t kFlags = ~LR_LEAN_TIP_MASK;

/// Reads ring slots. `Two` tells two-sided rings (two words a vertex) from one-sided ones.
template <bool Two>
struct RingSection {
    const std::uint32_t* words;  // word of ring vertex v is words[v], or words[2v] and words[2v + 1]

    std::uint32_t next(std::uint32_t v) const {
        if constexpr (Two) {
            if ((words[2 * v] & LR_LEAN_CLOSE_FLAG) != 0) return words[2 * v] & LR_LEAN_TIP_MASK;
            if ((words[2 * v + 1] & LR_LEAN_CLOSE_FLAG) != 0) return words[2 * v + 1] & LR_LEAN_TIP_MASK;
        } else {
            if ((words[v] & LR_LEAN_CLOSE_FLAG) != 0) return words[v] & LR_LEAN_TIP_MASK;
        }
        return v + 1;
    }

    /// Any slot of ring vertex v: side 0 is left, 1 right.
    LeanTriangle triangle(std::uint32_t v, std::uint32_t side) const {
        const std::uint32_t word = Two ? words[2 * v + side] : words[v];
        const std::uint32_t n = next(v);
        if ((word & LR_LEAN_CLOSE_FLAG) != 0) return side == 0 ? LeanTriangle{{v, v, n}} : LeanTriangle{{n, n, v}};
        const std::uint32_t tip = word & LR_LEAN_TIP_MASK;
        const std::uint32_t end = (word & LR_LEAN_WART_FLAG) != 0 ? next(n) : n;
        const bool reverse = (side != 0) != ((word & LR_LEAN_FLIP_FLAG) != 0);
        return reverse ? LeanTriangle{{end, tip, v}} : LeanTriangle{{v, tip, end}};
    }
};

void store(std::uint32_t* out, const LeanTriangle& triangle) {
    out[0] = triangle.v[0];
    out[1] = triangle.v[1];
    out[2] = triangle.v[2];
}

}  // namespace

LeanTriangle decode_lean_slot(const LeanView& view, std::uint32_t slot) {
    const std::uint32_t* words = view.payload.data();
    if (slot < 2 * view.rings2) return RingSection<true>{words}.triangle(slot / 2, slot % 2);
    if (slot < view.ring_slots()) return RingSection<false>{words + view.rings2}.triangle(slot - view.rings2, 0);
    const std::uint32_t* v = words + view.ring_slots() + std::size_t{3} * (slot - view.ring_slots());
    return {{v[0], v[1], v[2]}};
}

void decode_lean(const LeanView& view, std::span<std::uint32_t> indices) {
    assert(indices.size() == std::size_t{3} * view.slots());
    const std::uint32_t* words = view.payload.data();
    std::uint32_t* out = indices.data();
    const RingSection<true> two{words};
    for (std::uint32_t v = 0; v < view.rings2; ++v, out += 6) {
        const std::uint32_t left = words[2 * v], right = words[2 * v + 1];
        if (((left | right) & kFlags) == 0) [[likely]] {
            out[0] = v;
            out[1] = left;
            out[2] = v + 1;
            out[3] = v + 1;
            out[4] = right;
            out[5] = v;
        } else {
            store(out, two.triangle(v, 0));
            store(out + 3, two.triangle(v, 1));
        }
    }
    const RingSection<false> one{words + view.rings2};
    for (std::uint32_t v = view.rings2; v < view.rings2 + view.rings1; ++v, out += 3) {
        const std::uint32_t left = one.words[v];
        if ((left & kFlags) == 0) [[likely]] {
            out[0] = v;
            out[1] = left;
            out[2] = v + 1;
        } else {
            store(out, one.triangle(v, 0));
        }
    }
    const std::uint32_t* verbatim = words + view.ring_slots();
    std::copy(verbatim, verbatim + std::size_t{3} * view.verbatim, out);
}

}  // namespace lr
