// A ring is changed by moving a triangle to the ring's other side: its ring edges leave the ring, its other edges join
// it. Moving a T2 whose ring edges meet in v takes v out of the ring; moving a T1 whose tip v is on no ring laces v in.
// Each ring stays one cycle. At a T2 the optimizer takes v out and laces it in elsewhere in its fan. This shortens one
// dead end and lengthens another: dead ends wander until they are as short as a wart, or vanish with their bifurcation.
// Most such changes cost nothing, so annealing works at low temperatures. Only dead ends near a T0 in no wart are
// tried: few others can gain. An estimate from the triangles around v rejects most unfavorable changes before they are
// made.
//
// Large meshes are annealed in parts. A change must read and write only triangles of its part, so the parts of a pass
// are independent; the borders of parts move from pass to pass. Parts and their random numbers depend only on the mesh
// and the seed, so the result is the same for any number of threads. Temperatures are integers, so the result is the
// same on every machine.

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "lacedring/ring.hpp"
#include "lrcore/base/parallel.h"
#include "lrcore/base/random.h"
#include "lrcore/ring/lacing.h"

namespace lacedring {
namespace {

/// Metropolis rule: the random limit by which a change may raise the cost.
class Temperature {
  public:
    static constexpr std::size_t kLevels = 512;

    void set(std::int64_t temperature) {
        for (std::size_t i = 0; i < kLevels; ++i) rise_[i] = kMinusLog[i] * temperature >> 16;
    }
    std::int64_t rise(std::uint64_t bits) const { return rise_[bits % kLevels]; }

  private:
    /// -ln((i + 1/2) / kLevels) with 16 fraction bits, by squaring.
    static constexpr auto kMinusLog = [] {
        std::array<std::int64_t, kLevels> out{};
        for (std::size_t i = 0; i < kLevels; ++i) {
            std::uint64_t x = (2 * i + 1) << 21U;  // over 2^31; below 1
            std::uint64_t log = 0;                 // -log2 with 32 fraction bits
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

/// e^-(x / 2^28) with 28 fraction bits, for x up to 3 * 2^28.
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
    Annealer(Lacing& lacing, TriangleRange range, const Temperature& temperature, const RingCost& cost,
             std::uint64_t random_seed)
        : lacing_(lacing),
          range_(range),
          temperature_(temperature),
          isolated_cost_(Lacing::kScale * cost.isolated),
          slack_(Lacing::kScale * std::int64_t{cost.t0 - cost.t0_wart} * 3 / 2),
          warts_are_cheap_(2 * std::int64_t{cost.t0_wart} < cost.t0),
          rounds_(std::clamp<std::uint32_t>(kSmall / lacing.size(), 4, 24)),
          random_(random_seed) {}

    /// Tries changes at every vertex off the rings and at every T2 near a T0 outside warts. `isolated` has a
    /// corner of each vertex off the rings.
    void run(std::uint32_t pass, std::span<const std::uint32_t> isolated) {
        for (const std::uint32_t c : isolated) {
            if (!try_lace_in(c)) isolated_.push_back(c);
        }
        if (pass % (warts_are_cheap_ ? kMarkingWarts : kMarking) == 0) mark_near();
        lacing_.find_marked_t2(range_, ends_);
        // In batches, so that the triangles touched stay in the cache.
        for (std::size_t i = 0; i < ends_.size(); i += kBatch) {
            batch_.assign(ends_.data() + i, ends_.data() + std::min(i + kBatch, ends_.size()));
            for (std::uint32_t round = 0; round < rounds_ && !batch_.empty(); ++round) try_batch();
        }
        std::sort(isolated_.begin(), isolated_.end());
    }

    std::int64_t cost() const { return cost_; }  ///< total change of cost
    std::size_t tried() const {
        return ends_.size() + isolated_.size();
    }  ///< approximate number of dead ends and vertices
    std::vector<std::uint32_t>& isolated() { return isolated_; }

  private:
    // Limit of triangles of a fan visited in each direction: bounds the time at vertices of high valence.
    static constexpr std::uint32_t kReach = 24;
    static constexpr std::uint32_t kSmall = 32768;
    static constexpr std::size_t kBatch = 128;  // dead ends per batch
    /// If warts are cheap: T2 up to this distance, in triangles, from a T0 outside warts are tried; and the number of
    /// passes that use the same marks.
    static constexpr std::uint32_t kNearWarts = 6, kMarkingWarts = 2;
    static constexpr std::uint32_t kNear = 20, kMarking = 8;  // if warts are not cheap
    /// The distance grows up to kFar while less than one in kFew triangles is near.
    static constexpr std::uint32_t kFar = 20, kFew = 32;

    enum class Try : std::uint8_t { done, refused, hopeless };

    /// Collects the corners of vertex(c) near c, excluding c, in their order around the vertex.
    void walk_fan(std::uint32_t c) {
        fan_ = 0;
        std::uint32_t x = c;
        for (std::uint32_t n = 0; n < kReach; ++n) {
            x = lacing_.opposite(Lacing::next(x));
            if (x == Lacing::kNone || !range_.has(x >> 2)) break;
            x = Lacing::next(x);
            if (x == c) return;
            add_to_fan(x);
        }
        const std::uint32_t first = fan_;
        x = c;
        // Backward from c, if the fan is open or too large.
        for (std::uint32_t n = 0; n < kReach; ++n) {
            x = lacing_.opposite(Lacing::previous(x));
            if (x == Lacing::kNone || !range_.has(x >> 2)) break;
            x = Lacing::previous(x);
            add_to_fan(x);
        }
        std::reverse(corner_.begin() + first, corner_.begin() + fan_);
        std::reverse(state_.begin() + first, state_.begin() + fan_);
    }
    void add_to_fan(std::uint32_t x) {
        corner_[fan_] = x;
        state_[fan_++] = lacing_.state(x >> 2);
    }

    /// Estimates the cost of taking vertex(c) out of the T2 of c and lacing it in at corner_[i]: counts the T0 created
    /// and removed, but ignores T0 that enter or leave a wart.
    std::int64_t estimate(std::uint32_t i) const {
        std::int64_t out = 0;
        if (i != 1 && Lacing::ring_edges(state_[0]) == 1) out += lacing_.cost_as_t0(state_[0]);
        if (i + 2 != fan_ && Lacing::ring_edges(state_[fan_ - 1]) == 1) out += lacing_.cost_as_t0(state_[fan_ - 1]);
        if (i > 0) out -= lacing_.cost(state_[i - 1]);
        if (i + 1 < fan_) out -= lacing_.cost(state_[i + 1]);
        const std::uint32_t across = lacing_.opposite(corner_[i]);
        if (across == Lacing::kNone || !range_.has(across >> 2)) return out;
        return Lacing::ring_edges(lacing_.state(across >> 2)) == 1 ? out + lacing_.wart_cost() : out;
    }

    /// Takes a T2's vertex out and usually laces it in elsewhere. Only a T2 on the left side may lose its vertex for
    /// good: the T2 moves to the right, and the left side stays a tree of triangles with all vertices on the ring. If
    /// done, place_ is the corner where the vertex was laced in, or c.
    Try try_t2(std::uint32_t t) {
        const std::uint32_t c = lacing_.t2_corner(t), across = lacing_.opposite(c);
        if (!lacing_.can_take_out(c)) return Try::hopeless;
        const std::uint64_t bits = random_.next();
        const std::int64_t most = temperature_.rise(bits);
        const std::int64_t gain =
            across != Lacing::kNone && range_.has(across >> 2) ? lacing_.cost(lacing_.state(across >> 2)) : 0;
        changes_.clear();
        if ((bits >> 10U) % 8 == 0 && !lacing_.is_right(c)) {
            if (isolated_cost_ - gain > most + slack_ || !lacing_.within(range_, t)) return Try::refused;
            const std::int64_t cost = lacing_.turn_over(t, changes_) + isolated_cost_;
            if (cost <= most && !lacing_.maybe_two_ring(range_, c)) {
                cost_ += cost;
                isolated_.push_back(c);
                place_ = c;
                return Try::done;
            }
            lacing_.undo(changes_);
            return Try::refused;
        }
        walk_fan(c);
        std::uint32_t places = 0;
        for (std::uint32_t i = 0; i < fan_; ++i) {
            if (!lacing_.can_lace_in(corner_[i])) continue;
            if (warts_are_cheap_ || estimate(i) - gain <= most + slack_) corner_[places++] = corner_[i];
        }
        if (places == 0) return Try::hopeless;
        place_ = any_place(places, bits);
        if (!lacing_.within(range_, t) || !lacing_.within(range_, place_ >> 2)) return Try::refused;
        const std::uint32_t length = warts_are_cheap_ ? lacing_.dead_end(range_, t, kLong) : kLong;
        const std::int64_t cost = lacing_.turn_over(t, changes_) + lacing_.turn_over(place_ >> 2, changes_);
        // If the edge facing v is still on a ring, this ring may have only two edges: v was on a ring of three.
        if (cost > most || (lacing_.faces_ring(c) && lacing_.maybe_two_ring(range_, c)) ||
            (cost == 0 && length < kLong && (bits >> 13U) % 16 != 0 && lacing_.is_t2(place_ >> 2) &&
             lacing_.dead_end(range_, place_ >> 2, kLong) > length)) {
            lacing_.undo(changes_);
            return Try::refused;
        }
        cost_ += cost;
        return Try::done;
    }

    /// Tries to lace in vertex(c), which is on no ring, at a random possible corner near c. Returns whether it did.
    bool try_lace_in(std::uint32_t c) {
        walk_fan(c);
        add_to_fan(c);
        std::uint32_t places = 0;
        for (std::uint32_t i = 0; i < fan_; ++i) {
            if (lacing_.can_lace_in(corner_[i])) corner_[places++] = corner_[i];
        }
        if (places == 0) return false;
        const std::uint64_t bits = random_.next();
        const std::uint32_t place = any_place(places, bits);
        if (!lacing_.within(range_, place >> 2)) return false;
        changes_.clear();
        const std::int64_t cost = lacing_.turn_over(place >> 2, changes_) - isolated_cost_;
        if (cost <= temperature_.rise(bits)) {
            cost_ += cost;
            return true;
        }
        lacing_.undo(changes_);
        return false;
    }

    std::uint32_t any_place(std::uint32_t places, std::uint64_t bits) const {
        return corner_[(bits >> 32U) * places >> 32U];
    }

    /// Tries a change at each T2 of batch_, then replaces batch_ by the present ends of the dead ends. Drops T2 where
    /// no change is possible.
    void try_batch() {
        std::size_t kept = 0;
        moved_.clear();
        for (const std::uint32_t t : batch_) {
            if (!lacing_.is_t2(t)) continue;
            const std::uint32_t across = lacing_.opposite(lacing_.t2_corner(t));
            const Try tried = try_t2(t);
            if (tried == Try::refused) batch_[kept++] = t;
            if (tried != Try::done) continue;
            // The dead end got shorter, and place_ is the end of another one.
            if (range_.has(across >> 2) && lacing_.is_t2(across >> 2)) batch_[kept++] = across >> 2;
            if (lacing_.is_t2(place_ >> 2)) moved_.push_back(place_ >> 2);
        }
        batch_.resize(kept);
        batch_.insert(batch_.end(), moved_.begin(), moved_.end());
    }

    /// Marks the triangles of the range that are near a T0 outside warts, and clears all other marks.
    void mark_near() {
        std::vector<std::uint32_t> near;
        lacing_.mark_expensive(range_, near);
        std::size_t i = 0;
        const std::size_t few = (range_.end - range_.begin) / kFew;
        const std::uint32_t least = warts_are_cheap_ ? kNearWarts : kNear;
        for (std::uint32_t distance = 0; distance < least || (distance < kFar && near.size() < few); ++distance) {
            for (const std::size_t end = near.size(); i < end; ++i) {
                for (std::uint32_t k = 0; k < 3; ++k) {
                    const std::uint32_t o = lacing_.opposite(4 * near[i] + k);
                    if (!range_.has(o >> 2) || lacing_.marked(o >> 2)) continue;  // kNone is in no range
                    lacing_.mark(o >> 2);
                    near.push_back(o >> 2);
                }
            }
        }
    }

    static constexpr std::uint32_t kLong = 4;  // dead ends of this length and longer are equally good

    Lacing& lacing_;
    TriangleRange range_;
    const Temperature& temperature_;
    std::int64_t isolated_cost_;
    std::int64_t slack_;    // maximum by which an estimate may exceed the cost
    bool warts_are_cheap_;  // true: dead ends are kept short, to become warts
    // Changes tried per dead end and pass; more for small meshes, whose result depends more on chance.
    std::uint32_t rounds_;
    detail::SplitMix64 random_;
    std::int64_t cost_ = 0;
    std::vector<std::uint32_t> isolated_;
    Lacing::Changes changes_;
    std::array<std::uint32_t, 2 * kReach + 1> corner_;  // the first fan_ are the fan's corners
    std::array<std::uint8_t, 2 * kReach + 1> state_;    // states of their triangles
    std::uint32_t fan_ = 0, place_ = 0;
    std::vector<std::uint32_t> ends_, batch_, moved_;  // triangles that were T2 when added
};

/// The result of a pass over a part.
struct Outcome {
    std::int64_t cost = 0;
    std::size_t tried = 0;
    std::vector<std::uint32_t> isolated;
};

/// The number of parts in which a mesh of that size is annealed.
std::uint32_t number_of_parts(std::uint32_t triangles) {
    constexpr std::uint32_t kLeast = 16384, kMost = 16;  // minimum triangles per part; maximum number of parts
    return std::clamp(triangles / kLeast, 1U, kMost);
}

/// The first triangle of each part of a pass, and the number of triangles.
std::vector<std::uint32_t> parts_of(std::uint32_t triangles, std::uint32_t pass) {
    const std::uint32_t parts = number_of_parts(triangles);
    if (parts == 1) return {0, triangles};
    // Shifts the parts by a multiple of the golden ratio per pass: any place is far from a border in most passes.
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
    // 2 ms of work: forty times the start of a thread.
    constexpr std::size_t kTriedOfThread = 8192;
    constexpr std::uint32_t kMostTriangles = 1U << 30;  // limit of Lacing's corner numbers
    if (options.passes == 0 || rings.edges.empty() || table.triangle_count() >= kMostTriangles) return rings;
    // Temperatures fall geometrically, and further if warts are cheap. Their unit is the larger of a T0's gain from a
    // wart and its cost in a wart.
    constexpr std::int64_t kHot = 50;  // hundredths of a unit
    const std::int64_t cooling = 2 * std::int64_t{options.cost.t0_wart} < options.cost.t0
                                     ? 618095479   // ln(0.5 / 0.05) * 2^28
                                     : 396193577;  // ln(0.5 / 0.114) * 2^28
    const std::int64_t unit = Lacing::kScale * std::max(std::int64_t{options.cost.t0} - options.cost.t0_wart,
                                                        std::int64_t{options.cost.t0_wart});
    const std::uint32_t descent = options.anneal ? 1 + options.passes / 8 : options.passes;
    Lacing lacing(table, rings, options.cost);
    if (!lacing.has_expensive() && (options.cost.isolated <= 0 || lacing.all_on_rings())) return rings;
    rings = {};
    lacing.number_triangles(lacing.size() / number_of_parts(lacing.size()));
    std::vector<std::uint8_t> best = lacing.states();
    std::vector<std::uint32_t> isolated = lacing.take_isolated();
    std::int64_t cost = 0, best_cost = 0;
    std::size_t tried = lacing.size() / 16;  // in the previous pass
    Temperature temperature;
    for (std::uint32_t p = 0; p < options.passes && tried > 0; ++p) {
        const bool cold = p + descent >= options.passes;
        temperature.set(cold ? 0 : (unit * kHot / 100 * exponential(cooling * p / options.passes)) >> 28);
        const std::vector<std::uint32_t> begins = parts_of(lacing.size(), p);
        std::vector<Outcome> outcomes(begins.size() - 1);
        const unsigned threads = tried < kTriedOfThread ? 1 : options.threads;
        detail::in_parallel(threads, static_cast<std::uint32_t>(outcomes.size()), [&](std::uint32_t i) {
            const TriangleRange range{begins[i], begins[i + 1]};
            Annealer annealer(lacing, range, temperature, options.cost,
                              detail::mix(options.random_seed + detail::mix((std::uint64_t{p} << 32U) + i)));
            const auto first_of = [&](std::uint32_t t) {
                return std::lower_bound(isolated.begin(), isolated.end(), 4 * t);
            };
            annealer.run(p, {first_of(range.begin), first_of(range.end)});
            outcomes[i] = {annealer.cost(), annealer.tried(), std::move(annealer.isolated())};
        });
        isolated.clear();
        tried = 0;
        for (const Outcome& outcome : outcomes) {
            cost += outcome.cost;
            tried += outcome.tried;
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
