#pragma once
// The Corner Table: for every corner of a triangle mesh, its vertex (V) and its opposite corner (O).
// Paper: LR 2011, section 2.1; Rossignac's chapter, "Corner Table".
//
//              v(n(c))                    c.n next        c.p previous
//               /  \                      c.o opposite    c.s swing = n(l(c))... around v(c)
//      r(c)    / n  \                     c.l left  = opposite(next(c))
//             /      \     o(c)           c.r right = opposite(previous(c))
//            / c    p \                   (as in the paper; the chapter has left and right swapped)
//        v(c) ------- v(p(c))
//
// Corner c belongs to triangle c/3; next follows the triangle's stored order. Opposite is null across a border.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lrcore/base/ids.h"
#include "lrcore/base/result.h"

namespace lr {

constexpr TriangleId triangle(CornerId c) {
    return {c.value / 3};
}
constexpr CornerId corner(TriangleId t, std::uint32_t i) {
    return {t.value * 3 + i};
}
constexpr CornerId next(CornerId c) {
    return {c.value % 3 == 2 ? c.value - 2 : c.value + 1};
}
constexpr CornerId previous(CornerId c) {
    return {c.value % 3 == 0 ? c.value + 2 : c.value - 1};
}

/// How the triangles of an index list were joined into a manifold.
struct Topology {
    std::uint32_t degenerate = 0;         ///< triangles with a repeated vertex; they take part in nothing
    std::uint32_t border_edges = 0;       ///< edges of the input with one triangle
    std::uint32_t nonmanifold_edges = 0;  ///< edges of the input with more than two triangles
    std::uint32_t flipped = 0;            ///< triangles turned round to orient their component
    std::uint32_t cut_edges = 0;  ///< manifold edges left unjoined because no orientation fits (a Moebius strip)
};

/// Corner table of any triangle soup, made manifold by leaving edges unjoined and oriented by flipping triangles.
/// No vertex is renumbered: a vertex whose triangles form several fans keeps its one number.
struct CornerTable {
    /// V and O side by side: whoever reads one of them mostly reads the other, so a triangle is one cache line.
    struct Corner {
        VertexId vertex;
        CornerId opposite;  ///< or null across a border, a cut or a degenerate triangle
    };
    std::vector<Corner> corners;      ///< 3 per triangle, in the input's order; the last two swapped where flipped
    std::vector<std::uint64_t> flip;  ///< bit t: triangle t was turned round; empty if none was
    std::uint32_t vertex_count = 0;
    Topology topology;

    std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(corners.size() / 3); }
    VertexId vertex(CornerId c) const { return corners[c.value].vertex; }
    CornerId opposite(CornerId c) const { return corners[c.value].opposite; }
    CornerId left(CornerId c) const { return opposite(next(c)); }
    CornerId right(CornerId c) const { return opposite(previous(c)); }
    /// Next corner around vertex(c), or null at a border.
    CornerId swing(CornerId c) const {
        const CornerId l = left(c);
        return l.is_null() ? null_corner : next(l);
    }
    bool flipped(TriangleId t) const { return !flip.empty() && (flip[t.value / 64] >> (t.value % 64) & 1) != 0; }
    bool degenerate(TriangleId t) const {
        const VertexId a = vertex(corner(t, 0)), b = vertex(corner(t, 1)), c = vertex(corner(t, 2));
        return a == b || b == c || c == a;
    }
};

/// Builds the corner table of `indices` (3 per triangle, each < vertex_count).
/// Edges of two triangles are joined; at an edge of more, opposed half-edges are paired so that few vertices split into
/// several fans (after Rossignac and Cardoze's Matchmaker). Orientation is made consistent per component where it can
/// be. Cost: O(T) time; 24 bytes a triangle, and 26 more while it runs. Errors: too_large (2^29 vertices; or 2^32
/// corners and vertices together), malformed (index out of range). Untrusted input: safe.
Result<CornerTable> build_corner_table(std::span<const std::uint32_t> indices, std::uint32_t vertex_count);

/// Checks V and O against each other: involution, shared edges opposed, no degenerate joined. Empty if all is well.
std::string validate(const CornerTable& table);

}  // namespace lr
