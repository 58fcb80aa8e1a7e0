#pragma once
// The bit-efficient Laced Ring representation. Paper: LR 2011, section 6 and Figure 9.
//
// One 32-bit word per ring vertex, its left half in the upper 16 bits: a wart bit and a 15-bit signed offset from v to
// the tip, modulo m_r, on either side. Both wart bits together cannot be: they say that the other 30 bits are four
// flags and a 26-bit index of a record in VO* (in units of `unit` entries, two unless the table outgrows the index):
//     v.l, v.r             as words of the standard representation (lr_format.h), each with its kind
//     two more             the opposites of an irregular left triangle
//     two more             the opposites of an irregular right triangle
//
//     31    30-16         15    14-0            31   30   29   28   27   26-16      15   14-0
//     L_w   left offset   R_w   right offset    1    L_w  R_w  L_i  R_i  index, hi  1    index, lo
//
// A short offset of 0 means a border and one of 2, without wart, a redundant T2: a triangle whose tip really is v or
// v+2, a redundant T2 over a ring's end, a closing edge and a triangle that was turned round take a record. T0,
// isolated vertices and all numbering are as in the standard representation.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lrcore/base/result.h"
#include "lrcore/codec/tables/lr_table.h"

namespace lr {

namespace compact {
constexpr std::uint32_t kLeftWart = 0x80000000, kRightWart = 0x00008000, kLong = kLeftWart | kRightWart;
constexpr std::uint32_t kLongLeftWart = 0x40000000, kLongRightWart = 0x20000000;
constexpr std::uint32_t kLongLeftIrregular = 0x10000000, kLongRightIrregular = 0x08000000;
constexpr std::uint32_t kIndexBits = 26;
}  // namespace compact

/// The arrays, wherever they are. Holds no copy. LrOperators runs on it.
struct CompactLrView {
    std::uint32_t vertices = 0;
    std::uint32_t ring_vertices = 0;
    std::uint32_t unit = 2;               ///< entries of VO* that one step of a record's index stands for
    std::span<const std::uint32_t> lr;    ///< m_r words
    std::span<const std::uint32_t> vo;    ///< 6 a T0
    std::span<const std::uint32_t> star;  ///< VO*: records of 2, 4 or 6 entries
    std::span<const std::uint32_t> c;     ///< a corner of each isolated vertex

    static bool is_long(std::uint32_t w) { return (w & compact::kLong) == compact::kLong; }
    std::size_t record(std::uint32_t w) const { return std::size_t{(w >> 16 & 0x7ff) << 15 | (w & 0x7fff)} * unit; }
    static std::int32_t offset(std::uint32_t w, std::uint32_t side) {
        const std::uint32_t half = side == 0 ? w >> 16 : w;
        return static_cast<std::int32_t>(half << 17) >> 17;
    }

    std::uint32_t kind(std::uint32_t v, std::uint32_t side) const {
        const std::uint32_t w = lr[v];
        if (is_long(w)) return star[record(w) + side] & word::kKind;
        if ((w & (side == 0 ? compact::kLeftWart : compact::kRightWart)) != 0) return word::kWart;
        const std::int32_t o = offset(w, side);
        return o == 0 ? word::kBorder : o == 2 ? word::kRedundant : 0;
    }
    bool closes(std::uint32_t v) const {
        const std::uint32_t w = lr[v];
        return is_long(w) && (star[record(w)] & word::kKind) == word::kClosing;
    }
    std::uint32_t first(std::uint32_t v) const { return star[record(lr[v])] & word::kTip; }
    std::uint32_t tip(std::uint32_t v, std::uint32_t side) const {
        const std::uint32_t w = lr[v];
        if (is_long(w)) return star[record(w) + side] & word::kTip;
        const std::uint32_t t = v + static_cast<std::uint32_t>(offset(w, side));  // wraps below zero
        if (t < ring_vertices) return t;
        return offset(w, side) < 0 ? t + ring_vertices : t - ring_vertices;
    }
    /// The slot as a word of the standard representation, its tip the vertex.
    std::uint32_t word(std::uint32_t v, std::uint32_t side) const {
        const std::uint32_t w = lr[v];
        if (is_long(w)) return star[record(w) + side];
        const std::uint32_t half = side == 0 ? w >> 16 : w & 0xffff;
        const auto o = static_cast<std::uint32_t>(static_cast<std::int32_t>(half << 17) >> 17);
        std::uint32_t t = v + o;  // wraps below zero
        if (t >= ring_vertices) t += o >> 31 != 0 ? ring_vertices : 0U - ring_vertices;
        return (half & 0x8000) << 16 | (half == 0 ? word::kBorder : half == 2 ? word::kRedundant : 0) | t;
    }
    static std::uint32_t tip(std::uint32_t w) { return w & word::kTip; }
    std::uint32_t star_opposite(std::uint32_t v, std::uint32_t side, std::uint32_t end) const {
        const std::uint32_t w = lr[v];
        const bool behind_left = side == 1 && (w & compact::kLongLeftIrregular) != 0;
        return star[record(w) + 2 + (behind_left ? 2 : 0) + end];
    }
    /// As LrView::plain_fan.
    using PlainFan = LrView::PlainFan;
    bool plain_fan(std::uint32_t v, PlainFan& fan) const {
        if (v < 2 || v + 1 >= ring_vertices) return false;
        const std::uint32_t a = lr[v], b = lr[v - 1];
        if (((a | b | lr[v - 2]) & compact::kLong) != 0) return plain_long_fan(v, fan);
        const std::int32_t la = offset(a, 0), ra = offset(a, 1), lb = offset(b, 0), rb = offset(b, 1);
        // 0 is a border and 2 a copy: with that bit cleared, either is nothing.
        if (((la & ~2) == 0) | ((ra & ~2) == 0) | ((lb & ~2) == 0) | ((rb & ~2) == 0)) return false;
        const auto at = [](std::uint32_t u, std::int32_t o) { return u + static_cast<std::uint32_t>(o); };
        fan.left = at(v, la);
        fan.right = at(v, ra);
        fan.left_count = at(v - 1, lb) - fan.left;
        fan.right_count = at(v - 1, rb) - fan.right;
        return run_has_tip(fan.left, fan.left_count, v, 0) && run_has_tip(fan.right, fan.right_count, v, 1);
    }
    /// The same where some of the words are long.
    bool plain_long_fan(std::uint32_t v, PlainFan& fan) const {
        const std::uint32_t l = word(v, 0), r = word(v, 1), pl = word(v - 1, 0), pr = word(v - 1, 1);
        const std::uint32_t ppl = word(v - 2, 0);
        if ((l | r | pl | pr) > word::kTip || LrView::skips(ppl) || LrView::closing(ppl) ||
            LrView::skips(word(v - 2, 1)))
            return false;
        fan = {l, pl - l, r, pr - r};
        const auto row = [&](std::uint32_t first, std::uint32_t count, std::uint32_t side) {
            if (count > 4 || std::uint64_t{first} + 3 >= ring_vertices) return false;
            bool all = true;
            for (std::uint32_t i = 0; i < count; ++i) all &= word(first + i, side) == v;
            return all;
        };
        return row(l, fan.left_count, 0) && row(r, fan.right_count, 1);
    }

    std::uint32_t t0_vertex(std::uint32_t i) const { return vo[std::size_t{i / 3} * 6 + i % 3] & ~word::kT0Flip; }
    std::uint32_t t0_opposite(std::uint32_t i) const { return vo[std::size_t{i / 3} * 6 + 3 + i % 3]; }
    std::uint32_t isolated_corner(std::uint32_t i) const { return c[i]; }

    /// Do the slots first .. first + count - 1 have the plain tip v? Four at most. False where one of their words
    /// is long.
    bool run_has_tip(std::uint32_t first, std::uint32_t count, std::uint32_t v, std::uint32_t side) const {
        if (count > 4 || std::uint64_t{first} + 3 >= ring_vertices) return false;
        const std::uint32_t* w = lr.data() + first;
        const std::uint32_t shift = side == 0 ? 16 : 0;
        const std::uint32_t o = v - first;  // of the first; one less of each after it; 2 would be a copy
        const auto is = [&](std::uint32_t i) {
            return ((w[i] >> shift & 0xffff) == ((o - i) & 0x7fff)) & (o - i + (1U << 14) < 1U << 15) & (o - i != 2);
        };
        return (is(0) | (count < 1)) & (is(1) | (count < 2)) & (is(2) | (count < 3)) & (is(3) | (count < 4));
    }

    std::uint32_t used_vertices() const { return ring_vertices + static_cast<std::uint32_t>(c.size()); }
    std::uint32_t triangle_numbers() const { return 2 * ring_vertices + static_cast<std::uint32_t>(vo.size() / 6); }
    /// 4 (m_r + 6 n_0 + 3 n_i + n_l + m_i) bytes.
    std::size_t bytes() const { return 4 * (lr.size() + vo.size() + star.size() + c.size()); }
};

struct CompactLrTable {
    std::uint32_t vertices = 0, ring_vertices = 0, unit = 2;
    std::vector<std::uint32_t> lr, vo, star, c;
    std::uint32_t irregular = 0;  ///< n_i: triangles with opposites in VO*
    std::uint32_t long_tips = 0;  ///< n_l: slots with a long reference and no opposites

    CompactLrView view() const { return {vertices, ring_vertices, unit, lr, vo, star, c}; }
};

/// Packs standard tables. Vertices, triangles and corners keep their numbers. Cost: O(T).
/// A VO* beyond 2^27 entries is indexed in units of 4 or 8, its records padded; at 8 each record takes one unit.
/// Errors: too_large (more than 2^26 records).
Result<CompactLrTable> build_compact_lr(const LrView& lr);

}  // namespace lr
