// A ring is changed by turning a triangle over to the ring's other side: its edges on the ring leave it, the others
// enter it. Where that is a T2 whose two ring edges meet in v, v leaves the ring; where it is a T1 whose tip v is on no
// ring, v is laced in. Either way each ring stays one cycle. The change that is tried at every T2 is to take v out and
// to lace it in again elsewhere in its fan: it moves dead ends along until they meet their bifurcation, and both
// vanish. Most such changes cost nothing, so annealing at low temperature goes far.

#include "lrcore/ring/optimize.h"

#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include "lrcore/base/bits.h"

namespace lr {
namespace {

constexpr std::int64_t kScale = 16;  // of costs, so that temperatures are not coarse where costs are small numbers

/// What the rings make of every triangle, and what that costs. An edge is a mesh edge, known by the corners that face
/// it, never a pair of vertices: two edges may have the same ends.
class Lacing {
  public:
    Lacing(const CornerTable& table, const Rings& rings, const RingCost& cost)
        : table_(&table),
          t0_{cost.t0 * kScale, cost.t0_wart * kScale},
          isolated_(cost.isolated * kScale),
          state_(table.triangle_count(), 0),
          on_ring_(table.vertex_count) {
        for (const RingEdge& edge : rings.edges) {
            on_ring_.set(edge.start.value);
            state_[triangle(edge.left).value] |= bit(edge.left);
            if (edge.right.is_null()) continue;
            state_[triangle(edge.right).value] |= static_cast<std::uint8_t>(bit(edge.right) | kRight);
        }
        for (std::uint32_t t = 0; t < table.triangle_count(); ++t) {
            if (!is_t2({t})) continue;
            const CornerId across = table_->opposite(t2_corner({t}));
            if (!across.is_null()) state_[triangle(across).value] += kDeadEnd;
        }
    }

    /// The cost, up to a constant.
    std::int64_t cost() const { return cost_; }

    bool is_t0(TriangleId t) const { return mask(t) == 0; }
    bool is_t2(TriangleId t) const { return kBits[mask(t)] == 2; }
    /// Of a T2, the corner between its ring edges.
    CornerId t2_corner(TriangleId t) const { return corner(t, kCornerOfT2[mask(t)]); }
    /// Of a T1, the corner that faces its ring edge.
    CornerId tip_corner(TriangleId t) const {
        return corner(t, static_cast<std::uint32_t>(std::countr_zero(unsigned{mask(t)})));
    }
    bool on_ring(VertexId v) const { return on_ring_.test(v.value); }
    /// Does corner c face a ring edge?
    bool faces_ring(CornerId c) const { return (state_[triangle(c).value] & bit(c)) != 0; }

    /// Is the triangle of c on the right of its ring edges?
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

    /// Turns a T1 or T2 over to the other side. Undone by doing it again.
    void turn_over(TriangleId t) {
        state_[t.value] ^= kRight;
        const auto other_side = static_cast<std::uint8_t>(~state_[t.value] & kRight);
        set_mask(t, mask(t) ^ 7U);
        for (std::uint32_t k = 0; k < 3; ++k) {
            const CornerId o = table_->opposite(corner(t, k));
            if (o.is_null()) continue;
            std::uint8_t& s = state_[triangle(o).value];
            if ((s & bit(o)) == 0) s = static_cast<std::uint8_t>((s & ~kRight) | other_side);
            set_mask(triangle(o), mask(triangle(o)) ^ bit(o));
        }
    }

    void set_on_ring(VertexId v, bool on) {
        on ? on_ring_.set(v.value) : on_ring_.clear(v.value);
        cost_ += on ? -isolated_ : isolated_;
    }

    /// Has the ring of the edge that c faces only two edges?
    bool is_two_ring(CornerId c) const {
        const CornerId left = is_right(c) ? table_->opposite(c) : c;
        return table_->vertex(next(edge_after(left))) == table_->vertex(previous(left));
    }

    /// The rings as they are, in the order of their first triangles.
    Rings rings(std::size_t ring_vertices) const {
        Rings out;
        out.edges.reserve(ring_vertices);
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
                    {v, left, right, table_->vertex(left), right.is_null() ? null_vertex : table_->vertex(right)});
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
    static constexpr std::uint8_t kBits[8] = {0, 1, 1, 2, 1, 2, 2, 3};
    static constexpr std::uint8_t kCornerOfT2[8] = {0, 0, 0, 2, 0, 1, 0, 0};

    static std::uint8_t bit(CornerId c) { return static_cast<std::uint8_t>(1U << c.value % 3); }
    std::uint8_t mask(TriangleId t) const { return state_[t.value] & kMask; }
    std::int64_t t0_cost(std::uint8_t state) const { return t0_[(state & kDeadEnds) != 0 ? 1 : 0]; }

    void set_mask(TriangleId t, std::uint32_t mask) {
        std::uint8_t& s = state_[t.value];
        const std::uint32_t old = s & kMask;
        if (old == 0) cost_ -= t0_cost(s);
        s = static_cast<std::uint8_t>((s & ~kMask) | mask);
        if (mask == 0) cost_ += t0_cost(s);
        if (kBits[old] == 2) count_dead_end(corner(t, kCornerOfT2[old]), -1);
        if (kBits[mask] == 2) count_dead_end(corner(t, kCornerOfT2[mask]), 1);
    }
    void count_dead_end(CornerId c, int change) {
        const CornerId across = table_->opposite(c);
        if (across.is_null()) return;
        std::uint8_t& s = state_[triangle(across).value];
        if ((s & kMask) == 0) cost_ -= t0_cost(s);
        s = static_cast<std::uint8_t>(s + change * kDeadEnd);
        if ((s & kMask) == 0) cost_ += t0_cost(s);
    }

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
    std::array<std::int64_t, 2> t0_;  // cost of a T0, and in a wart
    std::int64_t isolated_;
    std::int64_t cost_ = 0;
    std::vector<std::uint8_t> state_;
    BitVector on_ring_;
};

class Annealer {
  public:
    Annealer(const CornerTable& table, Lacing& lacing, std::uint64_t random_seed)
        : table_(table), lacing_(lacing), random_(random_seed) {}

    void set_temperature(double temperature) {
        for (std::size_t i = 0; i < kLevels; ++i) {
            rise_[i] = static_cast<std::int64_t>(-std::log((static_cast<double>(i) + 0.5) / kLevels) * temperature);
        }
    }

    /// Tries one change at every T2 and at every vertex off the rings.
    void pass() {
        for (std::uint32_t i = 0; i < table_.triangle_count(); ++i) {
            const TriangleId t{i};
            if (lacing_.is_t2(t)) {
                try_t2(t);
            } else if (lacing_.is_t0(t)) {
                try_t0(t);
            } else if (lacing_.marked(t)) {
                const CornerId c = lacing_.tip_corner(t);
                if (lacing_.on_ring(table_.vertex(c)) || try_lace_in(c)) lacing_.mark(t, false);
            }
        }
    }

  private:
    static constexpr std::size_t kLevels = 512;
    static constexpr std::uint32_t kReach = 24;  // triangles of a fan looked at each way, so that hubs cost no more

    /// SplitMix64 (Steele, Lea, Flood 2014).
    std::uint64_t random() {
        std::uint64_t z = (random_ += 0x9e3779b97f4a7c15U);
        z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
        z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
        return z ^ (z >> 31U);
    }
    /// Cost after which a change is undone: Metropolis' rule.
    std::int64_t limit(std::uint64_t bits) const { return lacing_.cost() + rise_[bits % kLevels]; }

    /// Collects the corners of vertex(c) near c, but not c, through whose triangles it can be laced in.
    void find_places(CornerId c) {
        places_ = 0;
        CornerId x = c;
        for (std::uint32_t n = 0; n < kReach; ++n) {
            x = table_.swing(x);
            if (x == c) return;
            if (x.is_null()) break;
            if (lacing_.faces_ring(x) && lacing_.can_lace_in(x)) place_[places_++] = x;
        }
        if (!x.is_null()) return;
        x = c;
        for (std::uint32_t n = 0; n < kReach; ++n) {
            x = table_.right(x);
            if (x.is_null()) return;
            x = previous(x);
            if (lacing_.faces_ring(x) && lacing_.can_lace_in(x)) place_[places_++] = x;
        }
    }
    CornerId any_place(std::uint64_t bits) const { return place_[(bits >> 32U) * places_ >> 32U]; }

    /// Takes a T2's vertex out, and mostly laces it in elsewhere. It is left out on the right side only: so the left
    /// one remains a tree of triangles, all their vertices on the ring, which has dead ends for encoders to close it
    /// at.
    void try_t2(TriangleId t) {
        const CornerId c = lacing_.t2_corner(t);
        if (!lacing_.can_take_out(c)) return;
        const std::uint64_t bits = random();
        const std::int64_t limit_here = limit(bits);
        if ((bits >> 10U) % 8 != 0 || lacing_.is_right(c)) {
            find_places(c);
            if (places_ == 0) return;
            const CornerId place = any_place(bits);
            lacing_.turn_over(t);
            lacing_.turn_over(triangle(place));
            if (lacing_.cost() <= limit_here && !(lacing_.faces_ring(c) && lacing_.is_two_ring(c))) return;
            lacing_.turn_over(triangle(place));
        } else {
            lacing_.turn_over(t);
            lacing_.set_on_ring(table_.vertex(c), false);
            if (lacing_.cost() <= limit_here && !lacing_.is_two_ring(c)) {
                lacing_.mark(t, true);  // its fan may have no T0 from which it would be found again
                return;
            }
            lacing_.set_on_ring(table_.vertex(c), true);
        }
        lacing_.turn_over(t);
    }

    void try_t0(TriangleId t) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            if (lacing_.on_ring(table_.vertex(corner(t, k)))) continue;
            if (table_.degenerate(t) || try_lace_in(corner(t, k))) return;
        }
    }

    bool try_lace_in(CornerId c) {
        find_places(c);
        if (lacing_.faces_ring(c) && lacing_.can_lace_in(c)) place_[places_++] = c;
        if (places_ == 0) return false;
        const std::uint64_t bits = random();
        const std::int64_t limit_here = limit(bits);
        const CornerId place = any_place(bits);
        lacing_.turn_over(triangle(place));
        lacing_.set_on_ring(table_.vertex(c), true);
        if (lacing_.cost() <= limit_here) return true;
        lacing_.set_on_ring(table_.vertex(c), false);
        lacing_.turn_over(triangle(place));
        return false;
    }

    const CornerTable& table_;
    Lacing& lacing_;
    std::uint64_t random_;
    std::array<std::int64_t, kLevels> rise_{};
    std::array<CornerId, 2 * kReach + 1> place_{};
    std::uint32_t places_ = 0;
};

}  // namespace

Rings optimize_rings(const CornerTable& table, Rings rings, const OptimizeOptions& options) {
    if (options.passes == 0 || rings.edges.empty()) return rings;
    constexpr double kHot = 0.35, kCold = 0.07;  // temperatures, in costs of a T0
    Lacing lacing(table, rings, options.cost);
    Annealer annealer(table, lacing, options.random_seed);
    const double unit = static_cast<double>(options.cost.t0 * kScale);
    const std::uint32_t descent = options.anneal ? 1 + options.passes / 8 : options.passes;
    std::int64_t best_cost = lacing.cost();
    std::optional<Lacing> best;
    for (std::uint32_t p = 0; p < options.passes; ++p) {
        const double progress = static_cast<double>(p) / options.passes;
        annealer.set_temperature(p + descent >= options.passes ? 0 : unit * kHot * std::pow(kCold / kHot, progress));
        annealer.pass();
        if (lacing.cost() < best_cost) {
            best_cost = lacing.cost();
            best = lacing;
        }
        if (options.progress && !options.progress(p + 1)) break;
    }
    if (!best) return rings;
    const std::size_t ring_vertices = rings.edges.size();
    rings = Rings{};
    return best->rings(ring_vertices);
}

}  // namespace lr
