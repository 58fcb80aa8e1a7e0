#pragma once
// The standard Laced Ring representation: L, R, VO, VO* and C. Paper: LR 2011, sections 4 and 5.
//
// Vertices 0 .. ring_vertices-1 lie along the rings, ring after ring; isolated vertices follow, then those of no
// triangle. Triangle 2v is (v, L[v], v.n), triangle 2v+1 is (v.n, R[v], v), triangles from 2 ring_vertices on are T0.
// Corners are 8v+0, 1, 2 (left: v, v.l, v.n) and 8v+4, 5, 6 (right: v.n, v.r, v); T0 triangle t has 4t, 4t+1, 4t+2.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lrcore/base/ids.h"
#include "lrcore/codec/tables/lr_format.h"

namespace lr {

/// The arrays, wherever they are: in an LrTable, or in a memory-mapped file. Holds no copy.
struct LrView {
    std::uint32_t vertices = 0;         ///< all: on rings, isolated, and of no triangle
    std::uint32_t ring_vertices = 0;    ///< m_r
    std::span<const std::uint32_t> lr;  ///< 2 m_r words (lr_format.h)
    std::span<const std::uint32_t> vo;  ///< 6 a T0: three vertices, three opposite corners
    std::span<const std::uint32_t>
        star;                          ///< VO*, 3 an irregular triangle: tip, opposites of the start and the end corner
    std::span<const std::uint32_t> c;  ///< a corner of each isolated vertex

    // What LrOperators asks of a representation. side: 0 left, 1 right.
    std::uint32_t kind(std::uint32_t v, std::uint32_t side) const { return lr[2 * v + side] & word::kKind; }
    bool closes(std::uint32_t v) const { return kind(v, 0) == word::kClosing; }
    std::uint32_t first(std::uint32_t v) const { return lr[2 * v] & word::kTip; }
    std::uint32_t tip(std::uint32_t v, std::uint32_t side) const { return tip(lr[2 * v + side]); }
    /// Of an irregular triangle, the opposite of its start corner (end = 0) or end corner (end = 1).
    std::uint32_t star_opposite(std::uint32_t v, std::uint32_t side, std::uint32_t end) const {
        return star[(lr[2 * v + side] & word::kTip) + 1 + end];
    }
    /// A slot's word, and the tip that such a word tells.
    std::uint32_t word(std::uint32_t v, std::uint32_t side) const { return lr[2 * v + side]; }
    std::uint32_t tip(std::uint32_t w) const {
        const std::uint32_t i = w & word::kTip;
        return (w & (word::kSpecial | word::kIrregular)) == word::kIrregular ? star[i] : i;
    }

    static constexpr std::uint32_t kNotPlain = UINT32_MAX;
    /// The opposite of a ring corner where nothing special is near: no wart, copy, border, ring's end or irregular
    /// triangle. kNotPlain where LrOperators has to look closer.
    std::uint32_t plain_opposite(std::uint32_t corner) const {
        const std::uint32_t v = corner / 8, side = corner / 4 % 2;
        if (v < 2 || v + 1 >= ring_vertices) return kNotPlain;
        const std::uint32_t* left = lr.data() + 2 * std::size_t{v};  // left[-2]: that of v.p
        if (corner % 4 == 1) return (left[0] | left[1]) <= word::kTip ? corner ^ 4 : kNotPlain;
        const std::uint32_t* w = left + side;
        const std::uint32_t u = w[0];
        if ((u | w[-2]) > word::kTip || closing(left[0])) return kNotPlain;
        if (corner % 8 % 6 == 0) {  // at v: the slot that starts at v.n, or the one that ends at the tip
            if (w[2] > word::kTip) return kNotPlain;
            if (w[2] == u) return corner + 8 + (side == 0 ? 2 : 0U - 2);
            if (u < 2 || u >= ring_vertices) return kNotPlain;
            const std::uint32_t* far = lr.data() + 2 * std::size_t{u - 1};
            return far[side] == v + 1 && !skips(far[std::ptrdiff_t{side} - 2]) && !closing(far[0])
                       ? 8 * (u - 1) + corner % 8
                       : kNotPlain;
        }
        // At v.n: the slot that ends at v, or the one that starts at the tip.
        if (skips(w[-4]) || closing(left[-2]) || closing(left[-4])) return kNotPlain;
        if (w[-2] == u) return corner - 8 + (side == 0 ? 0U - 2 : 2);
        return u < ring_vertices && lr[2 * std::size_t{u} + side] == v ? 8 * u + corner % 8 : kNotPlain;
    }

    /// The neighbours of ring vertex v where its triangles are two runs of T1, one a side, which is nearly always: v.n,
    /// right .. right + right_count, v.p, left + left_count .. left (all inclusive, in swing order after left itself).
    struct PlainFan {
        std::uint32_t left, left_count, right, right_count;
    };
    /// Along a corridor v's tips run against v, so between L[v] and L[v.p] lie the slots that have v as their tip:
    /// their number needs no walk, only a look at each. Constant time; false where LrOperators has to walk.
    bool plain_fan(std::uint32_t v, PlainFan& fan) const {
        if (v < 2 || v + 1 >= ring_vertices) return false;
        const std::uint32_t* w = lr.data() + 2 * std::size_t{v};
        if ((w[0] | w[1] | w[-1] | w[-2]) > word::kTip) return false;
        // The slots two before may be anything but a wart, which would skip v.p, or another ring's end.
        if (skips(w[-3]) | skips(w[-4]) | closing(w[-4])) return false;
        fan = {w[0], w[-2] - w[0], w[1], w[-1] - w[1]};
        return run_has_tip(fan.left, fan.left_count, v, 0) && run_has_tip(fan.right, fan.right_count, v, 1);
    }

    static bool skips(std::uint32_t w) { return (w & (word::kSpecial | word::kWart)) == word::kWart; }
    static bool closing(std::uint32_t w) { return (w & word::kKind) == word::kClosing; }

    std::uint32_t t0_vertex(std::uint32_t i) const { return vo[std::size_t{i / 3} * 6 + i % 3] & ~word::kT0Flip; }
    std::uint32_t t0_opposite(std::uint32_t i) const { return vo[std::size_t{i / 3} * 6 + 3 + i % 3]; }
    std::uint32_t isolated_corner(std::uint32_t i) const { return c[i]; }

    /// Do the slots first .. first + count - 1 have the plain tip v? Four at most; no branch on how many.
    bool run_has_tip(std::uint32_t first, std::uint32_t count, std::uint32_t v, std::uint32_t side) const {
        if (count > 4 || std::uint64_t{first} + 3 >= ring_vertices) return false;
        const std::uint32_t* w = lr.data() + 2 * std::size_t{first} + side;
        return ((w[0] == v) | (count < 1)) & ((w[2] == v) | (count < 2)) & ((w[4] == v) | (count < 3)) &
               ((w[6] == v) | (count < 4));
    }

    std::uint32_t used_vertices() const { return ring_vertices + static_cast<std::uint32_t>(c.size()); }
    /// Numbers that triangles have: 2 m_r, then the T0. Those of redundant T2 copies and borders name no triangle.
    std::uint32_t triangle_numbers() const { return 2 * ring_vertices + static_cast<std::uint32_t>(vo.size() / 6); }
    /// 2 m_r + 6 n_0 + 3 n_i + m_i.
    std::size_t references() const { return lr.size() + vo.size() + star.size() + c.size(); }
};

struct LrStatistics {
    std::uint32_t t0 = 0, t0_wart = 0, t1_irregular = 0, t2_irregular = 0, t2 = 0, isolated = 0;
};

struct LrTable {
    std::uint32_t vertices = 0, ring_vertices = 0;
    std::vector<std::uint32_t> lr, vo, star, c;
    LrStatistics statistics;

    LrView view() const { return {vertices, ring_vertices, lr, vo, star, c}; }
};

/// Which element of the corner table each element of the LR tables is.
struct LrMap {
    std::vector<VertexId> vertex;  ///< vertex[LR vertex] = corner table's
    std::vector<TriangleId>
        triangle;  ///< triangle[LR triangle] = corner table's, null for redundant copies and borders
    std::vector<std::uint32_t>
        start;  ///< start[LR triangle] = 0, 1, 2: which of its corners is the LR triangle's first
};

}  // namespace lr
