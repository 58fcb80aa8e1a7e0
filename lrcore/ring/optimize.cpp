// A ring is changed by turning a triangle over to the ring's other side: its edges on the ring leave it, the others
// enter it. Where that is a T2 whose ring edges meet in v, v leaves the ring; where it is a T1 whose tip v is on no
// ring, v is laced in. Either way each ring stays one cycle. What is tried at a T2 is to take v out and lace it in
// again elsewhere in its fan. That shortens one dead end and lengthens another: dead ends wander until they are as
// short as a wart, or gone with their bifurcation. Most such changes cost nothing, so annealing at low temperatures
// goes far; and only those near a T0 without a wart can gain, so most are tried there.
//
// Large meshes are annealed in parts. A change is made only where all that it reads and writes is in one part, so that
// the parts of a pass do not depend on each other; borders between parts move from pass to pass. Parts and their random
// numbers follow from the mesh and the seed alone: the result is the same for any number of threads. Temperatures are
// in integers, which are the same on every machine.

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "lacedring/ring.hpp"
#include "lrcore/base/parallel.h"
#include "lrcore/ring/lacing.h"

namespace lacedring {
namespace {

/// The finalizer of SplitMix64 (Steele, Lea, Flood 2014).
std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
}

/// By how much a change may raise the cost: Metropolis' rule.
class Temperature {
  public:
    static constexpr std::size_t kLevels = 512;

    void set(std::int64_t temperature) {
        for (std::size_t i = 0; i < kLevels; ++i) rise_[i] = kMinusLog[i] * temperature >> 16;
    }
    std::int64_t rise(std::uint64_t bits) const { return rise_[bits % kLevels]; }

  private:
    /// -ln((i + 1/2) / kLevels) with 16 bits behind the point, by squaring.
    static constexpr auto kMinusLog = [] {
        std::array<std::int64_t, kLevels> out{};
        for (std::size_t i = 0; i < kLevels; ++i) {
            std::uint64_t x = (2 * i + 1) << 21U;  // over 2^31; below 1
            std::uint64_t log = 0;                 // -log2, 32 bits behind the point
            for (; x < std::uint64_t{1} << 30U; x *= 2) log += std::uint64_t{1} << 32U;
            log += std::uint64_t{1} << 32U;
            x *= 2;  // in [1, 2)
            for (std::uint64_t bit = std::uint64_t{1} << 31U; bit != 0; bit /= 2) {
                x = x * x >> 31U;
                if (x >> 32U == 0) continue;
                x /= 2;
                log -= bit;
            }
            out[i] = static_cast<std::int64_t>((log >> 16U) * 45426 >> 16U);  // ln 2
        }
        return out;
    }();
    std::array<std::int64_t, kLevels> rise_{};
};

/// e^-(x / 2^28), with 28 bits behind the point, for x up to 2 * 2^28.
std::int64_t exponential(std::int64_t x) {
    std::int64_t sum = 0, term = std::int64_t{1} << 28;
    for (std::int64_t i = 1; i <= 20; ++i) {
        sum += term;
        term = -(term * x >> 28) / i;
    }
    return sum;
}

/// One pass over one part.
class Annealer {
  public:
    Annealer(Lacing& lacing, TriangleRange range, const Temperature& temperature, std::int64_t isolated_cost,
             std::uint64_t random_seed)
        : lacing_(lacing),
          range_(range),
          temperature_(temperature),
          isolated_cost_(isolated_cost),
          random_(random_seed) {}

    /// Tries one change at every vertex off the rings and `rounds` at every T2 near a T0 that is in no wart, and at
    /// some others. `isolated` has corners of the vertices off the rings.
    void run(std::uint32_t pass, std::uint32_t rounds, std::span<const std::uint32_t> isolated) {
        for (const std::uint32_t c : isolated) {
            if (!try_lace_in(c)) isolated_.push_back(c);
        }
        if (pass % kMarking == 0) mark_near();
        find_ends(pass);
        const std::size_t affordable = (range_.end - range_.begin) / (kSpread * std::max<std::size_t>(ends_.size(), 1));
        rounds = static_cast<std::uint32_t>(std::clamp<std::size_t>(affordable, 2, rounds));
        // A few at a time, so that what they touch stays in the cache.
        for (std::size_t i = 0; i < ends_.size(); i += kBatch) {
            const std::span batch = std::span(ends_).subspan(i, std::min(kBatch, ends_.size() - i));
            batch_.assign(batch.begin(), batch.end());
            for (std::uint32_t round = 0; round < rounds; ++round) try_batch();
        }
        std::sort(isolated_.begin(), isolated_.end());
    }

    std::int64_t cost() const { return cost_; }  ///< of all changes made
    std::vector<std::uint32_t>& isolated() { return isolated_; }

  private:
    static constexpr std::uint32_t kReach = 24;   // triangles of a fan looked at each way, so that hubs cost no more
    static constexpr std::uint32_t kNear = 10;    // edges from a T0 in no wart to the T2 that are tried
    static constexpr std::uint32_t kMarking = 4;  // passes that use the same marks
    static constexpr std::uint32_t kSweeps = 8;   // passes until every T2 has had its turn
    static constexpr std::uint32_t kSpread = 3;   // triangles for each try of a pass, at least
    static constexpr std::size_t kBatch = 128;    // dead ends

    std::uint64_t random() { return mix(random_ += 0x9e3779b97f4a7c15U); }

    /// Collects the corners of vertex(c) near c, but not c, through whose triangles it can be laced in.
    void find_places(std::uint32_t c) {
        places_ = 0;
        std::uint32_t x = c;
        for (std::uint32_t n = 0; n < kReach; ++n) {
            x = lacing_.opposite(Lacing::next(x));
            if (x == Lacing::kNone || !range_.has(x >> 2)) break;
            x = Lacing::next(x);
            if (x == c) return;
            add_place(x);
        }
        x = c;
        for (std::uint32_t n = 0; n < kReach; ++n) {  // on the other side of c, where the fan is open or too large
            x = lacing_.opposite(Lacing::previous(x));
            if (x == Lacing::kNone || !range_.has(x >> 2)) return;
            x = Lacing::previous(x);
            add_place(x);
        }
    }
    void add_place(std::uint32_t x) {
        place_[places_] = x;
        places_ += std::uint32_t{lacing_.can_lace_in(x)} & std::uint32_t{lacing_.within(range_, x >> 2)};
    }
    std::uint32_t any_place(std::uint64_t bits) const { return place_[(bits >> 32U) * places_ >> 32U]; }

    /// Takes a T2's vertex out, and mostly laces it in elsewhere. It is left out on the right side only: so the left
    /// one remains a tree of triangles, all their vertices on the ring, and has dead ends for encoders to close it at.
    /// Returns whether it did; then place_[0] is the place, or c.
    bool try_t2(std::uint32_t t) {
        const std::uint32_t c = lacing_.t2_corner(t);
        if (!lacing_.can_take_out(c) || !lacing_.within(range_, t)) return false;
        const std::uint64_t bits = random();
        const std::int64_t most = temperature_.rise(bits);
        changes_.clear();
        if ((bits >> 10U) % 8 != 0 || lacing_.is_right(c)) {
            find_places(c);
            if (places_ == 0) return false;
            place_[0] = any_place(bits);
            const std::int64_t cost = lacing_.turn_over(t, changes_) + lacing_.turn_over(place_[0] >> 2, changes_);
            // If the edge that faces v is still on a ring, that may be one of two edges: v came from a ring of three.
            if (cost <= most && !(lacing_.faces_ring(c) && lacing_.maybe_two_ring(range_, c))) {
                cost_ += cost;
                return true;
            }
        } else {
            const std::int64_t cost = lacing_.turn_over(t, changes_) + isolated_cost_;
            if (cost <= most && !lacing_.maybe_two_ring(range_, c)) {
                cost_ += cost;
                isolated_.push_back(c);
                place_[0] = c;
                return true;
            }
        }
        lacing_.undo(changes_);
        return false;
    }

    /// Laces in vertex(c), which is off the rings.
    bool try_lace_in(std::uint32_t c) {
        find_places(c);
        add_place(c);
        if (places_ == 0) return false;
        const std::uint64_t bits = random();
        changes_.clear();
        const std::int64_t cost = lacing_.turn_over(any_place(bits) >> 2, changes_) - isolated_cost_;
        if (cost <= temperature_.rise(bits)) {
            cost_ += cost;
            return true;
        }
        lacing_.undo(changes_);
        return false;
    }

    /// Tries a change at each T2 of batch_, and notes where the dead ends are then.
    void try_batch() {
        std::size_t kept = 0;
        moved_.clear();
        for (const std::uint32_t t : batch_) {
            if (!lacing_.is_t2(t)) continue;
            const std::uint32_t across = lacing_.opposite(lacing_.t2_corner(t));
            if (!try_t2(t)) {
                batch_[kept++] = t;
                continue;
            }
            // The dead end got shorter, and place_[0] is the end of another one.
            if (range_.has(across >> 2) && lacing_.is_t2(across >> 2)) batch_[kept++] = across >> 2;
            if (lacing_.is_t2(place_[0] >> 2)) moved_.push_back(place_[0] >> 2);
        }
        batch_.resize(kept);
        batch_.insert(batch_.end(), moved_.begin(), moved_.end());
    }

    /// Marks the triangles within kNear edges of a T0 in no wart, and no others.
    void mark_near() {
        std::vector<std::uint32_t> near;
        for (std::uint32_t t = range_.begin; t < range_.end; ++t) {
            const bool expensive = lacing_.is_expensive(t);
            lacing_.mark(t, expensive);
            if (expensive) near.push_back(t);
        }
        std::size_t i = 0;
        for (std::uint32_t distance = 0; distance < kNear; ++distance) {
            for (const std::size_t end = near.size(); i < end; ++i) {
                for (std::uint32_t k = 0; k < 3; ++k) {
                    const std::uint32_t o = lacing_.opposite(4 * near[i] + k);
                    if (!range_.has(o >> 2) || lacing_.marked(o >> 2)) continue;  // kNone is in no range
                    lacing_.mark(o >> 2, true);
                    near.push_back(o >> 2);
                }
            }
        }
    }

    /// Collects the T2 that are marked; tries one change at some of the others.
    void find_ends(std::uint32_t pass) {
        std::array<std::uint32_t, 256> found;
        for (std::uint32_t begin = range_.begin; begin < range_.end;) {
            const std::uint32_t end = begin + std::min<std::uint32_t>(range_.end - begin, found.size());
            std::size_t count = 0;  // no branch on what a triangle is: no processor foretells it
            for (std::uint32_t t = begin; t < end; ++t) {
                found[count] = t;
                const int wanted = int{lacing_.marked(t)} | int{(t + pass) % kSweeps == 0};
                count += static_cast<std::size_t>(int{lacing_.is_t2(t)} & wanted);
            }
            for (std::size_t i = 0; i < count; ++i) {
                if (lacing_.marked(found[i])) {
                    ends_.push_back(found[i]);
                } else if (lacing_.is_t2(found[i])) {
                    try_t2(found[i]);
                }
            }
            begin = end;
        }
    }

    Lacing& lacing_;
    TriangleRange range_;
    const Temperature& temperature_;
    std::int64_t isolated_cost_;
    std::uint64_t random_;
    std::int64_t cost_ = 0;
    std::vector<std::uint32_t> isolated_;
    Lacing::Changes changes_;
    std::array<std::uint32_t, 2 * kReach + 1> place_;
    std::uint32_t places_ = 0;
    std::vector<std::uint32_t> ends_, batch_, moved_;  // triangles that were T2 when noted
};

/// What a pass over a part came to.
struct Outcome {
    std::int64_t cost = 0;
    std::vector<std::uint32_t> isolated;
};

/// Where the parts of a pass begin, and the end. Their number depends on the size of the mesh only.
std::vector<std::uint32_t> parts_of(std::uint32_t triangles, std::uint32_t pass) {
    constexpr std::uint32_t kLeast = 12288, kMost = 16;  // triangles of a part; parts
    const std::uint32_t parts = std::clamp(triangles / kLeast, 1U, kMost);
    if (parts == 1) return {0, triangles};
    // Shifted by a multiple of the golden ratio each time: any place is far from a border in most passes.
    const std::uint32_t size = triangles / parts;
    const auto shift = static_cast<std::uint32_t>(std::uint64_t{size} * (pass * 0x9e3779b9U) >> 32U);
    std::vector<std::uint32_t> out{0};
    for (std::uint32_t i = 0; i < parts; ++i) {
        const std::uint32_t begin = i * size + shift;
        if (begin != 0) out.push_back(begin);
    }
    out.push_back(triangles);
    return out;
}

}  // namespace

Rings optimize_rings(const CornerTable& table, Rings rings, const OptimizeOptions& options) {
    constexpr std::uint32_t kMostTriangles = 1U << 30;  // that Lacing numbers the corners of
    if (options.passes == 0 || rings.edges.empty() || table.triangle_count() >= kMostTriangles) return rings;
    // Temperatures fall from kHot to kCold geometrically, in units of what a T0 gains by a wart, or one in a wart
    // costs.
    constexpr std::int64_t kHot = 35, kCooling = 396193577;  // in hundredths; ln(0.35 / 0.08) * 2^28
    const std::int64_t unit = Lacing::kScale * std::max(std::int64_t{options.cost.t0} - options.cost.t0_wart,
                                                        std::int64_t{options.cost.t0_wart});
    const std::uint32_t descent = options.anneal ? 1 + options.passes / 8 : options.passes;
    Lacing lacing(table, std::move(rings), options.cost);
    std::vector<std::uint8_t> best = lacing.states();
    std::vector<std::uint32_t> isolated = lacing.take_isolated();
    std::int64_t cost = 0, best_cost = 0;
    // Small meshes, where chance weighs more and trying is cheap, get more.
    const std::uint32_t rounds = lacing.size() < 16384 ? 24 : 6;
    Temperature temperature;
    for (std::uint32_t p = 0; p < options.passes; ++p) {
        const bool cold = p + descent >= options.passes;
        temperature.set(cold ? 0 : (unit * kHot / 100 * exponential(kCooling * p / options.passes)) >> 28);
        const std::vector<std::uint32_t> begins = parts_of(lacing.size(), p);
        std::vector<Outcome> outcomes(begins.size() - 1);
        detail::in_parallel(options.threads, static_cast<std::uint32_t>(outcomes.size()), [&](std::uint32_t i) {
            const TriangleRange range(begins[i], begins[i + 1], lacing.size());
            Annealer annealer(lacing, range, temperature, Lacing::kScale * options.cost.isolated,
                              mix(options.random_seed + mix((std::uint64_t{p} << 32U) + i)));
            const auto first_of = [&](std::uint32_t t) {
                return std::lower_bound(isolated.begin(), isolated.end(), 4 * t);
            };
            annealer.run(p, rounds, {first_of(range.begin), first_of(range.end)});
            outcomes[i] = {annealer.cost(), std::move(annealer.isolated())};
        });
        isolated.clear();
        for (const Outcome& outcome : outcomes) {
            cost += outcome.cost;
            isolated.insert(isolated.end(), outcome.isolated.begin(), outcome.isolated.end());
        }
        if (cost < best_cost) {
            best_cost = cost;
            best = lacing.states();
        }
        if (options.progress && !options.progress(p + 1)) break;
    }
    return Lacing::rings(std::move(lacing), best);
}

}  // namespace lacedring
