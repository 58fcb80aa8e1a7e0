#pragma once
// The steps from corner to corner, and the walks around a vertex, of every structure that knows opposite corners: the
// corner table, LR tables, and others that a program has.

#include <cstdint>

#include "lacedring/base.hpp"

namespace lacedring {

/// Base of a structure `Self` with opposite(c), null across a border, and vertex(c). Triangle t has the corners
/// kStride * t, + 1 and + 2. A `Self` with other ways to go on has functions of these names of its own, which are used
/// here, too.
template <class Self, std::uint32_t kStride>
class CornerSteps {
  public:
    /// c.t
    static constexpr TriangleId triangle(CornerId c) { return TriangleId{c.value / kStride}; }
    /// t.c: the triangle's first corner, or that `i` behind it; next gives the others.
    static constexpr CornerId corner(TriangleId t, std::uint32_t i = 0) { return CornerId{t.value * kStride + i}; }
    /// c.n
    static constexpr CornerId next(CornerId c) { return CornerId{c.value % kStride == 2 ? c.value - 2 : c.value + 1}; }
    /// c.p
    static constexpr CornerId previous(CornerId c) {
        return CornerId{c.value % kStride == 0 ? c.value + 2 : c.value - 1};
    }
    /// c.l = c.n.o
    CornerId left(CornerId c) const { return self().opposite(self().next(c)); }
    /// c.r = c.p.o
    CornerId right(CornerId c) const { return self().opposite(self().previous(c)); }
    /// c.s: the next corner around c's vertex, null at a border.
    CornerId swing(CornerId c) const {
        const CornerId l = self().left(c);
        return l.is_null() ? l : self().next(l);
    }
    /// The corner whose swing is c, null at a border.
    CornerId swing_back(CornerId c) const {
        const CornerId r = self().right(c);
        return r.is_null() ? r : self().previous(r);
    }
    /// Has the triangle a vertex twice?
    bool degenerate(TriangleId t) const {
        const VertexId a = self().vertex(corner(t)), b = self().vertex(corner(t, 1)), c = self().vertex(corner(t, 2));
        return a == b || b == c || c == a;
    }

    // The loops here and below have two ways out each: with one, the compiler has the next step wait for which it is.

    /// Calls visit(corner) for the corners around c's vertex, from c in swing order, and where that ends at a border
    /// from c back to the other, until visit returns true. Returns whether no border was met. O(valence).
    template <class Visit>
    bool around(CornerId c, Visit visit) const {
        for (CornerId x = c;;) {
            if (visit(x)) return true;
            const CornerId l = self().left(x);
            if (l.is_null()) break;
            x = self().next(l);
            if (x == c) return true;
        }
        for (CornerId x = self().swing_back(c); !x.is_null() && !visit(x);) x = self().swing_back(x);
        return false;
    }

  protected:
    const Self& self() const { return static_cast<const Self&>(*this); }
};

/// The same of a structure that also has corner(v), null for a vertex of no triangle. One template runs on all, as they
/// visit in the same order. Where corner(v) may be another than the first in swing order at a border, `Self` has its
/// own star_begin.
template <class Self, std::uint32_t kStride>
class CornerWalks : public CornerSteps<Self, kStride> {
  public:
    using CornerSteps<Self, kStride>::corner;

    /// What says how many vertices and triangles there are.
    const Self& store() const { return self(); }

    /// Only laced rings give one corner several numbers: here a corner is canonical or of no triangle.
    CornerId canonical(CornerId c) const { return self().is_canonical(self().triangle(c)) ? c : kNullCorner; }

    /// Is the vertex on a border? O(valence).
    bool is_border(VertexId v) const {
        const CornerId first = self().corner(v);
        return !first.is_null() && !this->around(first, [](CornerId) { return false; });
    }

    /// Where stars begin: at v.c, or if v is on a border at the corner that no swing leads to.
    CornerId star_begin(VertexId v) const { return self().corner(v); }

    /// Calls visit(corner) for every triangle around v in swing order, from star_begin. O(valence).
    template <class Visit>
    void star(VertexId v, Visit visit) const {
        const CornerId first = self().star_begin(v);
        if (first.is_null()) return;
        for (CornerId c = first;;) {
            visit(c);
            const CornerId l = self().left(c);
            if (l.is_null()) return;
            c = self().next(l);
            if (c == first) return;
        }
    }

    /// Edges at v: its triangles, and one more on a border. O(valence).
    std::uint32_t valence(VertexId v) const {
        const CornerId first = self().corner(v);
        if (first.is_null()) return 0;
        std::uint32_t count = 0;
        const bool closed = this->around(first, [&](CornerId) {
            ++count;
            return false;
        });
        return closed ? count : count + 1;
    }

    /// Calls visit(vertex) for every neighbor of v once, in the order of star: of each triangle that of next, and on a
    /// border at last the other end. O(valence), times the cost of c.v.
    template <class Visit>
    void neighbors(VertexId v, Visit visit) const {
        const CornerId first = self().star_begin(v);
        if (first.is_null()) return;
        for (CornerId c = first;;) {
            visit(self().vertex(self().next(c)));
            const CornerId l = self().left(c);
            if (l.is_null()) return visit(self().vertex(self().previous(c)));  // beyond the last triangle
            c = self().next(l);
            if (c == first) return;
        }
    }

  protected:
    using CornerSteps<Self, kStride>::self;
};

}  // namespace lacedring
