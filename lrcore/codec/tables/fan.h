#pragma once
// The neighbours of a ring vertex v side by side, from fewer words than the corners around it take.
//
// On either side of the ring, the triangles at v run from the slot that starts at v to the slot that ends at v. Along a
// corridor those in between have v as their tip and lie in a row:
//
//          x---o---o---o---o
//           \   \  |  /   /            slots x, x + 1, ... have tip v
//            \   \ | /   /
//     v.n o-------- v --------o v.p    v.l or v.r is x; the tip of the slot that ends at v is where the row ends
//
// LrView::plain_fan counts such rows; here warts, T2, irregular triangles and T0 are stepped over as well.

#include <cstdint>

#include "lrcore/codec/tables/lr_format.h"

namespace lr {

/// The neighbours of v between v.n and v.p on one side, in this order: as many as triangles, less one.
template <class Store>
class FanSide {
  public:
    std::uint32_t size = 0;
    std::uint32_t vertex[16];  ///< `size` of them

    /// Lists those of side 0 (left) or 1 (right). w, p, pp: the words of v, v.p and v.p.p there. Constant time. False,
    /// and the list of no use, where it is long or a border is near: LrOperators has to go by the corners.
    template <std::uint32_t side>
    bool find(const Store& s, std::uint32_t v, std::uint32_t w, std::uint32_t p, std::uint32_t pp) {
        size = 0;
        if (is_wart(p) || is_redundant(p)) return true;  // v is the middle of a T2
        // The slots of the triangle at v's edge and of the last one at v, and their words.
        const std::uint32_t from = is_redundant(w) ? v + 1 : v, to = is_wart(pp) ? v - 2 : v - 1;
        if (is_wart(w)) vertex[size++] = ring_next(s, v + 1);
        std::uint32_t x = vertex[size++] = s.tip(w);
        if (from != v) w = s.word(from, side);
        if (to != v - 1) p = pp;
        if (((w | p) & word::kSpecial) != 0) return false;
        const std::uint32_t last = s.tip(p);
        if (((w | p) & word::kIrregular) == 0 && x != v + 1 && s.run_has_tip(x, last - x, v, side)) {
            for (std::uint32_t i = 0; i < 4; ++i) vertex[size + i] = x + 1 + i;
            size += last - x;
            if (to != v - 1) vertex[size++] = to;
            return true;
        }
        std::uint32_t slot = from;
        // Which edge of `slot`'s triangle is (v, x): that of its end and tip (0) or of its start and tip (1)?
        std::uint32_t edge = from == v ? 1 : 0;
        for (;;) {
            if ((w & word::kIrregular) != 0) {
                std::uint32_t c = s.star_opposite(slot, side, edge);  // faces (v, x) from the other side
                while (c >= 8 * s.ring_vertices) {
                    if (c == UINT32_MAX || size >= kMost) return false;
                    const std::uint32_t t0 = (c - 8 * s.ring_vertices) / 4 * 3, k = c % 4;
                    vertex[size++] = x = s.t0_vertex(t0 + k);
                    c = s.t0_opposite(t0 + (k + 1 + side) % 3);
                }
                if (c == start_corner(to, side)) break;
                if (c != end_corner(x, side)) return false;
                w = s.word(x, side);
            } else {
                if (edge == 1 && x == last) break;
                w = x < s.ring_vertices ? s.word(x, side) : word::kBorder;
                if ((w & word::kSpecial) != 0 || s.tip(w) != v) {
                    if (x == last) break;
                    return false;
                }
            }
            if (size >= kMost) return false;
            slot = x;
            edge = 0;
            x = side == 0 ? x + 1 : ring_next(s, x);  // a left slot with a triangle of its own does not close its ring
            if (is_wart(w)) x = ring_next(s, x);
            vertex[size++] = x;
        }
        if (to != v - 1) vertex[size++] = to;
        return true;
    }

  private:
    static constexpr std::uint32_t kMost = 11;  // further ones may be four of a row, or one and v.p.p

    static bool is_wart(std::uint32_t w) { return (w & (word::kSpecial | word::kWart)) == word::kWart; }
    static bool is_redundant(std::uint32_t w) { return (w & word::kKind) == word::kRedundant; }
    static std::uint32_t start_corner(std::uint32_t v, std::uint32_t side) { return 8 * v + 6 * side; }
    static std::uint32_t end_corner(std::uint32_t v, std::uint32_t side) { return 8 * v + 2 + 2 * side; }
    static std::uint32_t ring_next(const Store& s, std::uint32_t v) { return s.closes(v) ? s.first(v) : v + 1; }
};

}  // namespace lr
