#pragma once
// The corner operators on LR tables.

#include <cstdint>

#include "lacedring/base.hpp"
#include "lacedring/corner_walks.hpp"
#include "lacedring/streams.hpp"

namespace lacedring {

// The neighbors of a ring vertex v, side by side, from fewer words than a walk over its corners reads.
//
// On each side of the ring, the triangles at v run from the slot that starts at v to the slot that ends at v. Along a
// corridor, the triangles in between have v as their tip and lie in a row of slots:
//
//          x---o---o---o---o
//           \   \  |  /   /            slots x, x + 1, ... have tip v
//            \   \ | /   /
//     v.n o-------- v --------o v.p    v.l or v.r is x; the tip of the slot that ends at v is where the row ends
//
// LrView::plain_fan counts such rows. FanSide also handles warts, T2, irregular triangles and T0.

/// The neighbors of v between v.n and v.p on one side, in this order: one fewer than triangles there.
template <class Store>
class FanSide {
  public:
    std::uint32_t size = 0;
    std::uint32_t vertex[16];  ///< the first `size` are set

    /// Lists the neighbors of side 0 (left) or 1 (right). w, p, pp: the words of v, v.p and v.p.p on that side.
    /// Constant time. Returns false if there are many or a border is near: the list is then invalid, and Operators must
    /// walk over corners.
    template <std::uint32_t side>
    bool find(const Store& s, std::uint32_t v, std::uint32_t w, std::uint32_t p, std::uint32_t pp) {
        size = 0;
        if (is_wart(p) || is_redundant(p)) return true;  // v is the middle of a T2
        // The slots of the first and the last triangle at v.
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
        // The edge (v, x) of `slot`'s triangle: 0: end and tip; 1: start and tip.
        std::uint32_t edge = from == v ? 1 : 0;
        for (;;) {
            if ((w & word::kIrregular) != 0) {
                std::uint32_t c = s.star_opposite(slot, side, edge);  // the corner facing (v, x) from the other side
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
            // A left slot with its own triangle does not close its ring.
            x = side == 0 ? x + 1 : ring_next(s, x);
            if (is_wart(w)) x = ring_next(s, x);
            vertex[size++] = x;
        }
        if (to != v - 1) vertex[size++] = to;
        return true;
    }

  private:
    // Leaves room for a row of four, or a vertex and v.p.p.
    static constexpr std::uint32_t kMost = 11;

    static bool is_wart(std::uint32_t w) { return (w & (word::kSpecial | word::kWart)) == word::kWart; }
    static bool is_redundant(std::uint32_t w) { return (w & word::kKind) == word::kRedundant; }
    static std::uint32_t start_corner(std::uint32_t v, std::uint32_t side) { return 8 * v + 6 * side; }
    static std::uint32_t end_corner(std::uint32_t v, std::uint32_t side) { return 8 * v + 2 + 2 * side; }
    static std::uint32_t ring_next(const Store& s, std::uint32_t v) { return s.closes(v) ? s.first(v) : v + 1; }
};

// The corner operators on LR tables, each in constant time. Paper: LR 2011, sections 4.4 to 4.7 and 5.
//
// The corners of a slot have roles: start (at v), tip, end (at v.n, or at v.n.n if the slot has a wart). Left corners
// 8v+0, 1, 2 are start, tip, end; right corners 8v+4, 5, 6 are end, tip, start. So the same code serves both sides:
//
//                 tip                        across the ring edge (start, end): the other side's tip
//                /   \                       across (tip, end), facing the start corner: see facing_start()
//               /     \                      across (start, tip), facing the end corner: see facing_end()
//       v = start ---- end = v.n
//
// `Store` is LrView, CompactLrView, or a test's wrapper that counts reads.

template <class Store>
class Operators : public CornerWalks<Operators<Store>, 4> {
    using Walks = CornerWalks<Operators<Store>, 4>;

  public:
    using Walks::corner, Walks::next, Walks::previous;

    /// `copies`: LrStreamView::copies, used by original() only.
    explicit Operators(const Store& store, std::span<const std::uint32_t> copies = {})
        : s_(store), ring_(store.ring_vertices), copies_(copies) {}

    const Store& store() const { return s_; }

    /// The vertex that v is a copy of, or v itself if it is not a copy. A non-manifold vertex has a copy for each
    /// further fan of triangles; all other operators treat copies as separate vertices. O(log copies).
    VertexId original(VertexId v) const {
        return VertexId{LrStreamView<Store>{.view = {}, .copies = copies_}.original(v.value)};
    }

    // Ring order (paper: v.n, v.p).
    std::uint32_t ring_next(std::uint32_t v) const { return s_.closes(v) ? s_.first(v) : v + 1; }
    std::uint32_t ring_previous(std::uint32_t v) const {
        // The left triangle of a ring's first vertex is a T2 with the ring's last and first edges; its tip is the last
        // vertex.
        return v == 0 || s_.closes(v - 1) ? s_.tip(v, 0) : v - 1;
    }

    bool is_t0(CornerId c) const { return c.value >= 8 * ring_; }

    /// Does triangle number t exist, and is it canonical (not the first copy of a T2)?
    bool is_canonical(TriangleId t) const {
        return t.value >= 2 * ring_ || (s_.kind(t.value / 2, t.value % 2) & word::kSpecial) == 0;
    }

    /// The canonical number of corner c; null for a corner of a border slot, which has no triangle.
    CornerId canonical(CornerId c) const {
        // Turns c once, or twice if the triangle has three ring edges.
        while (!is_t0(c)) {
            const Slot slot = slot_of(c);
            const std::uint32_t kind = s_.kind(slot.v, slot.side);
            if ((kind & word::kSpecial) == 0) return c;
            if (kind == word::kBorder) return kNullCorner;
            constexpr Role kTurned[] = {kTip, kEnd, kStart};  // roles in the second copy of start, tip, end
            c = at(ring_next(slot.v), slot.side, kTurned[slot.role]);
        }
        return c;
    }

    /// c.v
    VertexId vertex(CornerId c) const {
        if (is_t0(c)) return VertexId{s_.t0_vertex(t0_index(c))};
        const Slot slot = slot_of(c);
        switch (slot.role) {
            case kStart:
                return VertexId{slot.v};
            case kEnd:
                return VertexId{end(slot.v, slot.side)};
            default: {
                const std::uint32_t kind = s_.kind(slot.v, slot.side);
                if (kind == word::kClosing) return VertexId{ring_next(s_.first(slot.v))};
                return kind == word::kBorder ? kNullVertex : VertexId{s_.tip(slot.v, slot.side)};
            }
        }
    }

    /// c.o: canonical, or null across a border.
    CornerId opposite(CornerId c) const {
        if (is_t0(c)) return CornerId{s_.t0_opposite(t0_index(c))};
        if constexpr (kHasOpposites) {
            const std::uint32_t plain = s_.plain_opposite(c.value);
            if (plain != Store::kNotPlain) return CornerId{plain};
        }
        Slot slot = slot_of(c);
        std::uint32_t kind = s_.kind(slot.v, slot.side);
        if ((kind & word::kSpecial) != 0) {
            c = canonical(c);
            if (c.is_null()) return c;
            slot = slot_of(c);
            kind = s_.kind(slot.v, slot.side);
        }
        switch (slot.role) {
            case kTip:
                return facing_tip(slot.v, slot.side, kind);
            case kStart:
                return facing_start(slot.v, slot.side, kind);
            default:
                return facing_end(slot.v, slot.side, kind);
        }
    }

    /// v.c: canonical; null for a vertex of no triangle.
    CornerId corner(VertexId v) const {
        if (v.value < ring_) return canonical(at(v.value, 0, kStart));  // the left side always has a triangle
        return v.value < s_.used_vertices() ? CornerId{s_.isolated_corner(v.value - ring_)} : kNullCorner;
    }

    /// v.c, or, if v is on a border, the corner that no swing leads to.
    CornerId star_begin(VertexId v) const {
        const CornerId first = corner(v);
        if constexpr (kHasFans) {  // these find only vertices that are not on a border
            typename Store::PlainFan fan;
            FanSide<Store> left, right;
            if (v.value < ring_ && (s_.plain_fan(v.value, fan) || find_sides(v.value, left, right))) return first;
        }
        for (CornerId c = first; !c.is_null();) {
            const CornerId back = this->swing_back(c);
            if (back.is_null()) return c;
            if (back == first) break;
            c = back;
        }
        return first;
    }

    /// Number of edges at v: its triangles, plus one on a border. O(valence); constant if plain_fan or FanSide
    /// succeeds.
    std::uint32_t valence(VertexId v) const {
        if constexpr (kHasFans) {
            typename Store::PlainFan fan;
            if (s_.plain_fan(v.value, fan)) return 4 + fan.left_count + fan.right_count;
            FanSide<Store> left, right;
            if (find_sides(v.value, left, right)) return left.size + right.size + 2;
        }
        return Walks::valence(v);
    }

    /// Calls visit(vertex) once for every neighbor of v, in the order of star(). Cost: as valence.
    template <class Visit>
    void neighbors(VertexId v, Visit visit) const {
        if (!near_neighbors(v, visit)) Walks::neighbors(v, visit);
    }

    /// If the slots near v give its neighbors in constant time, visits them as neighbors() does and returns true.
    /// Otherwise, and always on a border, visits nothing and returns false. valence and star_begin use the same
    /// shortcut.
    template <class Visit>
    bool near_neighbors(VertexId v, Visit visit) const {
        if constexpr (kHasFans) {
            typename Store::PlainFan fan;
            if (s_.plain_fan(v.value, fan)) {
                visit(VertexId{fan.left});
                visit(VertexId{v.value + 1});
                for (std::uint32_t i = 0; i <= fan.right_count; ++i) visit(VertexId{fan.right + i});
                visit(VertexId{v.value - 1});
                for (std::uint32_t i = fan.left_count; i > 0; --i) visit(VertexId{fan.left + i});
                return true;
            }
            FanSide<Store> left, right;
            if (find_sides(v.value, left, right)) {
                // A star begins with the triangle of v's left slot. If this is a T0w, its T2w comes last.
                std::uint32_t first = 0;
                if (left.size == 0) {
                    visit(VertexId{v.value - 1});
                } else {
                    first = skips(v.value, 0) ? 1 : 0;
                    for (std::uint32_t i = first + 1; i-- > 0;) visit(VertexId{left.vertex[i]});
                }
                visit(VertexId{v.value + 1});
                for (std::uint32_t i = 0; i < right.size; ++i) visit(VertexId{right.vertex[i]});
                if (left.size == 0) return true;
                visit(VertexId{v.value - 1});
                for (std::uint32_t i = left.size - 1; i > first; --i) visit(VertexId{left.vertex[i]});
                return true;
            }
        }
        return false;
    }

  private:
    // Does the representation have its own shortcuts for common cases?
    static constexpr bool kHasOpposites = requires(const Store& store) { store.plain_opposite(0); };

    static constexpr bool kHasFans = requires { typename Store::PlainFan; };

    /// Lists the neighbors on both sides; returns false if v is near an end of its ring, or not all were found.
    bool find_sides(std::uint32_t v, FanSide<Store>& left, FanSide<Store>& right) const {
        if (v < 2 || v + 1 >= ring_) return false;
        const std::uint32_t w = s_.word(v, 0), p = s_.word(v - 1, 0), pp = s_.word(v - 2, 0);
        const auto closes = [](std::uint32_t x) { return (x & word::kKind) == word::kClosing; };
        if (closes(w) || closes(p) || closes(pp)) return false;
        return left.template find<0>(s_, v, w, p, pp) &&
               right.template find<1>(s_, v, s_.word(v, 1), s_.word(v - 1, 1), s_.word(v - 2, 1));
    }

    enum Role : std::uint32_t { kStart = 0, kTip = 1, kEnd = 2 };
    struct Slot {
        std::uint32_t v, side;
        Role role;
    };

    static Slot slot_of(CornerId c) {
        const std::uint32_t i = c.value % 8;
        return {c.value / 8, i / 4, static_cast<Role>(i < 4 ? i : 6 - i)};
    }
    static CornerId at(std::uint32_t v, std::uint32_t side, Role role) {
        return CornerId(8 * v + (side == 0 ? std::uint32_t{role} : 6 - role));
    }
    std::uint32_t t0_index(CornerId c) const {
        const std::uint32_t i = c.value - 8 * ring_;
        return i - i / 4;  // base four to base three
    }

    /// The vertex at which the slot's edge ends.
    std::uint32_t end(std::uint32_t v, std::uint32_t side) const {
        const std::uint32_t n = ring_next(v);
        return (s_.kind(v, side) & (word::kSpecial | word::kWart)) == word::kWart ? ring_next(n) : n;
    }
    /// The slot whose edge ends at v: v.p.p if that slot skips v.p, else v.p.
    std::uint32_t before(std::uint32_t v, std::uint32_t side) const {
        const std::uint32_t p = ring_previous(v), pp = ring_previous(p);
        return skips(pp, side) ? pp : p;
    }
    bool skips(std::uint32_t v, std::uint32_t side) const {
        return (s_.kind(v, side) & (word::kSpecial | word::kWart)) == word::kWart;
    }
    /// Is the slot a redundant copy or a T0w? Then the next slot's triangle has two ring edges.
    static bool precedes_t2(std::uint32_t kind) { return (kind & word::kWart) != 0 || kind == word::kRedundant; }

    /// The corner on side `side` that faces v's ring edge.
    CornerId across_ring(std::uint32_t v, std::uint32_t side) const {
        const std::uint32_t kind = s_.kind(v, side);
        if (kind == word::kBorder) return kNullCorner;
        // The slot is a T2's first copy or a T0w in its place: the end corner of the T2's second copy faces this edge.
        if (precedes_t2(kind)) {
            const CornerId c = at(ring_next(v), side, kEnd);
            return kind == word::kRedundant || kind == word::kClosing ? canonical(c) : c;
        }
        return at(v, side, kTip);
    }

    CornerId facing_tip(std::uint32_t v, std::uint32_t side, std::uint32_t kind) const {
        if ((kind & word::kWart) != 0) return at(ring_next(v), side, kStart);  // the T2w's tip corner
        return across_ring(v, 1 - side);
    }

    CornerId facing_start(std::uint32_t v, std::uint32_t side, std::uint32_t kind) const {
        const std::uint32_t p = ring_previous(v);
        const std::uint32_t before_kind = s_.kind(p, side);
        if ((before_kind & (word::kSpecial | word::kWart)) == word::kWart)
            return at(p, side, kTip);  // v is a wart's tip
        if (precedes_t2(before_kind) && precedes_t2(s_.kind(ring_previous(p), side)) &&
            (s_.kind(ring_previous(p), side) & word::kSpecial) != 0) {
            return across_ring(ring_next(v), 1 - side);  // all three edges are ring edges
        }
        if ((kind & word::kIrregular) != 0) return CornerId{s_.star_opposite(v, side, 0)};
        return infer_start(v, side);
    }

    CornerId facing_end(std::uint32_t v, std::uint32_t side, std::uint32_t kind) const {
        const std::uint32_t p = ring_previous(v);
        if (precedes_t2(s_.kind(p, side))) return across_ring(p, 1 - side);
        if ((kind & word::kIrregular) != 0) return CornerId{s_.star_opposite(v, side, 1)};
        return infer_end(v, side);
    }

  public:
    /// The corner across (tip, end) of a regular triangle: in the slot that starts at its end, or in the slot that ends
    /// at its tip.
    CornerId infer_start(std::uint32_t v, std::uint32_t side) const {
        const std::uint32_t n = end(v, side), u = s_.tip(v, side);
        if (slot_tip(n, side) == u) return canonical(at(n, side, kEnd));
        if (u >= ring_) return kNullCorner;
        const std::uint32_t p = before(u, side);
        return slot_tip(p, side) == n ? canonical(at(p, side, kStart)) : kNullCorner;
    }

    /// The corner across (start, tip) of a regular triangle: in the slot that ends at its start, or in the slot that
    /// starts at its tip.
    CornerId infer_end(std::uint32_t v, std::uint32_t side) const {
        const std::uint32_t u = s_.tip(v, side), q = before(v, side);
        if (slot_tip(q, side) == u) return canonical(at(q, side, kStart));
        if (u >= ring_) return kNullCorner;
        return slot_tip(u, side) == v ? canonical(at(u, side, kEnd)) : kNullCorner;
    }

  private:
    /// The third vertex of the slot's triangle (for either copy of a T2); null if the slot has none.
    std::uint32_t slot_tip(std::uint32_t v, std::uint32_t side) const {
        const std::uint32_t kind = s_.kind(v, side);
        if (kind == word::kBorder) return kNullVertex.value;
        if (kind == word::kClosing) return ring_next(s_.first(v));
        return s_.tip(v, side);
    }

    Store s_;
    std::uint32_t ring_;
    std::span<const std::uint32_t> copies_;
};

}  // namespace lacedring
