// The state of a triangle is a byte: its corner at the vertex that owns it, and the side of that corner on which the
// vertex owns a second triangle. So each step needs only a few look-ups.

#include "lrlab/rivals/squad_match.h"

#include <utility>

#include "lrcore/base/bits.h"

namespace lacedring {
namespace {

// The state of a triangle.
constexpr std::uint8_t kOwner = 3;      // mask: the index of its corner at the owner, or kFree
constexpr std::uint8_t kFree = 3;       // no vertex owns it
constexpr std::uint8_t kPairSwing = 4;  // its owner also owns the triangle of that corner's swing
constexpr std::uint8_t kPairBack = 8;   // its owner also owns the triangle of that corner's swing_back
constexpr std::uint8_t kPaired = kPairSwing | kPairBack;
constexpr std::uint8_t kSeen = 16;   // visited by the walk
constexpr std::uint8_t kExtra = 32;  // free, and in a record

class Matcher {
  public:
    explicit Matcher(const CornerTable& table)
        : table_(table), state_(table.triangle_count(), kFree), known_(table.vertex_count) {}

    SquadMatching match(bool renumber, std::uint32_t reach) {
        walk();
        for (const CornerId seed : seeds_) own_one(seed);
        pair();
        for (std::uint32_t t = 0; t < table_.triangle_count(); ++t) {
            if (!free(CornerId{3 * t}) && (state_[t] & kPaired) == 0) extend(owner_corner(CornerId{3 * t}), reach);
        }
        add_matched(renumber);
        add_extras(renumber);
        return std::move(out_);
    }

  private:
    /// A vertex on an alternating path.
    struct Step {
        CornerId kept;       // the vertex's corner in its triangle; in extend(), in the triangle that it keeps
        CornerId taken;      // in the triangle that it gives up: the corner at the previous step's vertex
        std::size_t before;  // index of the previous step
    };

    std::uint8_t& state(CornerId c) { return state_[triangle(c).value]; }
    bool free(CornerId c) const { return (state_[triangle(c).value] & kOwner) == kFree; }
    /// The corner at the vertex that owns c's triangle.
    CornerId owner_corner(CornerId c) const { return corner(triangle(c), state_[triangle(c).value] & kOwner); }
    void own(CornerId c) { state(c) = static_cast<std::uint8_t>((state(c) & ~kOwner) | c.value % 3); }

    void walk() {
        order_.reserve(table_.vertex_count);
        for (std::uint32_t t = 0; t < table_.triangle_count(); ++t) {
            if ((state_[t] & kSeen) != 0 || table_.degenerate(TriangleId{t})) continue;
            const CornerId seed = corner(TriangleId{t}, 0);
            for (const CornerId c : {next(seed), previous(seed)}) {  // no triangle is entered for these two vertices
                known_.set(table_.vertex(c).value);
                seeds_.push_back(c);
                order_.push_back(table_.vertex(c));
            }
            later_.push_back(table_.opposite(seed));
            stack_.push_back(seed);
            while (true) {
                if (!stack_.empty()) {
                    enter(take(stack_));
                } else if (!later_.empty()) {
                    enter(take(later_));
                } else {
                    break;
                }
            }
        }
    }
    static CornerId take(std::vector<CornerId>& stack) {
        const CornerId c = stack.back();
        stack.pop_back();
        return c;
    }
    /// Visits the triangle of c, which is entered across the edge opposite to c. The walk continues to the right first.
    /// If the tip is known already, its neighbors are deferred until the walk would end: their new vertices are like
    /// the isolated vertices of rings.
    void enter(CornerId c) {
        if (c.is_null() || (state(c) & kSeen) != 0) return;
        state(c) |= kSeen;
        const VertexId tip = table_.vertex(c);
        const bool is_new = !known_.test(tip.value);
        if (is_new) {
            known_.set(tip.value);
            order_.push_back(tip);
            own(c);
        }
        std::vector<CornerId>& stack = is_new ? stack_ : later_;
        stack.push_back(table_.left(c));
        stack.push_back(table_.right(c));
    }

    /// Gives the vertex of `seed` a triangle: a free one, preferably next to another free one; else one whose owner can
    /// take another triangle, found by breadth-first search over the owners. Succeeds if any solution exists.
    void own_one(CornerId seed) {
        std::vector<Step>& steps = steps_;
        steps.assign(1, {seed, kNullCorner, 0});
        known_.clear(table_.vertex(seed).value);
        for (std::size_t i = 0; i < steps.size(); ++i) {
            CornerId best = kNullCorner;
            table_.around(steps[i].kept, [&](CornerId c) {
                if (!free(c)) return false;
                const CornerId s = table_.swing(c);
                const bool pair = !s.is_null() && free(s);
                if (best.is_null() || pair) best = c;
                return pair;
            });
            if (!best.is_null()) {
                own(best);
                for (; i != 0; i = steps[i].before) own(steps[i].taken);
                break;
            }
            table_.around(steps[i].kept, [&](CornerId c) {
                const CornerId owner = owner_corner(c);
                const std::uint32_t w = table_.vertex(owner).value;
                if (known_.test(w)) {
                    known_.clear(w);
                    steps.push_back({owner, c, i});
                }
                return false;
            });
        }
        for (const Step& step : steps) known_.set(table_.vertex(step.kept).value);
    }

    /// Calls visit(c) for each neighbor with which the triangle may be paired; c is the neighbor's corner opposite to
    /// the shared edge. An owned triangle is paired with a free one across an edge at its owner.
    template <class Visit>
    void choices(TriangleId t, Visit visit) const {
        const std::uint8_t mine = state_[t.value];
        if ((mine & kPaired) != 0) return;
        for (std::uint32_t i = 0; i < 3; ++i) {
            if ((mine & kOwner) == i) continue;
            const CornerId c = table_.opposite(corner(t, i));
            if (c.is_null()) continue;
            const std::uint8_t theirs = state_[triangle(c).value];
            if ((theirs & kPaired) != 0 || ((mine & kOwner) == kFree) == ((theirs & kOwner) == kFree)) continue;
            if ((theirs & kOwner) == c.value % 3) continue;
            visit(c);
        }
    }
    /// Pairs the triangle if it has only one choice, or, without `forced_only`, any choice; then makes all pairs that
    /// become forced.
    void settle(TriangleId t, bool forced_only) {
        forced_.push_back(t);
        while (!forced_.empty()) {
            const TriangleId a = forced_.back();
            forced_.pop_back();
            CornerId c = kNullCorner;
            std::uint32_t count = 0;
            choices(a, [&](CornerId x) {
                c = x;
                ++count;
            });
            if (count == 0 || (count > 1 && forced_only)) continue;
            forced_only = true;
            const CornerId facing = table_.opposite(c);
            // The corner opposite to the shared edge in the owned triangle.
            const CornerId owned = (state_[a.value] & kOwner) == kFree ? c : facing;
            const CornerId at = owner_corner(owned);
            join(at, owned == next(at) ? table_.swing(at) : table_.swing_back(at));
            for (const TriangleId x : {a, triangle(c)}) {
                for (std::uint32_t i = 0; i < 3; ++i) {
                    const CornerId o = table_.opposite(corner(x, i));
                    if (!o.is_null() && (state(o) & kPaired) == 0) forced_.push_back(triangle(o));
                }
            }
        }
    }
    /// Gives the triangles of a and b to their common vertex; one corner is the other's swing.
    void join(CornerId a, CornerId b) {
        if (table_.swing(a) != b) std::swap(a, b);
        own(a);
        own(b);
        state(a) = static_cast<std::uint8_t>((state(a) & ~kPaired) | kPairSwing);
        state(b) = static_cast<std::uint8_t>((state(b) & ~kPaired) | kPairBack);
    }
    void pair() {
        for (const bool forced_only : {true, false}) {
            for (std::uint32_t t = 0; t < table_.triangle_count(); ++t) settle(TriangleId{t}, forced_only);
        }
    }

    /// Gives the owner of c's triangle a second triangle, a neighbor of the first. If it has an owner, that vertex
    /// keeps its other triangle and takes a neighbor of it, and so on to a free triangle. Breadth-first search from at
    /// most `reach` vertices.
    void extend(CornerId c, std::uint32_t reach) {
        std::vector<Step>& steps = steps_;
        steps.assign(1, {c, kNullCorner, 0});
        known_.clear(table_.vertex(c).value);
        const auto look = [&](std::size_t i, CornerId x) {
            if (x.is_null()) return false;
            if (free(x)) {
                for (;; x = steps[i].taken, i = steps[i].before) {
                    join(steps[i].kept, x);
                    if (i == 0) return true;
                }
            }
            const CornerId other = owner_corner(x);
            const std::uint8_t s = state(x);
            const std::uint32_t w = table_.vertex(other).value;
            if ((s & kPaired) == 0 || !known_.test(w)) return false;
            known_.clear(w);
            steps.push_back({(s & kPairSwing) != 0 ? table_.swing(other) : table_.swing_back(other), x, i});
            return false;
        };
        for (std::size_t i = 0; i < steps.size() && i < reach; ++i) {
            if (look(i, table_.swing(steps[i].kept)) || look(i, table_.swing_back(steps[i].kept))) break;
        }
        for (const Step& step : steps) known_.set(table_.vertex(step.kept).value);
    }

    void add_matched(bool renumber) {
        std::vector<CornerId> corner_of(table_.vertex_count, kNullCorner);
        for (std::uint32_t t = 0; t < table_.triangle_count(); ++t) {
            if (free(CornerId{3 * t}) || (state_[t] & kPairBack) != 0) continue;
            const CornerId c = owner_corner(CornerId{3 * t});
            corner_of[table_.vertex(c).value] = c;
        }
        if (!renumber) {
            order_.clear();
            for (std::uint32_t v = 0; v < table_.vertex_count; ++v) {
                if (known_.test(v)) order_.push_back(VertexId{v});
            }
        }
        out_.records.reserve(order_.size());
        for (const VertexId v : order_) {
            const CornerId c = corner_of[v.value];
            if (c.is_null()) {
                out_.unmatched.push_back(v);
            } else {
                out_.records.push_back({c, (state(c) & kPaired) != 0});
            }
        }
        out_.matched = static_cast<std::uint32_t>(out_.records.size());
    }

    /// Adds records for the free triangles; with `renumber`, in the order of adjacent records.
    void add_extras(bool renumber) {
        for (std::uint32_t r = 0; renumber && r < out_.matched; ++r) {
            const auto [a, quad] = out_.records[r];
            add_extra_around(triangle(a));
            if (quad) add_extra_around(triangle(table_.swing(a)));
        }
        for (std::uint32_t t = 0; t < table_.triangle_count(); ++t) {
            if ((state_[t] & kSeen) != 0) add_extra(TriangleId{t});
        }
    }
    void add_extra_around(TriangleId t) {
        for (std::uint32_t i = 0; i < 3; ++i) {
            const CornerId o = table_.opposite(corner(t, i));
            if (!o.is_null()) add_extra(triangle(o));
        }
    }
    /// If the triangle is free, makes a record of it and of a free neighbor if there is one.
    void add_extra(TriangleId t) {
        const auto wanted = [&](CornerId c) { return free(c) && (state(c) & kExtra) == 0; };
        if (!wanted(corner(t, 0))) return;
        state_[t.value] |= kExtra;
        SquadRecord record{corner(t, 0), false};
        for (std::uint32_t i = 0; i < 3 && !record.quad; ++i) {
            const CornerId c = corner(t, i), o = table_.opposite(c);
            if (o.is_null() || !wanted(o)) continue;
            state(o) |= kExtra;
            record = {previous(c), true};
        }
        out_.records.push_back(record);
    }

    const CornerTable& table_;
    std::vector<std::uint8_t> state_;  // state of each triangle
    BitVector known_;                  // vertices met by the walk; searches clear visited ones temporarily
    std::vector<VertexId> order_;      // the vertices in the order of the walk
    std::vector<CornerId> seeds_;      // a corner of each vertex to which the walk gave no triangle
    std::vector<CornerId> stack_, later_;
    SquadMatching out_;
    // Reused memory of searches.
    std::vector<TriangleId> forced_;
    std::vector<Step> steps_;
};

}  // namespace

SquadMatching match_squad(const CornerTable& table, bool renumber, std::uint32_t reach) {
    return Matcher(table).match(renumber, reach);
}

}  // namespace lacedring
