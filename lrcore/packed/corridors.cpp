#include "lrcore/packed/corridors.h"

#include <algorithm>

#include "lrcore/base/bits.h"
#include "lrcore/ring/ring_walk.h"

namespace lr {
namespace {

class Walker {
  public:
    Walker(const CornerTable& table, const Rings& rings)
        : table_(table),
          rings_(rings),
          number_(table.vertex_count, UINT32_MAX),
          ring_edge_(table.corners.size()),
          visited_(table.triangle_count()) {}

    Corridors walk() {
        out_.ring_vertices = static_cast<std::uint32_t>(rings_.edges.size());
        out_.vertex_order.reserve(table_.vertex_count);
        out_.corners.reserve(table_.triangle_count() - table_.topology.degenerate);
        out_.flags.reserve(out_.corners.capacity());
        for (std::size_t r = 0; r < rings_.count(); ++r) number(RingWalk(rings_.ring(r)), rings_.ring(r));
        for (std::uint32_t v = 0; v < table_.vertex_count; ++v) {
            if (number_[v] != UINT32_MAX) continue;
            number_[v] = static_cast<std::uint32_t>(out_.vertex_order.size());
            out_.vertex_order.push_back(v);
        }
        for (std::size_t r = 0; r < rings_.count(); ++r) walk_ring(rings_.ring(r), closing_[r]);
        for (std::uint32_t t = 0; t < table_.triangle_count(); ++t) {  // those that no ring has anything to do with
            if (!visited_.test(t) && !table_.degenerate({t})) visit(corner({t}, 0), 0);
        }
        return std::move(out_);
    }

  private:
    /// Numbers a ring's vertices from where its polygons are best entered, and remembers its edges.
    void number(const RingWalk& walk, std::span<const RingEdge> ring) {
        // Across a polygon's first edge should be a T2: any other triangle there is a T0 to the walk.
        std::size_t closing = 0;
        int best = -1;
        for (std::size_t i = 0; i < ring.size() && best < 2; ++i) {
            const int score = (walk.repeats(0, i) ? 1 : 0) + (ring[i].right.is_null() || walk.repeats(1, i) ? 1 : 0);
            if (score <= best) continue;
            best = score;
            closing = i;
        }
        closing_.push_back(static_cast<std::uint32_t>(closing));
        std::size_t i = closing;
        do {
            i = walk.after(i);
            number_[ring[i].start.value] = static_cast<std::uint32_t>(out_.vertex_order.size());
            out_.vertex_order.push_back(ring[i].start.value);
            ring_edge_.set(ring[i].left.value);
            if (!ring[i].right.is_null()) ring_edge_.set(ring[i].right.value);
        } while (i != closing);
    }

    void walk_ring(std::span<const RingEdge> ring, std::size_t closing) {
        // A whole side at once where it is one polygon; what is left are the parts that borders cut off.
        for (const std::uint8_t side : {std::uint8_t{0}, std::uint8_t{CorridorStep::kRight}}) {
            const CornerId c = side == 0 ? ring[closing].left : ring[closing].right;
            if (!c.is_null() && !visited_.test(triangle(c).value)) visit(c, side);
            for (std::size_t n = 1; n <= ring.size(); ++n) {
                const RingEdge& edge = ring[(closing + n) % ring.size()];
                const CornerId part = side == 0 ? edge.left : edge.right;
                if (!part.is_null() && !visited_.test(triangle(part).value)) visit_part(part, side);
            }
        }
    }

    /// The corner across the edge that `c` faces, if that edge can be crossed.
    CornerId across(CornerId c) const {
        if (ring_edge_.test(c.value)) return null_corner;
        const CornerId o = table_.opposite(c);
        return o.is_null() || visited_.test(triangle(o).value) ? null_corner : o;
    }

    /// Visits the part at a ring edge, the first that has one there: it ends at the border around the edge's start.
    void visit_part(CornerId c, std::uint8_t side) {
        while (true) {
            const CornerId edge = side == 0 ? next(c) : previous(c);  // faces the other edge at the start
            const CornerId o = across(edge);
            if (o.is_null()) return visit(edge, side);
            c = o;
        }
    }

    /// Visits all that can be reached from a corner's triangle.
    void visit(CornerId c, std::uint8_t side) {
        while (true) {
            visited_.set(triangle(c).value);
            const CornerId facing_a = side == 0 ? previous(c) : next(c), facing_b = side == 0 ? next(c) : previous(c);
            const CornerId ca = across(facing_a);
            CornerId cb = across(facing_b);
            if (!ca.is_null() && !cb.is_null() && triangle(ca) == triangle(cb)) cb = null_corner;
            std::uint8_t flags = side;
            if (!ca.is_null()) flags |= CorridorStep::kEnterA;
            if (!cb.is_null()) flags |= CorridorStep::kEnterB;
            CornerId then = ca.is_null() ? cb : ca;
            if (!ca.is_null() && !cb.is_null()) {
                // The smaller part first: the walk is back soon, mostly in the same block. Its size shows in the numbers.
                const std::uint32_t a = number(facing_b), x = number(c), b = number(facing_a);
                const std::uint32_t size_a = x > a ? x - a : UINT32_MAX, size_b = b > x ? b - x : UINT32_MAX;
                const bool first_a = size_a <= size_b;
                if (first_a) flags |= CorridorStep::kFirstA;
                then = first_a ? ca : cb;
                stack_.push_back(first_a ? cb : ca);
                ++out_.splits;
            }
            out_.corners.push_back(c);
            out_.flags.push_back(flags);
            while (then.is_null()) {
                if (stack_.empty()) return;
                then = stack_.back();
                stack_.pop_back();
                if (visited_.test(triangle(then).value)) then = null_corner;  // reached from elsewhere: a handle
            }
            c = then;
        }
    }

    std::uint32_t number(CornerId c) const { return number_[table_.vertex(c).value]; }

    const CornerTable& table_;
    const Rings& rings_;
    std::vector<std::uint32_t> number_;
    std::vector<std::uint32_t> closing_;  // of each ring
    BitVector ring_edge_;                 // of the corners that face one
    BitVector visited_;
    std::vector<CornerId> stack_;
    Corridors out_;
};

}  // namespace

Corridors walk_corridors(const CornerTable& table, const Rings& rings) { return Walker(table, rings).walk(); }

}  // namespace lr
