#pragma once
// What every structure that answers opposite, next, vertex and v.c has in common: the walks around a vertex.

#include <cstdint>

#include "lrcore/base/ids.h"

namespace lr {

/// Base of a structure `Self` with next(c), previous(c), opposite(c), vertex(c), corner(v): the other operators, with
/// the names, the meanings and the order of visits of LrOperators (lrcore/lr/operators.h), so that one template runs on
/// all.
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
    CornerId canonical(CornerId c) const { return store().is_canonical(store().triangle(c)) ? c : null_corner; }

    /// Is the vertex on a border? O(valence).
    bool is_border(VertexId v) const {
        const CornerId first = store().corner(v);
        for (CornerId c = first; !c.is_null();) {
            c = store().swing(c);
            if (c == first) return false;
        }
        return !first.is_null();
    }

    /// Calls visit(corner) for every triangle around v. O(valence).
    template <class Visit>
    void star(VertexId v, Visit visit) const {
        const CornerId first = store().corner(v);
        if (first.is_null()) return;
        CornerId c = first;
        do {
            visit(c);
            c = store().swing(c);
        } while (!c.is_null() && c != first);
        if (!c.is_null()) return;
        for (c = store().swing_back(first); !c.is_null(); c = store().swing_back(c)) visit(c);
    }

    /// Edges at v: its triangles, and one more on a border. O(valence).
    std::uint32_t valence(VertexId v) const {
        const CornerId first = store().corner(v);
        if (first.is_null()) return 0;
        std::uint32_t count = 0;
        CornerId c = first;
        do {
            ++count;
            c = store().swing(c);
        } while (!c.is_null() && c != first);
        if (!c.is_null()) return count;
        for (c = store().swing_back(first); !c.is_null(); c = store().swing_back(c)) ++count;
        return count + 1;
    }

    /// Calls visit(vertex) for every neighbour of v once, border neighbours included. O(valence), times the cost of
    /// c.v.
    template <class Visit>
    void neighbours(VertexId v, Visit visit) const {
        store().star(v, [&](CornerId c) {
            visit(store().vertex(store().next(c)));
            if (store().left(c).is_null())
                visit(store().vertex(store().previous(c)));  // the last edge, before the border
        });
    }
};

}  // namespace lr
