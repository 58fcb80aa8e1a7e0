// RING-EXPANDER (LR 2011, section 4.2), depth first.
//
// The invaded region is a tree of triangles; walking around it clockwise meets its boundary edges in ring order, so
// each edge that cannot be crossed is emitted at once as the next ring edge. The paper walks back through flagged
// triangles; here a stack holds the edges still to be tested. It reads each triangle once and allows prefetching.

#include <algorithm>
#include <optional>

#include "lacedring/ring.hpp"
#include "lacedring/topology.hpp"
#include "lrcore/base/bits.h"
#include "lrcore/base/compiler.h"
#include "lrcore/base/message.h"
#include "lrcore/base/parallel.h"
#include "lrcore/base/random.h"
#include "lrcore/ring/ring_walk.h"

namespace lacedring {
namespace {

constexpr std::size_t kAhead = 6;  // distance on the stack of the triangle prefetched

class Expander {
  public:
    explicit Expander(const CornerTable& table)
        : table_(table), visited_(table.vertex_count), rung_(table.triangle_count()) {}

    bool can_seed(TriangleId t) const {
        return !table_.degenerate(t) && !visited(t, 0) && !visited(t, 1) && !visited(t, 2);
    }

    /// Grows a region from seed's triangle and appends its boundary to `edges`. If `entered` is not null, appends the
    /// corners as in Expansion. k as in RingOptions.
    void grow(CornerId seed, std::uint32_t k, std::vector<RingEdge>& edges, std::vector<CornerId>* entered = nullptr) {
        if (k > 0) {
            grow_hybrid(seed, k, edges);
            if (entered != nullptr) entered->insert(entered->end(), region_.begin(), region_.end());
        } else if (entered != nullptr) {
            grow_deep<true>(seed, edges, *entered);
        } else {
            grow_deep<false>(seed, edges, region_);
        }
    }

    /// RING-EXPANDER. Appends to `entered` if kNoted.
    template <bool kNoted>
    void grow_deep(CornerId seed, std::vector<RingEdge>& edges, std::vector<CornerId>& entered) {
        if constexpr (kNoted) entered.push_back(seed);
        for (const CornerId c : {seed, next(seed), previous(seed)}) visited_.set(table_.vertex(c).value);
        stack_.assign({facing(next(seed)), facing(previous(seed))});
        RingEdge edge = facing(seed);
        while (true) {
            const CornerId c = edge.right;
            if (!c.is_null()) {
                edge.right_tip = table_.vertex(c);
                if (!visited_.test(edge.right_tip.value)) {  // invade c's triangle, to the right first
                    visited_.set(edge.right_tip.value);
                    if constexpr (kNoted) entered.push_back(c);
                    stack_.push_back(facing(next(c)));
                    fetch(stack_.back().right);  // often popped next
                    edge = facing(previous(c));
                    continue;
                }
            }
            edges.push_back(edge);
            if (stack_.empty()) return;
            edge = stack_.back();
            stack_.pop_back();
            if (stack_.size() >= kAhead) fetch(stack_[stack_.size() - kAhead].right);
        }
    }

    /// HYBRID-RING-EXPANDER (section 6.1): every k triangles the depth-first search continues from the oldest edge
    /// left. Grows the region first, then walks its boundary.
    void grow_hybrid(CornerId seed, std::uint32_t k, std::vector<RingEdge>& edges) {
        if (invaded_.empty()) invaded_ = BitVector(table_.triangle_count());
        for (const CornerId c : {seed, next(seed), previous(seed)}) visited_.set(table_.vertex(c).value);
        invaded_.set(triangle(seed).value);
        region_.assign(1, seed);
        queue_.assign({table_.opposite(seed), table_.opposite(next(seed)), table_.opposite(previous(seed))});
        std::size_t front = 0;
        while (front < queue_.size()) {
            const bool breadth = region_.size() % k == 0;
            const CornerId c = breadth ? queue_[front++] : queue_.back();
            if (!breadth) {
                queue_.pop_back();
                if (queue_.size() >= kAhead) fetch(queue_[queue_.size() - kAhead]);
            }
            if (c.is_null() || visited_.test(table_.vertex(c).value)) continue;
            visited_.set(table_.vertex(c).value);
            invaded_.set(triangle(c).value);
            region_.push_back(c);
            queue_.push_back(table_.left(c));
            fetch(queue_.back());
            queue_.push_back(table_.right(c));
        }
        stack_.assign({facing(next(seed)), facing(previous(seed))});
        RingEdge edge = facing(seed);
        while (true) {
            const CornerId c = edge.right;
            // The region is a tree of triangles, so an invaded triangle across an edge not yet walked was entered
            // through it.
            if (!c.is_null() && invaded_.test(triangle(c).value)) {
                stack_.push_back(facing(next(c)));
                fetch(stack_.back().right);
                edge = facing(previous(c));
                continue;
            }
            if (!c.is_null()) edge.right_tip = table_.vertex(c);
            edges.push_back(edge);
            if (stack_.empty()) break;
            edge = stack_.back();
            stack_.pop_back();
            if (stack_.size() >= kAhead) fetch(stack_[stack_.size() - kAhead].right);
        }
        for (const CornerId c : region_) invaded_.clear(triangle(c).value);
    }

    /// Undoes a ring: marks its vertices as unvisited.
    void undo(std::span<const RingEdge> ring) {
        for (const RingEdge& edge : ring) visited_.clear(edge.start.value);
    }

    /// Cost of the ring in references of a two-sided lean ring, up to a constant per component: two per ring vertex,
    /// minus three for every triangle that it saves from being stored verbatim.
    std::int64_t cost(std::span<const RingEdge> ring) {
        const auto size = static_cast<std::int64_t>(ring.size());
        std::int64_t covered = 0;
        for (const RingEdge& edge : ring) {
            for (const CornerId c : {edge.left, edge.right}) {
                if (c.is_null() || rung_.test(triangle(c).value)) continue;
                rung_.set(triangle(c).value);
                ++covered;
            }
        }
        // A T2 also stores one T0 neighbor (wart skipping).
        paired_.clear();
        const RingWalk walk(ring);
        for (std::uint32_t side = 0; side < 2; ++side) {
            for (std::size_t i = 0; i < ring.size(); ++i) {
                if (!walk.repeats(side, i)) continue;
                const CornerId y = walk.across_t2(table_, side, i);
                if (y.is_null() || rung_.test(triangle(y).value)) continue;
                rung_.set(triangle(y).value);
                paired_.push_back(triangle(y));
            }
        }
        for (const RingEdge& edge : ring) {
            rung_.clear(triangle(edge.left).value);
            if (!edge.right.is_null()) rung_.clear(triangle(edge.right).value);
        }
        for (const TriangleId t : paired_) rung_.clear(t.value);
        return 2 * size - 3 * covered - 3 * static_cast<std::int64_t>(paired_.size());
    }

  private:
    bool visited(TriangleId t, std::uint32_t k) const { return visited_.test(table_.vertex(corner(t, k)).value); }
    void fetch(CornerId c) const {
        if (!c.is_null()) detail::prefetch(&table_.corners[c.value]);
    }
    /// The edge that corner x of an invaded triangle faces.
    RingEdge facing(CornerId x) const {
        return {table_.vertex(previous(x)), x, table_.opposite(x), table_.vertex(x), kNullVertex};
    }

    const CornerTable& table_;
    BitVector visited_;             // paper: v.m
    BitVector invaded_{0};          // paper: t.m, for the region being grown
    std::vector<CornerId> region_;  // used by grow_hybrid: the corners as in Expansion
    std::vector<CornerId> queue_;
    // Scratch of cost(): triangles with a ring edge; all clear between calls.
    BitVector rung_;
    std::vector<RingEdge> stack_;
    std::vector<TriangleId> paired_;
};

/// Sets costs[i], i > 0, to the cost of the ring from seeds[i]. `size` is the size of one such ring.
void try_seeds(Expander& expander, const RingOptions& options, std::size_t size, std::span<const CornerId> seeds,
               std::span<std::int64_t> costs) {
    constexpr std::size_t kEdgesOfThread = 1U << 15;  // about 1 ms of work: ten times the start of a thread
    const auto threads = static_cast<std::uint32_t>(
        std::min<std::size_t>({options.threads, seeds.size() - 1, (seeds.size() - 1) * size / kEdgesOfThread}));
    const auto try_from = [&](Expander& with, std::size_t begin, std::size_t step) {
        std::vector<RingEdge> trial;
        trial.reserve(size + size / 4);
        for (std::size_t i = begin; i < seeds.size(); i += step) {
            trial.clear();
            with.grow(seeds[i], options.k, trial);
            costs[i] = with.cost(trial);
            with.undo(trial);
        }
    };
    if (threads <= 1) return try_from(expander, 1, 1);
    std::vector<Expander> copies(threads, expander);
    detail::in_parallel(threads, threads, [&](std::uint32_t i) { try_from(copies[i], 1 + i, threads); });
}

}  // namespace

std::uint32_t recommended_seeds(std::size_t triangles) {
    constexpr std::size_t kBudget = 4'000'000;  // triangles walked for all seeds together
    return static_cast<std::uint32_t>(std::clamp<std::size_t>(kBudget / std::max<std::size_t>(triangles, 1), 1, 64));
}

Rings expand_rings(const CornerTable& table, const RingOptions& options, Expansion* expansion) {
    Rings rings;
    rings.edges.reserve(table.vertex_count);
    if (expansion != nullptr) *expansion = {};
    std::vector<CornerId>* const entered = expansion != nullptr ? &expansion->corners : nullptr;
    Expander expander(table);
    detail::SplitMix64 random(options.random_seed);
    std::vector<RingEdge> region;
    std::vector<CornerId> seeds;
    std::vector<std::int64_t> costs;
    // For one_per_shell: marks the triangles of shells that have a ring. Computed only when another seed is possible;
    // most meshes have none.
    std::optional<Swirl> shells;
    std::size_t swirled = 0;
    const bool told = options.start.value < table.corners.size();
    for (std::size_t i = told ? 0 : 1; i <= table.triangle_count(); ++i) {
        const CornerId first = i == 0 ? options.start : corner(TriangleId{static_cast<std::uint32_t>(i - 1)}, 0);
        if (!expander.can_seed(triangle(first))) continue;
        if (options.one_per_shell) {
            if (!shells && !rings.first.empty()) shells.emplace(table);
            for (; swirled < rings.first.size(); ++swirled) {
                shells->run(rings.edges[rings.first[swirled]].left, [](CornerId) {});
            }
            if (shells && shells->visited(triangle(first))) continue;
        }
        const std::size_t begin = rings.edges.size();
        rings.first.push_back(static_cast<std::uint32_t>(begin));
        if (expansion != nullptr) expansion->first.push_back(static_cast<std::uint32_t>(entered->size()));
        CornerId best = first;
        expander.grow(best, options.k, rings.edges, entered);
        if (options.seeds <= 1 || rings.edges.size() - begin < 4) continue;

        // More seeds, drawn from the triangles beside the first ring; only the best seed is stored and grown again.
        region.assign(rings.edges.begin() + static_cast<std::ptrdiff_t>(begin), rings.edges.end());
        expander.undo(region);
        seeds.assign(1, best);
        while (seeds.size() < options.seeds) {
            const RingEdge& edge = region[random.next() % region.size()];
            CornerId seed = edge.right;
            if (seed.is_null() || random.next() % 2 == 0) seed = edge.left;
            seeds.push_back(expander.can_seed(triangle(seed)) ? seed : best);
        }
        costs.assign(seeds.size(), 0);
        costs[0] = expander.cost(region);
        try_seeds(expander, options, region.size(), seeds, costs);
        best = seeds[static_cast<std::size_t>(std::min_element(costs.begin(), costs.end()) - costs.begin())];
        // `entered` already has the triangles of the first seed.
        const bool enter_again = entered != nullptr && best != first;
        if (enter_again) entered->resize(expansion->first.back());
        region.clear();
        expander.grow(best, options.k, region, enter_again ? entered : nullptr);
        rings.edges.resize(begin);
        rings.edges.insert(rings.edges.end(), region.begin(), region.end());
    }
    rings.first.push_back(static_cast<std::uint32_t>(rings.edges.size()));
    if (expansion != nullptr) expansion->first.push_back(static_cast<std::uint32_t>(entered->size()));
    return rings;
}

std::string check_rings(const CornerTable& table, const Rings& rings) {
    if (rings.first.empty() || rings.first.front() != 0 || rings.first.back() != rings.edges.size()) {
        return "rings do not tile the edges";
    }
    BitVector visited(table.vertex_count);
    for (std::size_t r = 0; r < rings.count(); ++r) {
        if (rings.first[r + 1] < rings.first[r] + 3) return detail::message("ring ", r, " has fewer than three edges");
        const std::span<const RingEdge> ring = rings.ring(r);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const RingEdge &edge = ring[i], &after = ring[i + 1 == ring.size() ? 0 : i + 1];
            if (edge.left.value >= table.corners.size() || table.opposite(edge.left) != edge.right ||
                table.vertex(previous(edge.left)) != edge.start || table.vertex(edge.left) != edge.left_tip ||
                edge.right_tip != (edge.right.is_null() ? kNullVertex : table.vertex(edge.right))) {
                return detail::message("ring ", r, ": edge ", i, " is not the corner table's");
            }
            if (visited.test(edge.start.value))
                return detail::message("vertex ", edge.start.value, " is on a ring twice");
            visited.set(edge.start.value);
            if (table.vertex(next(edge.left)) != after.start) {
                return detail::message("ring ", r, ": edge ", i, " does not continue");
            }
        }
    }
    return {};
}

}  // namespace lacedring
