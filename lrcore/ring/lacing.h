#pragma once
// How rings run through the triangles, in a form that is quick to change. Internal to the ring optimiser.

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "lacedring/ring.hpp"
#include "lacedring/topology.hpp"
#include "lrcore/base/bits.h"

namespace lacedring {

/// What the rings make of every triangle, and what that costs. An edge is a mesh edge, known by the corners that face
/// it, never a pair of vertices: two edges may have the same ends. Memory: a byte a triangle and a bit a vertex.
class Lacing {
  public:
    static constexpr std::int64_t kScale = 16;  ///< of costs, so that temperatures are not coarse beside small numbers

    Lacing(const CornerTable& table, const Rings& rings, const RingCost& cost)
        : table_(&table),
          isolated_(cost.isolated * kScale),
          state_(table.triangle_count()),
          on_ring_(table.vertex_count) {
        for (std::size_t ends = 0; ends < 4; ++ends) {
            t0_[ends * kDeadEnd] = kScale * (ends == 0 ? cost.t0 : cost.t0_wart);
        }
        for (const RingEdge& edge : rings.edges) {
            on_ring_.set(edge.start.value);
            state_[triangle(edge.left).value] |= bit(edge.left);
            if (edge.right.is_null()) continue;
            state_[triangle(edge.right).value] |= static_cast<std::uint8_t>(bit(edge.right) | kRight);
        }
        for (std::uint32_t t = 0; t < table.triangle_count(); ++t) {
            if (!is_t2(TriangleId{t})) continue;
            const CornerId across = table.opposite(t2_corner(TriangleId{t}));
            if (!across.is_null()) state_[triangle(across).value] += kDeadEnd;
        }
    }

    /// kScale times the cost, up to a constant.
    std::int64_t cost() const { return cost_; }

    bool is_t0(TriangleId t) const { return mask(t) == 0; }
    bool is_t0_beside_no_t2(TriangleId t) const { return (state_[t.value] & kT0Key) == 0; }
    bool is_t2(TriangleId t) const { return kBits[mask(t)] == 2; }
    /// Of a T2, the corner between its ring edges.
    CornerId t2_corner(TriangleId t) const { return corner(t, kCornerOfT2[mask(t)]); }
    /// Of a T1, the corner that faces its ring edge.
    CornerId tip_corner(TriangleId t) const {
        return corner(t, static_cast<std::uint32_t>(std::countr_zero(unsigned{mask(t)})));
    }
    bool on_ring(VertexId v) const { return on_ring_.test(v.value); }
    void set_on_ring(VertexId v, bool on) {
        on ? on_ring_.set(v.value) : on_ring_.clear(v.value);
        cost_ += on ? -isolated_ : isolated_;
    }
    /// Does corner c face a ring edge?
    bool faces_ring(CornerId c) const { return (state_[triangle(c).value] & bit(c)) != 0; }
    /// Is the triangle of c, no T0, on the right of its ring edges?
    bool is_right(CornerId c) const { return (state_[triangle(c).value] & kRight) != 0; }

    /// A flag to use at will.
    bool marked(TriangleId t) const { return (state_[t.value] & kMark) != 0; }
    void mark(TriangleId t, bool on) {
        state_[t.value] = static_cast<std::uint8_t>((state_[t.value] & ~kMark) | (on ? kMark : 0));
    }

    /// May the T2 of c, its t2_corner, be turned over? A ring edge needs a triangle on its left.
    bool can_take_out(CornerId c) const { return is_right(c) || !table_->opposite(c).is_null(); }
    /// May the T1 of c, its tip_corner, be?
    bool can_lace_in(CornerId c) const {
        return is_right(c) || (!table_->left(c).is_null() && !table_->right(c).is_null());
    }

    /// Turns a T1 or T2 over to the other side: its ring edges leave the ring, its other edges enter it. Undone by
    /// doing it again.
    void turn_over(TriangleId t) {
        // Bytes may alias anything: what is read again and again is kept in locals.
        const CornerTable::Corner* const corners = table_->corners.data();
        std::uint8_t* const state = state_.data();
        std::int64_t change = 0;
        const auto flip = [&](std::uint32_t u, std::uint32_t bits) {
            const std::uint8_t old = state[u];
            state[u] = static_cast<std::uint8_t>(old ^ bits);
            change += t0_[state[u] & kT0Key] - t0_[old & kT0Key];
            // Before or after it may be a T2, never both. Where neither, a change of 0 is made: cheaper than to branch.
            const DeadEndChange end = kDeadEndChange[old & kMask][state[u] & kMask];
            const CornerId across = corners[3 * std::size_t{u} + end.corner].opposite;
            if (across.is_null()) return;
            std::uint8_t& s = state[triangle(across).value];
            change -= t0_[s & kT0Key];
            s = static_cast<std::uint8_t>(s + end.change);
            change += t0_[s & kT0Key];
        };
        flip(t.value, kMask | kRight);
        for (std::uint32_t k = 0; k < 3; ++k) {
            const CornerId o = corners[corner(t, k).value].opposite;
            if (o.is_null()) continue;
            const std::uint32_t u = triangle(o).value;
            const bool enters = (state[t.value] >> k & 1) != 0;
            const bool same_side = ((state[t.value] ^ state[u]) & kRight) == 0;
            flip(u, bit(o) | (enters && same_side ? kRight : 0U));
        }
        cost_ += change;
    }

    /// Has the ring of the edge that c faces only two edges?
    bool is_two_ring(CornerId c) const {
        const CornerId left = is_right(c) ? table_->opposite(c) : c;
        return table_->vertex(next(edge_after(left))) == table_->vertex(previous(left));
    }

    /// The rings as they are, in the order of their first triangles.
    Rings rings() const {
        std::size_t size = 0;  // each edge has one triangle on its left
        for (const std::uint8_t s : state_) size += (s & kRight) != 0 ? 0 : kBits[s & kMask];
        Rings out;
        out.edges.reserve(size);
        BitVector done(table_->vertex_count);
        for (std::uint32_t i = 0; i < table_->corners.size(); ++i) {
            const CornerId c{i};
            if (!faces_ring(c) || is_right(c) || done.test(table_->vertex(previous(c)).value)) continue;
            out.first.push_back(static_cast<std::uint32_t>(out.edges.size()));
            CornerId left = c;
            do {
                const VertexId v = table_->vertex(previous(left));
                const CornerId right = table_->opposite(left);
                done.set(v.value);
                out.edges.push_back(
                    {v, left, right, table_->vertex(left), right.is_null() ? kNullVertex : table_->vertex(right)});
                left = edge_after(left);
            } while (left != c);
        }
        out.first.push_back(static_cast<std::uint32_t>(out.edges.size()));
        return out;
    }

  private:
    // Of a triangle's state: bits 0 to 2, which corners face a ring edge; is it on the right of its ring edges; how
    // many T2 have it across their third edge; the mark.
    static constexpr std::uint8_t kMask = 7, kRight = 8, kDeadEnd = 16, kDeadEnds = 0x30, kMark = 64;
    static constexpr std::uint8_t kT0Key = kMask | kDeadEnds;  // decides whether it is a T0, and its cost
    static constexpr std::array<std::uint8_t, 8> kBits{0, 1, 1, 2, 1, 2, 2, 3};
    static constexpr std::array<std::uint8_t, 8> kCornerOfT2{0, 0, 0, 2, 0, 1, 0, 0};

    /// What the change of a triangle's mask means for its neighbours: the number of T2 changes across `corner`.
    struct DeadEndChange {
        std::uint8_t corner;
        std::int8_t change;
    };
    static constexpr auto kDeadEndChange = [] {
        std::array<std::array<DeadEndChange, 8>, 8> out{};
        for (std::size_t a = 0; a < 8; ++a) {
            for (std::size_t b = 0; b < 8; ++b) {
                if (kBits[a] == 2 && kBits[b] != 2) out[a][b] = {kCornerOfT2[a], -kDeadEnd};
                if (kBits[b] == 2 && kBits[a] != 2) out[a][b] = {kCornerOfT2[b], kDeadEnd};
            }
        }
        return out;
    }();

    static std::uint8_t bit(CornerId c) { return static_cast<std::uint8_t>(1U << c.value % 3); }
    std::uint8_t mask(TriangleId t) const { return state_[t.value] & kMask; }

    /// The left corner of the ring edge after that of left corner x.
    CornerId edge_after(CornerId x) const {
        CornerId y = table_->opposite(x);
        do {  // through the triangles on the left, around the vertex between the edges
            const CornerId p = previous(x);
            if (faces_ring(p)) return p;
            x = table_->opposite(p);
        } while (!x.is_null());
        while (true) {  // the fan is open on the left: through those on the right
            const CornerId n = next(y);
            y = table_->opposite(n);
            if (faces_ring(n)) return y;
        }
    }

    const CornerTable* table_;
    std::array<std::int64_t, 64> t0_{};  // cost of a triangle by state & kT0Key
    std::int64_t isolated_;
    std::int64_t cost_ = 0;
    std::vector<std::uint8_t> state_;
    BitVector on_ring_;
};

}  // namespace lacedring
