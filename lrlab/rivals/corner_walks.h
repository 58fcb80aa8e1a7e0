#pragma once
// What every structure that answers opposite, next, vertex and v.c has in common: the walks around a vertex.

#include <cstdint>

#include "lacedring/base.hpp"

namespace lacedring {

/// Base of a structure `Self` with next(c), previous(c), opposite(c), vertex(c), corner(v): the other operators, with
/// the names, the meanings and the order of visits of Operators (operators.hpp), so that one
/// template runs on all. Where corner(v) may be another than the first in swing order at a border, `Self` has its own
/// star_begin.
template <class Self>
class CornerWalks {
  public:
    const Self& store() const { return static_cast<const Self&>(*this); }

    /// c.l = c.n.o
    CornerId left(CornerId c) const { return store().opposite(store().next(c)); }
    /// c.r = c.p.o
    CornerId right(CornerId c) const { return store().opposite(store().previous(c)); }
    /// c.s: the next corner around c's vertex, null at a border.
    CornerId swing(CornerId c) const {
        const CornerId l = store().left(c);
        return l.is_null() ? l : store().next(l);
    }
    /// The corner whose swing is c, null at a border.
    CornerId swing_back(CornerId c) const {
        const CornerId r = store().right(c);
        return r.is_null() ? r : store().previous(r);
    }

    /// Only laced rings give one corner several numbers: here a corner is canonical or of no triangle.
    CornerId canonical(CornerId c) const { return store().is_canonical(store().triangle(c)) ? c : kNullCorner; }

    /// Is the vertex on a border? O(valence).
    bool is_border(VertexId v) const {
        const CornerId first = store().corner(v);
        for (CornerId c = first; !c.is_null();) {
            c = store().swing(c);
            if (c == first) return false;
        }
        return !first.is_null();
    }

    /// Where stars begin: at v.c, which at a border is the first corner there in swing order; null: of no triangle.
    CornerId star_begin(VertexId v) const { return store().corner(v); }

    // The loops below have two ways out each: with one, the compiler has the next step wait for which it is.

    /// Calls visit(corner) for every triangle around v, in swing order from star_begin. O(valence).
    template <class Visit>
    void star(VertexId v, Visit visit) const {
        const CornerId first = store().star_begin(v);
        if (first.is_null()) return;
        for (CornerId c = first;;) {
            visit(c);
            const CornerId l = store().left(c);
            if (l.is_null()) return;
            c = store().next(l);
            if (c == first) return;
        }
    }

    /// Edges at v: its triangles, and one more on a border. O(valence).
    std::uint32_t valence(VertexId v) const {
        const CornerId first = store().star_begin(v);
        if (first.is_null()) return 0;
        std::uint32_t count = 1;
        for (CornerId c = first;; ++count) {
            const CornerId l = store().left(c);
            if (l.is_null()) return count + 1;
            c = store().next(l);
            if (c == first) return count;
        }
    }

    /// Calls visit(vertex) for every neighbour of v once, in swing order: on a border from one border neighbour to the
    /// other. O(valence), times the cost of c.v.
    template <class Visit>
    void neighbors(VertexId v, Visit visit) const {
        const CornerId first = store().star_begin(v);
        if (first.is_null()) return;
        for (CornerId c = first;;) {
            visit(store().vertex(store().next(c)));
            const CornerId l = store().left(c);
            if (l.is_null()) return visit(store().vertex(store().previous(c)));  // beyond the last triangle
            c = store().next(l);
            if (c == first) return;
        }
    }
};

}  // namespace lacedring
