#pragma once
// The winged edge customised to triangles: 9.5 references a triangle. Paper: LR 2011, section 3 (Baumgart; half-edges).
//
// Each half-edge holds its start vertex, the opposite half-edge and the next one; each vertex holds a half-edge that
// starts there. Half-edge h is named by the corner that faces it, so corner c is in half-edge c:
//
//             v(c)                half-edge c starts at v(c.n) and ends at v(c.p); c.n and c.p follow it
//             /  \                c.v is the start of half-edge c.p, which is c.n.n: next is read, not computed
//            / c  \               c.o is the corner in c's opposite half-edge
//           / ---> \              c.t: half-edges 3t, 3t+1, 3t+2 are those of triangle t (so no face is held)
//      v(c.n)     v(c.p)

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/topology.hpp"

namespace lacedring {

struct HalfEdge {
    VertexId start;
    CornerId opposite;  ///< null on a border
    CornerId next;
};

/// The arrays, wherever they are: in a WingedEdge, or in a memory-mapped file. Holds no copy. The names of Operators,
/// each in constant time unless it says otherwise. Entries are trusted, as are the arguments.
struct WingedEdgeView : CornerWalks<WingedEdgeView, 3> {
    std::uint32_t vertices = 0;
    std::span<const HalfEdge> half_edges;    ///< 3 a triangle
    std::span<const CornerId> half_edge_at;  ///< 1 a vertex: a half-edge that starts there, at a border the one
                                             ///< on it; null: of no triangle

    using CornerWalks::corner;

    /// c.n
    CornerId next(CornerId c) const { return half_edges[c.value].next; }
    /// c.p
    CornerId previous(CornerId c) const { return next(next(c)); }
    /// c.v
    VertexId vertex(CornerId c) const { return half_edges[previous(c).value].start; }
    /// c.o: null across a border.
    CornerId opposite(CornerId c) const { return half_edges[c.value].opposite; }
    /// v.c: null for a vertex of no triangle.
    CornerId corner(VertexId v) const {
        const CornerId h = half_edge_at[v.value];
        return h.is_null() ? h : next(h);
    }

    /// Triangles keep the input's numbers; degenerate ones are held, and take part in nothing.
    bool is_canonical(TriangleId t) const {
        const VertexId a = half_edges[3 * t.value].start, b = half_edges[3 * t.value + 1].start;
        const VertexId c = half_edges[3 * t.value + 2].start;
        return a != b && b != c && c != a;
    }
    std::uint32_t triangle_numbers() const { return static_cast<std::uint32_t>(half_edges.size() / 3); }
    /// 9 n + m.
    std::size_t references() const { return 3 * half_edges.size() + half_edge_at.size(); }
};

struct WingedEdge {
    std::vector<HalfEdge> half_edges;
    std::vector<CornerId> half_edge_at;

    WingedEdgeView view() const {
        return {{}, static_cast<std::uint32_t>(half_edge_at.size()), half_edges, half_edge_at};
    }
};

/// From a pseudo-manifold corner table (split_fans), so that one half-edge reaches a vertex's whole star.
/// Cost: O(T) time; nothing but the result.
WingedEdge build_winged_edge(const CornerTable& table);

}  // namespace lacedring
