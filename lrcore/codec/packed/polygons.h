#pragma once
// The polygons on both sides of the rings, which both orders of the packed stream walk.

#include <cstdint>
#include <vector>

#include "lrcore/base/bits.h"
#include "lrcore/codec/packed/corridors.h"
#include "lrcore/ring/ring_walk.h"

namespace lacedring {

class Polygons {
  public:
    /// Numbers the vertices and marks the ring edges. 4 bytes per vertex and 4 bits per triangle.
    Polygons(const CornerTable& table, const Rings& rings)
        : table_(table),
          number_(table.vertex_count, UINT32_MAX),
          ring_edge_(table.corners.size()),
          visited_(table.triangle_count()) {
        order_.reserve(table.vertex_count);
        for (std::size_t r = 0; r < rings.count(); ++r) number_ring(RingWalk(rings.ring(r)), rings.ring(r));
        for (std::uint32_t v = 0; v < table.vertex_count; ++v) {
            if (number_[v] != UINT32_MAX) continue;
            number_[v] = static_cast<std::uint32_t>(order_.size());
            order_.push_back(v);
        }
    }

    std::uint32_t number(CornerId c) const { return number_[table_.vertex(c).value]; }
    bool on_ring(CornerId c) const { return ring_edge_.test(c.value); }  ///< is the edge that c faces on a ring?
    bool visited(TriangleId t) const { return visited_.test(t.value); }
    void visit(TriangleId t) { visited_.set(t.value); }
    void leave(TriangleId t) { visited_.clear(t.value); }

    /// The edge of ring r between its last vertex and its first, an index into the ring.
    std::size_t closing(std::size_t r) const { return closing_[r]; }
    std::vector<std::uint32_t>& vertex_order() { return order_; }

    /// The corner across the edge that `c` faces, if that edge can be crossed.
    CornerId across(CornerId c) const {
        if (on_ring(c)) return kNullCorner;
        const CornerId o = table_.opposite(c);
        return o.is_null() || visited(triangle(o)) ? kNullCorner : o;
    }

    /// For a triangle entered at `c`: the corners that can be entered from it across (a, x) and (x, b), null if none;
    /// and the flags of its CorridorStep.
    struct Step {
        CornerId a, b;
        std::uint8_t flags;
    };
    Step step(CornerId c, std::uint8_t side) const {
        const CornerId facing_a = side == 0 ? previous(c) : next(c), facing_b = side == 0 ? next(c) : previous(c);
        Step out{across(facing_a), across(facing_b), side};
        if (!out.a.is_null() && !out.b.is_null() && triangle(out.a) == triangle(out.b)) out.b = kNullCorner;
        if (!out.a.is_null()) out.flags |= CorridorStep::kEnterA;
        if (!out.b.is_null()) out.flags |= CorridorStep::kEnterB;
        if (!out.a.is_null() && !out.b.is_null()) {
            // The smaller part first, so that the walk usually returns within the same block. The vertex numbers give
            // the sizes.
            const std::uint32_t a = number(facing_b), x = number(c), b = number(facing_a);
            const std::uint32_t size_a = x > a ? x - a : UINT32_MAX, size_b = b > x ? b - x : UINT32_MAX;
            if (size_a <= size_b) out.flags |= CorridorStep::kFirstA;
        }
        return out;
    }

  private:
    /// Numbers a ring's vertices, starting at the best edge to enter its polygons, and marks its edges.
    void number_ring(const RingWalk& walk, std::span<const RingEdge> ring) {
        // A T2 should follow a polygon's first edge: any other triangle there would act as a T0.
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
            number_[ring[i].start.value] = static_cast<std::uint32_t>(order_.size());
            order_.push_back(ring[i].start.value);
            ring_edge_.set(ring[i].left.value);
            if (!ring[i].right.is_null()) ring_edge_.set(ring[i].right.value);
        } while (i != closing);
    }

    const CornerTable& table_;
    std::vector<std::uint32_t> number_, order_;
    std::vector<std::uint32_t> closing_;  // per ring
    BitVector ring_edge_;                 // per corner: does it face a ring edge?
    BitVector visited_;
};

}  // namespace lacedring
