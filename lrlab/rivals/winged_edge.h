#pragma once
// The winged edge specialized to triangles: 9.5 references a triangle. Paper: LR 2011, section 3 (Baumgart;
// half-edges).
//
// Each half-edge stores its start vertex, the opposite half-edge and the next one; each vertex stores a half-edge that
// starts there. A half-edge has the number of the corner opposite to it:
//
//             v(c)                half-edge c starts at v(c.n) and ends at v(c.p); c.n and c.p follow it
//             /  \                c.v is the start of half-edge c.p, which is c.n.n: next is read, not computed
//            / c  \               c.o is the corner in c's opposite half-edge
//           / ---> \              c.t: half-edges 3t, 3t+1, 3t+2 are those of triangle t (so no face is stored)
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

/// A view of the arrays of a WingedEdge, or of a memory-mapped file; does not own them. Has the interface of Operators,
/// in constant time unless stated otherwise. Entries and arguments are not checked.
struct WingedEdgeView : CornerWalks<WingedEdgeView, 3> {
    std::uint32_t vertices = 0;
    std::span<const HalfEdge> half_edges;  ///< three per triangle
    /// A half-edge that starts at each vertex, at a border the border half-edge; null: the vertex has no triangle.
    std::span<const CornerId> half_edge_at;

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

    /// Triangles keep the input's numbers; degenerate ones are stored, but no operator reaches them.
    bool is_canonical(TriangleId t) const {
        const VertexId a = half_edges[3 * t.value].start, b = half_edges[3 * t.value + 1].start;
        const VertexId c = half_edges[3 * t.value + 2].start;
        return a != b && b != c && c != a;
    }
    std::uint32_t triangle_numbers() const { return static_cast<std::uint32_t>(half_edges.size() / 3); }
    /// 9 n + m for n triangles and m vertices.
    std::size_t references() const { return 3 * half_edges.size() + half_edge_at.size(); }
};

struct WingedEdge {
    std::vector<HalfEdge> half_edges;
    std::vector<CornerId> half_edge_at;

    WingedEdgeView view() const {
        return {{}, static_cast<std::uint32_t>(half_edge_at.size()), half_edges, half_edge_at};
    }
};

/// Converts a pseudo-manifold corner table (split_fans), so that a vertex's whole star is reached from one half-edge.
/// Cost: O(T) time; no memory beside the result.
WingedEdge build_winged_edge(const CornerTable& table);

}  // namespace lacedring
