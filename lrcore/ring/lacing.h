#pragma once
// The edges of rings, stored per triangle so that changes are fast. Internal to the ring optimizer.

#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "lacedring/ring.hpp"
#include "lacedring/topology.hpp"
#include "lrcore/base/bits.h"

namespace lacedring {

/// Triangles begin to end - 1, as Lacing numbers them.
struct TriangleRange {
    std::uint32_t begin, end;

    bool has(std::uint32_t t) const { return t - begin < end - begin; }
};

/// Stores for every triangle which of its edges are on the rings, and computes the cost of changes. An edge is
/// identified by the corners that face it, not by its vertices: two edges may have the same ends.
///
/// Corner k of triangle t is 4 * t + k, with the table's k. If neighbors in a large mesh are far apart in the table,
/// triangles are renumbered breadth first: then neighbors are close in memory, and a range of triangles is a band of
/// surface with a short border. Functions that take a range read and change states in that range only, and turn_over()
/// only near its triangle (within()). So threads may work in disjoint ranges. Memory: 17 bytes per triangle, and 4 to 8
/// more while number_triangles() runs.
class Lacing {
  public:
    /// Factor of all costs, so that temperatures are fine enough for small costs.
    static constexpr std::int64_t kScale = 16;
    static constexpr std::uint32_t kNone = UINT32_MAX;

    /// The states before turn_over changed them.
    class Changes {
      public:
        void clear() { size_ = 0; }

      private:
        friend class Lacing;
        std::array<std::uint32_t, 16> triangle_;  // at most eight per turn_over, for two calls
        std::array<std::uint8_t, 16> state_;
        std::uint32_t size_ = 0;
    };

    /// Reads the rings. Until number_triangles(), only has_expensive() and all_on_rings() may be called.
    Lacing(const CornerTable& table, const Rings& rings, const RingCost& cost);
    /// Prepares all other functions. Renumbers the triangles if ranges of `range` triangles had long borders otherwise.
    void number_triangles(std::uint32_t range);

    /// Is there an expensive triangle (see is_expensive)?
    bool has_expensive() const;

    /// Is every vertex on a ring? Also false if some vertices are in no triangle.
    bool all_on_rings() const { return all_on_rings_; }

    std::uint32_t size() const { return static_cast<std::uint32_t>(state_.size()); }

    static std::uint32_t next(std::uint32_t c) { return (c & 3) == 2 ? c - 2 : c + 1; }
    static std::uint32_t previous(std::uint32_t c) { return (c & 3) == 0 ? c + 2 : c - 1; }
    std::uint32_t opposite(std::uint32_t c) const { return opposite_[c]; }

    bool is_t0(std::uint32_t t) const { return mask(t) == 0; }
    /// Is t a T0 that is not part of a wart and not degenerate?
    bool is_expensive(std::uint32_t t) const { return (state_[t] & (kT0Key | kDegenerate)) == 0; }
    bool is_t2(std::uint32_t t) const { return kBits[mask(t)] == 2; }
    /// The corner between the ring edges of a T2.
    std::uint32_t t2_corner(std::uint32_t t) const { return 4 * t + kCornerOfT2[mask(t)]; }
    /// Does corner c face a ring edge?
    bool faces_ring(std::uint32_t c) const { return (state_[c >> 2] & bit(c)) != 0; }
    /// Is the triangle of c on the right of its ring edges? It must not be a T0.
    bool is_right(std::uint32_t c) const { return (state_[c >> 2] & kRight) != 0; }

    std::uint8_t state(std::uint32_t t) const { return state_[t]; }
    /// The number of ring edges of a triangle of that state.
    static std::uint32_t ring_edges(std::uint8_t state) { return kBits[state & kMask]; }
    /// The cost of a triangle of that state, and its cost as a T0.
    std::int64_t cost(std::uint8_t state) const { return t0_[state & kT0Key]; }
    std::int64_t cost_as_t0(std::uint8_t state) const { return t0_[state & kDeadEnds]; }
    std::int64_t wart_cost() const { return t0_[kDeadEnd]; }

    /// Does turn_over(t) only touch triangles of the range? It touches triangles at most two edges away from t.
    bool within(TriangleRange range, std::uint32_t t) const {
        if (range.end - range.begin == size()) return true;
        bool all = range.has(t);
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t o = opposite(4 * t + k);
            if (o == kNone) continue;
            for (const std::uint32_t p : {o, opposite(next(o)), opposite(previous(o))}) {
                all &= p == kNone || range.has(p >> 2);
            }
        }
        return all;
    }

    /// Length of the dead end that ends at T2 t: the number of T1 between t and a T0, at most `most`; `most` if there
    /// is no such T0.
    std::uint32_t dead_end(TriangleRange range, std::uint32_t t, std::uint32_t most) const {
        std::uint32_t x = opposite(t2_corner(t));
        for (std::uint32_t n = 0; n < most; ++n) {
            if (x == kNone || !range.has(x >> 2)) return most;
            if (is_t0(x >> 2)) return n;
            if (kBits[mask(x >> 2)] != 1) return most;
            x = opposite(faces_ring(next(x)) ? previous(x) : next(x));
        }
        return most;
    }

    /// A flag per triangle, free for callers.
    bool marked(std::uint32_t t) const { return (state_[t] & kMark) != 0; }
    void mark(std::uint32_t t) { state_[t] |= kMark; }
    /// Marks the expensive triangles of the range, clears all other marks there, and appends the marked triangles to
    /// `out`.
    void mark_expensive(TriangleRange range, std::vector<std::uint32_t>& out);
    /// Appends the marked T2 of the range to `out`.
    void find_marked_t2(TriangleRange range, std::vector<std::uint32_t>& out) const;

    /// May the T2 with t2_corner c be turned over? Every ring edge needs a triangle on its left.
    bool can_take_out(std::uint32_t c) const { return is_right(c) || opposite(c) != kNone; }
    /// Is the triangle of c a T1 with c as its tip corner that may be turned over? Requires that vertex(c) is on no
    /// ring, or that no other triangle of the fan is a T2 with its t2_corner there.
    bool can_lace_in(std::uint32_t c) const {
        const int inner = int{opposite(next(c)) != kNone} & int{opposite(previous(c)) != kNone};
        return (int{faces_ring(c)} & (int{is_right(c)} | inner)) != 0;
    }

    /// Moves a T1 or T2 to the other side of the ring: its ring edges leave the ring, its other edges join it. Returns
    /// the change of cost, and appends the old states to `changes`.
    std::int64_t turn_over(std::uint32_t t, Changes& changes) {
        // Writes to bytes may alias any object, so the pointers are copied to locals.
        const std::uint32_t* const opposite = opposite_.data();
        std::uint8_t* const state = state_.data();
        std::uint32_t noted = changes.size_;
        std::int64_t change = 0;
        const auto flip = [&](std::uint32_t u, std::uint32_t bits) {
            const std::uint8_t old = state[u];
            const auto now = static_cast<std::uint8_t>(old ^ bits);
            changes.triangle_[noted] = u;
            changes.state_[noted++] = old;
            state[u] = now;
            change += t0_[now & kT0Key] - t0_[old & kT0Key];
            // At most one of the old and new masks is a T2; otherwise the delta is 0, applied unconditionally to avoid
            // a branch.
            const DeadEndChange end = kDeadEndChange[old & kMask][now & kMask];
            const std::uint32_t across = opposite[4 * std::size_t{u} + end.corner];
            if (across == kNone) return;
            const std::uint8_t was = state[across >> 2];
            const auto is = static_cast<std::uint8_t>(was + end.change);
            changes.triangle_[noted] = across >> 2;
            changes.state_[noted++] = was;
            state[across >> 2] = is;
            change += t0_[is & kT0Key] - t0_[was & kT0Key];
        };
        flip(t, kMask | kRight);
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t o = opposite[4 * std::size_t{t} + k];
            if (o == kNone) continue;
            const std::uint32_t u = o >> 2;
            const bool enters = (state[t] >> k & 1) != 0;
            const bool same_side = ((state[t] ^ state[u]) & kRight) == 0;
            flip(u, bit(o) | ((int{enters} & int{same_side}) != 0 ? kRight : 0U));
        }
        changes.size_ = noted;
        return change;
    }
    void undo(const Changes& changes) {
        for (std::uint32_t i = changes.size_; i-- > 0;) state_[changes.triangle_[i]] = changes.state_[i];
    }

    /// Does the ring of the edge that c faces have only two edges? Also true if that depends on triangles outside the
    /// range.
    bool maybe_two_ring(TriangleRange range, std::uint32_t c) const {
        const std::uint32_t left = is_right(c) ? opposite(c) : c;
        if (!range.has(left >> 2)) return true;
        const std::uint32_t after = edge_after(range, left);
        if (after == kNone) return true;
        const std::uint32_t last = edge_after(range, after);
        return last == kNone || last == left;
    }

    /// One corner of each vertex that is on none of the given rings, in ascending order.
    std::vector<std::uint32_t> take_isolated() { return std::move(isolated_); }

    /// The states of all triangles.
    const std::vector<std::uint8_t>& states() const { return state_; }
    /// The rings that `states` describe, in the order of their first triangles. Frees the memory it does not need.
    static Rings rings(Lacing lacing, const std::vector<std::uint8_t>& states);

  private:
    // Bits of a triangle's state. kMask: corners that face a ring edge; kRight: it is on the right of its ring edges;
    // kDeadEnds: the number of T2 that have it across their third edge; kDegenerate; kMark.
    static constexpr std::uint8_t kMask = 7, kRight = 8, kDeadEnd = 16, kDeadEnds = 0x30, kDegenerate = 64, kMark = 128;
    static constexpr std::uint8_t kT0Key = kMask | kDeadEnds;  // determines whether it is a T0, and its cost
    static constexpr std::array<std::uint8_t, 8> kBits{0, 1, 1, 2, 1, 2, 2, 3};
    static constexpr std::array<std::uint8_t, 8> kCornerOfT2{0, 0, 0, 2, 0, 1, 0, 0};

    /// Effect of a change of mask on the neighbor across `corner`: `change` is added to its state, in units of
    /// kDeadEnd.
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

    static std::uint8_t bit(std::uint32_t c) { return static_cast<std::uint8_t>(1U << (c & 3)); }
    std::uint8_t mask(std::uint32_t t) const { return state_[t] & kMask; }

    bool scattered(std::uint32_t range) const;
    void renumber();

    /// The left corner of the ring edge after the edge with left corner x; kNone if the walk leaves the range.
    std::uint32_t edge_after(TriangleRange range, std::uint32_t x) const {
        std::uint32_t y = opposite(x);
        do {  // around the vertex, through the triangles on the left
            const std::uint32_t p = previous(x);
            if (faces_ring(p)) return p;
            x = opposite(p);
            if (x != kNone && !range.has(x >> 2)) return kNone;
        } while (x != kNone);
        while (true) {  // the fan is open: through the triangles on the right
            if (y == kNone || !range.has(y >> 2)) return kNone;
            const std::uint32_t n = next(y);
            y = opposite(n);
            if (faces_ring(n)) return y != kNone && range.has(y >> 2) ? y : kNone;
        }
    }

    const CornerTable* table_;
    std::array<std::int64_t, 64> t0_{};  // cost of a triangle by state & kT0Key
    // Per vertex; also set once the vertex has a corner in isolated_.
    BitVector on_ring_;
    bool all_on_rings_;
    std::vector<std::uint32_t> isolated_;  // corners
    std::vector<std::uint8_t> state_;      // per triangle
    // Per corner; the fourth entry of a triangle is its number in the table.
    std::vector<std::uint32_t> opposite_;
};

}  // namespace lacedring
