#pragma once
// Steps from corner to corner and walks around a vertex, for any structure with opposite corners: the corner table, LR
// tables, and a program's own structures.

#include <cstdint>

#include "lacedring/base.hpp"

namespace lacedring {

/// Base class of a structure `Self` that has opposite(c), null across a border, and vertex(c). Triangle t has the
/// corners kStride * t, kStride * t + 1 and kStride * t + 2. `Self` may redefine any of these functions; the others
/// then call its version.
template <class Self, std::uint32_t kStride>
class CornerSteps {
  public:
    /// c.t
    static constexpr TriangleId triangle(CornerId c) { return TriangleId{c.value / kStride}; }
    /// t.c: the triangle's first corner plus `i`. next() gives the other corners.
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
    /// The corner x with swing(x) == c, null at a border.
    CornerId swing_back(CornerId c) const {
        const CornerId r = self().right(c);
        return r.is_null() ? r : self().previous(r);
    }
    /// Does the triangle have a repeated vertex?
    bool degenerate(TriangleId t) const {
        const VertexId a = self().vertex(corner(t)), b = self().vertex(corner(t, 1)), c = self().vertex(corner(t, 2));
        return a == b || b == c || c == a;
    }

    // The loops here and below have two exits each: merging them makes each step depend on the exit test.

    /// Calls visit(corner) for the corners around c's vertex until visit returns true: from c in swing order; at a
    /// border, continues from c backward to the other border. Returns false if it met a border. O(valence).
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

/// CornerSteps for a structure that also has corner(v), null for a vertex of no triangle. All such structures visit in
/// the same order. If corner(v) of a border vertex may not be the first corner in swing order, `Self` must redefine
/// star_begin.
template <class Self, std::uint32_t kStride>
class CornerWalks : public CornerSteps<Self, kStride> {
  public:
    using CornerSteps<Self, kStride>::corner;

    /// The object that has the numbers of vertices and triangles.
    const Self& store() const { return self(); }

    /// c, or null if c belongs to no triangle. Only LR tables, which redefine this, have several numbers for one
    /// corner.
    CornerId canonical(CornerId c) const { return self().is_canonical(self().triangle(c)) ? c : kNullCorner; }

    /// Is the vertex on a border? O(valence).
    bool is_border(VertexId v) const {
        const CornerId first = self().corner(v);
        return !first.is_null() && !this->around(first, [](CornerId) { return false; });
    }

    /// The first corner of v's star: v.c, or, if v is on a border, the corner that no swing leads to.
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

    /// Number of edges at v: its triangles, plus one on a border. O(valence).
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

    /// Calls visit(vertex) once for every neighbor of v, in the order of star(): vertex(next(c)) for each corner c; on
    /// a border, finally the last triangle's other vertex. O(valence), times the cost of vertex().
    template <class Visit>
    void neighbors(VertexId v, Visit visit) const {
        const CornerId first = self().star_begin(v);
        if (first.is_null()) return;
        for (CornerId c = first;;) {
            visit(self().vertex(self().next(c)));
            const CornerId l = self().left(c);
            if (l.is_null()) return visit(self().vertex(self().previous(c)));  // last triangle before a border
            c = self().next(l);
            if (c == first) return;
        }
    }

  protected:
    using CornerSteps<Self, kStride>::self;
};

}  // namespace lacedring
