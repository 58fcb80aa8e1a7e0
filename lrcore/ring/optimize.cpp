// A ring is changed by turning a triangle over to the ring's other side: its edges on the ring leave it, the others
// enter it. Where that is a T2 whose ring edges meet in v, v leaves the ring; where it is a T1 whose tip v is on no
// ring, v is laced in. Either way each ring stays one cycle. What is tried at a T2 is to take v out and lace it in
// again elsewhere in its fan. That shortens one dead end and lengthens another: dead ends wander until they are as
// short as a wart, or gone with their bifurcation. Most such changes cost nothing, so annealing at low temperatures
// goes far; and only those near a T0 without a wart can gain, so most are tried there.

#include <algorithm>
#include <cmath>
#include <optional>

#include "lacedring/ring.hpp"
#include "lrcore/ring/lacing.h"

namespace lacedring {
namespace {

class Annealer {
  public:
    Annealer(const CornerTable& table, Lacing& lacing, std::uint64_t random_seed)
        : table_(table), lacing_(lacing), random_(random_seed) {
        for (std::uint32_t t = 0; t < table.triangle_count(); ++t) expensive_ += is_expensive(TriangleId{t}) ? 1 : 0;
    }

    void set_temperature(double temperature) {
        for (std::size_t i = 0; i < kLevels; ++i) {
            rise_[i] = static_cast<std::int64_t>(-std::log((static_cast<double>(i) + 0.5) / kLevels) * temperature);
        }
    }

    /// Tries one change at every vertex off the rings and at some of the T2, and many around T0 that are in no wart.
    void pass() {
        ++passes_;
        const std::uint64_t budget = kStepsPerTriangle * std::uint64_t{table_.triangle_count()};
        const std::uint64_t steps =
            std::min<std::uint64_t>(kMostSteps, budget / std::max<std::uint64_t>(expensive_, 1));
        expensive_ = 0;
        for (std::uint32_t i = 0; i < table_.triangle_count(); ++i) {
            const TriangleId t{i};
            if (lacing_.is_t2(t)) {
                if ((i + passes_) % kSweeps == 0) try_t2(t);
            } else if (lacing_.is_t0(t)) {
                try_t0(t);
                if (!is_expensive(t)) continue;
                ++expensive_;
                try_around(t, steps);
            } else if (lacing_.marked(t)) {
                const CornerId c = lacing_.tip_corner(t);
                if (lacing_.on_ring(table_.vertex(c)) || try_lace_in(c)) lacing_.mark(t, false);
            }
        }
    }

  private:
    static constexpr std::size_t kLevels = 512;
    static constexpr std::uint32_t kReach = 24;  // triangles of a fan looked at each way, so that hubs cost no more
    static constexpr std::uint32_t kSweeps = 8;  // passes until every T2 has had its turn
    static constexpr std::uint64_t kStepsPerTriangle = 2, kMostSteps = 512, kWalk = 32;  // of try_around, in a pass

    bool is_expensive(TriangleId t) const { return lacing_.is_t0_beside_no_t2(t) && !table_.degenerate(t); }

    /// SplitMix64 (Steele, Lea, Flood 2014).
    std::uint64_t random() {
        std::uint64_t z = (random_ += 0x9e3779b97f4a7c15U);
        z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
        z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
        return z ^ (z >> 31U);
    }
    /// The cost up to which a change stays: Metropolis' rule.
    std::int64_t limit(std::uint64_t bits) const { return lacing_.cost() + rise_[bits % kLevels]; }

    /// Collects the corners of vertex(c) near c, but not c, through whose triangles it can be laced in.
    void find_places(CornerId c) {
        places_ = 0;
        CornerId x = c;
        for (std::uint32_t n = 0; n < kReach; ++n) {
            x = table_.swing(x);
            if (x == c) return;
            if (x.is_null()) break;
            add_place(x);
        }
        if (!x.is_null()) return;
        x = c;
        for (std::uint32_t n = 0; n < kReach; ++n) {  // on the other side of c, where the fan is open
            x = table_.right(x);
            if (x.is_null()) return;
            x = previous(x);
            add_place(x);
        }
    }
    void add_place(CornerId x) {
        if (lacing_.faces_ring(x) && lacing_.can_lace_in(x)) place_[places_++] = x;
    }
    CornerId any_place(std::uint64_t bits) const { return place_[(bits >> 32U) * places_ >> 32U]; }

    /// Takes a T2's vertex out, and mostly laces it in elsewhere. It is left out on the right side only: so the left
    /// one remains a tree of triangles, all their vertices on the ring, and has dead ends for encoders to close it at.
    void try_t2(TriangleId t) {
        const CornerId c = lacing_.t2_corner(t);
        if (!lacing_.can_take_out(c)) return;
        const std::uint64_t bits = random();
        const std::int64_t most = limit(bits);
        if ((bits >> 10U) % 8 != 0 || lacing_.is_right(c)) {
            find_places(c);
            if (places_ == 0) return;
            const TriangleId place = triangle(any_place(bits));
            lacing_.turn_over(t);
            lacing_.turn_over(place);
            // If the edge that faces v is still on a ring, that may be one of two edges: v came from a ring of three.
            if (lacing_.cost() <= most && !(lacing_.faces_ring(c) && lacing_.is_two_ring(c))) return;
            lacing_.turn_over(place);
        } else {
            lacing_.turn_over(t);
            lacing_.set_on_ring(table_.vertex(c), false);
            if (lacing_.cost() <= most && !lacing_.is_two_ring(c)) {
                lacing_.mark(t, true);  // there may be no T0 from which v would be found again
                return;
            }
            lacing_.set_on_ring(table_.vertex(c), true);
        }
        lacing_.turn_over(t);
    }

    /// Tries to lace in a vertex that the T0 has off the rings.
    void try_t0(TriangleId t) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            if (lacing_.on_ring(table_.vertex(corner(t, k)))) continue;
            if (table_.degenerate(t) || try_lace_in(corner(t, k))) return;
        }
    }

    bool try_lace_in(CornerId c) {
        find_places(c);
        add_place(c);
        if (places_ == 0) return false;
        const std::uint64_t bits = random();
        const std::int64_t most = limit(bits);
        const TriangleId place = triangle(any_place(bits));
        lacing_.turn_over(place);
        lacing_.set_on_ring(table_.vertex(c), true);
        if (lacing_.cost() <= most) return true;
        lacing_.set_on_ring(table_.vertex(c), false);
        lacing_.turn_over(place);
        return false;
    }

    /// Random walks from a T0 in no wart, with a change tried at each T2 met, until the T0 is gone or in a wart.
    void try_around(TriangleId t, std::uint64_t steps) {
        TriangleId at = t;
        std::uint64_t bits = 0;
        for (std::uint64_t i = 0; i < steps; ++i) {
            if (i % 16 == 0) bits = random();
            if (i % kWalk == 0) at = t;
            const CornerId o = table_.opposite(corner(at, static_cast<std::uint32_t>(bits % 16 * 3 / 16)));
            bits /= 16;
            if (o.is_null()) continue;
            at = triangle(o);
            if (!lacing_.is_t2(at)) continue;
            try_t2(at);
            if (!lacing_.is_t0_beside_no_t2(t)) return;
        }
    }

    const CornerTable& table_;
    Lacing& lacing_;
    std::uint64_t random_;
    std::uint32_t passes_ = 0;
    std::uint64_t expensive_ = 0;  // T0 in no wart, when last counted
    std::array<std::int64_t, kLevels> rise_{};
    std::array<CornerId, 2 * kReach + 1> place_{};
    std::uint32_t places_ = 0;
};

}  // namespace

Rings optimize_rings(const CornerTable& table, Rings rings, const OptimizeOptions& options) {
    if (options.passes == 0 || rings.edges.empty()) return rings;
    // Temperatures fall from kHot to kCold geometrically, in units of what a T0 gains by a wart, or one in a wart
    // costs.
    constexpr double kHot = 0.35, kCold = 0.08;
    const double unit =
        static_cast<double>(Lacing::kScale) * std::max(options.cost.t0 - options.cost.t0_wart, options.cost.t0_wart);
    const std::uint32_t descent = options.anneal ? 1 + options.passes / 8 : options.passes;
    Lacing lacing(table, rings, options.cost);
    Annealer annealer(table, lacing, options.random_seed);
    std::int64_t best_cost = lacing.cost();
    std::optional<Lacing> best;
    for (std::uint32_t p = 0; p < options.passes; ++p) {
        const bool cold = p + descent >= options.passes;
        annealer.set_temperature(cold ? 0
                                      : unit * kHot * std::pow(kCold / kHot, static_cast<double>(p) / options.passes));
        annealer.pass();
        if (lacing.cost() < best_cost) {
            best_cost = lacing.cost();
            best = lacing;
        }
        if (options.progress && !options.progress(p + 1)) break;
    }
    if (!best) return rings;
    rings = Rings{};
    return best->rings();
}

}  // namespace lacedring
