#pragma once
// How rings run through the triangles, in a form that is quick to change. Internal to the ring optimiser.

#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "lacedring/ring.hpp"
#include "lacedring/topology.hpp"
#include "lrcore/base/bits.h"

namespace lacedring {

/// Triangles begin to end - 1 in Lacing's numbers.
struct TriangleRange {
    std::uint32_t begin, end;

    bool has(std::uint32_t t) const { return t - begin < end - begin; }
};

/// Which edges are on the rings, as seen from every triangle, and what changes cost. An edge is a mesh edge, known by
/// the corners that face it, never a pair of vertices: two edges may have the same ends.
///
/// Corner k of triangle t is 4 * t + k; k is the table's. Triangles of a large mesh whose neighbors are far apart in
/// the table are renumbered breadth first: then neighbors are near each other in memory, and a range of numbers is a
/// band of surface with a short border. What is not const changes states in the given range only, and what takes a
/// range reads states there only. So threads may work in disjoint ranges.
/// Memory: 17 bytes a triangle, and 4 to 8 more while number_triangles() runs.
class Lacing {
  public:
    static constexpr std::int64_t kScale = 16;  ///< of costs, so that temperatures are not coarse beside small numbers
    static constexpr std::uint32_t kNone = UINT32_MAX;

    /// The states that turn_over changed.
    class Changes {
      public:
        void clear() { size_ = 0; }

      private:
        friend class Lacing;
        std::array<std::uint32_t, 16> triangle_;  // eight for a call, of two
        std::array<std::uint8_t, 16> state_;
        std::uint32_t size_ = 0;
    };

    /// Reads the rings. Only has_expensive() and number_triangles() may be called then.
    Lacing(const CornerTable& table, const Rings& rings, const RingCost& cost);
    /// Prepares all else. Renumbers the triangles if ranges of so many had long borders otherwise.
    void number_triangles(std::uint32_t range);

    /// Is there a T0 beside no T2, not degenerate?
    bool has_expensive() const;

    /// Is every vertex on a ring? False, too, if some vertices are in no triangle.
    bool all_on_rings() const { return all_on_rings_; }

    std::uint32_t size() const { return static_cast<std::uint32_t>(state_.size()); }

    static std::uint32_t next(std::uint32_t c) { return (c & 3) == 2 ? c - 2 : c + 1; }
    static std::uint32_t previous(std::uint32_t c) { return (c & 3) == 0 ? c + 2 : c - 1; }
    std::uint32_t opposite(std::uint32_t c) const { return opposite_[c]; }

    bool is_t0(std::uint32_t t) const { return mask(t) == 0; }
    /// Is it a T0 beside no T2, and not degenerate?
    bool is_expensive(std::uint32_t t) const { return (state_[t] & (kT0Key | kDegenerate)) == 0; }
    bool is_t2(std::uint32_t t) const { return kBits[mask(t)] == 2; }
    /// Of a T2, the corner between its ring edges.
    std::uint32_t t2_corner(std::uint32_t t) const { return 4 * t + kCornerOfT2[mask(t)]; }
    /// Does corner c face a ring edge?
    bool faces_ring(std::uint32_t c) const { return (state_[c >> 2] & bit(c)) != 0; }
    /// Is the triangle of c, no T0, on the right of its ring edges?
    bool is_right(std::uint32_t c) const { return (state_[c >> 2] & kRight) != 0; }

    std::uint8_t state(std::uint32_t t) const { return state_[t]; }
    /// The number of ring edges of a triangle of that state.
    static std::uint32_t ring_edges(std::uint8_t state) { return kBits[state & kMask]; }
    /// The cost of a triangle of that state, and its cost as a T0.
    std::int64_t cost(std::uint8_t state) const { return t0_[state & kT0Key]; }
    std::int64_t cost_as_t0(std::uint8_t state) const { return t0_[state & kDeadEnds]; }
    std::int64_t wart_cost() const { return t0_[kDeadEnd]; }

    /// Does turn_over(t) touch triangles of that range only? These are at most two edges away.
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

    /// Length of the dead end of T2 t: the T1 between it and a T0, at most `most`. `most` where it has no T0.
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

    /// A flag to use at will.
    bool marked(std::uint32_t t) const { return (state_[t] & kMark) != 0; }
    void mark(std::uint32_t t) { state_[t] |= kMark; }
    /// Marks the T0 beside no T2, and nothing else; appends them to `out`.
    void mark_expensive(TriangleRange range, std::vector<std::uint32_t>& out);
    /// Appends the marked T2.
    void find_marked_t2(TriangleRange range, std::vector<std::uint32_t>& out) const;

    /// May the T2 of c, its t2_corner, be turned over? A ring edge needs a triangle on its left.
    bool can_take_out(std::uint32_t c) const { return is_right(c) || opposite(c) != kNone; }
    /// Is the triangle of c a T1 with c as its tip corner, which may be turned over? Given that vertex(c) is on no
    /// ring, or that no other triangle of the fan is a T2 with a corner there.
    bool can_lace_in(std::uint32_t c) const {
        const int inner = int{opposite(next(c)) != kNone} & int{opposite(previous(c)) != kNone};
        return (int{faces_ring(c)} & (int{is_right(c)} | inner)) != 0;
    }

    /// Turns a T1 or T2 over to the other side: its ring edges leave the ring, its other edges enter it. Returns what
    /// that costs, and notes what was there before.
    std::int64_t turn_over(std::uint32_t t, Changes& changes) {
        // Bytes may alias anything: what is read again and again is kept in locals.
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
            // Before or after it may be a T2, never both. Where neither, a change of 0 is made: cheaper than to branch.
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

    /// Has the ring of the edge that c faces only two edges? True, too, where the range does not tell.
    bool maybe_two_ring(TriangleRange range, std::uint32_t c) const {
        const std::uint32_t left = is_right(c) ? opposite(c) : c;
        if (!range.has(left >> 2)) return true;
        const std::uint32_t after = edge_after(range, left);
        if (after == kNone) return true;
        const std::uint32_t last = edge_after(range, after);
        return last == kNone || last == left;
    }

    /// A corner of each vertex that is on no ring to begin with, in ascending order.
    std::vector<std::uint32_t> take_isolated() { return std::move(isolated_); }

    /// The states of all triangles.
    const std::vector<std::uint8_t>& states() const { return state_; }
    /// The rings of such states, in the order of their first triangles. Frees all but what it needs.
    static Rings rings(Lacing lacing, const std::vector<std::uint8_t>& states);

  private:
    // Of a triangle's state: bits 0 to 2, which corners face a ring edge; is it on the right of its ring edges; how
    // many T2 have it across their third edge; is it degenerate; the mark.
    static constexpr std::uint8_t kMask = 7, kRight = 8, kDeadEnd = 16, kDeadEnds = 0x30, kDegenerate = 64, kMark = 128;
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

    static std::uint8_t bit(std::uint32_t c) { return static_cast<std::uint8_t>(1U << (c & 3)); }
    std::uint8_t mask(std::uint32_t t) const { return state_[t] & kMask; }

    bool scattered(std::uint32_t range) const;
    void renumber();

    /// The left corner of the ring edge after that of left corner x; kNone where it is not all within the range.
    std::uint32_t edge_after(TriangleRange range, std::uint32_t x) const {
        std::uint32_t y = opposite(x);
        do {  // through the triangles on the left, around the vertex between the edges
            const std::uint32_t p = previous(x);
            if (faces_ring(p)) return p;
            x = opposite(p);
            if (x != kNone && !range.has(x >> 2)) return kNone;
        } while (x != kNone);
        while (true) {  // the fan is open on the left: through those on the right
            if (y == kNone || !range.has(y >> 2)) return kNone;
            const std::uint32_t n = next(y);
            y = opposite(n);
            if (faces_ring(n)) return y != kNone && range.has(y >> 2) ? y : kNone;
        }
    }

    const CornerTable* table_;
    std::array<std::int64_t, 64> t0_{};  // cost of a triangle by state & kT0Key
    BitVector on_ring_;                  // vertices; or with a corner in isolated_
    bool all_on_rings_;
    std::vector<std::uint32_t> isolated_;  // corners
    std::vector<std::uint8_t> state_;      // of each triangle
    std::vector<std::uint32_t> opposite_;  // of each corner; the fourth is the table's number of the triangle
};

}  // namespace lacedring
