// Builds LR tables: LR 2011, sections 4.4 to 4.6 and 5. The rings determine every slot. A triangle is irregular if the
// opposite that the operators infer across one of its edges differs from the corner table's. Irregular are the paper's
// Ti, next to a T0, and the rare triangles at an edge that shares both ends with another edge.

#include <algorithm>
#include <memory>

#include "lacedring/lacedring.hpp"
#include "lacedring/operators.hpp"
#include "lacedring/streams.hpp"
#include "lrcore/base/bits.h"
#include "lrcore/base/compiler.h"
#include "lrcore/base/message.h"
#include "lrcore/ring/ring_walk.h"

namespace lacedring {
namespace {

constexpr std::uint32_t kPrefetched = 24;  // distance of the elements prefetched

class Builder {
  public:
    Builder(const CornerTable& table, const Rings& rings, const LrOptions& options)
        : table_(table),
          rings_(rings),
          options_(options),
          rung_(table.triangle_count()),
          number_(table.vertex_count, UINT32_MAX),
          place_(std::make_unique_for_overwrite<std::uint32_t[]>(table.triangle_count())) {}

    Result<LrTable> build(LrMap* map) {
        out_.vertices = table_.vertex_count;
        out_.ring_vertices = static_cast<std::uint32_t>(rings_.edges.size());
        out_.lr.resize(2 * rings_.edges.size());
        first_edge_.reserve(rings_.count());
        for (std::size_t r = 0; r < rings_.count(); ++r) place_ring(rings_.ring(r), rings_.first[r]);
        out_.statistics.t0_wart = static_cast<std::uint32_t>(warts_.size());
        number_t0();
        if (std::uint64_t{8} * out_.ring_vertices + std::uint64_t{4} * t0_.size() > UINT32_MAX) {
            return Error{ErrorCode::too_large, "more corners than 32 bits number"};
        }
        number_isolated();
        // Up to here, words hold the corner table's vertices.
        for (std::size_t i = 0; i < out_.lr.size(); ++i) {
            if (i + kPrefetched < out_.lr.size())
                detail::prefetch(number_.data() + (out_.lr[i + kPrefetched] & word::kTip));
            std::uint32_t& w = out_.lr[i];
            if ((w & word::kKind) != word::kBorder) w = (w & ~word::kTip) | number_[w & word::kTip];
        }
        fill_t0();
        mark_irregular();
        if (!fill_irregular()) return Error{ErrorCode::too_large, "VO* outgrows its 28-bit index"};
        if (map != nullptr) fill(*map);
        return std::move(out_);
    }

  private:
    /// An edge with the first copy of a T2 beside it, and the corner of the T0 that takes that slot, or null.
    struct DeadEnd {
        std::uint32_t edge;
        CornerId wart;
        VertexId tip;  // vertex of `wart`
    };
    /// A slot and its triangle's tip corner in the corner table.
    struct Slot {
        std::uint32_t slot;
        CornerId tip;
    };

    /// Sets the slots of one ring, whose vertices are numbered from `base`. Rotates the ring so that its last edge has
    /// the first copy of a T2 on its left, in a slot that no wart uses: this slot stores the ring's first vertex.
    void place_ring(std::span<const RingEdge> ring, std::uint32_t base) {
        const RingWalk walk(ring);
        const auto size = static_cast<std::uint32_t>(ring.size());
        find_dead_ends(walk);
        const bool t3[2] = {walk.is_t3(0), walk.is_t3(1)};
        for (std::uint32_t side = 0; side < 2 && options_.wart_skipping; ++side) {
            if (!t3[side]) take_warts(walk, side);
        }
        std::vector<DeadEnd>& left = dead_ends_[0];
        auto closing = std::find_if(left.begin(), left.end(), [](const DeadEnd& end) { return end.wart.is_null(); });
        if (closing == left.end()) {  // all dead ends are warts: remove one
            --closing;
            rung_.clear(triangle(closing->wart).value);
            closing->wart = kNullCorner;
        }
        const std::uint32_t last = closing->edge;
        first_edge_.push_back(last + 1 == size ? 0 : last + 1);
        // The next dead end on each side; a sentinel ends each side's list.
        const DeadEnd* dead[2];
        for (std::uint32_t side = 0; side < 2; ++side) {
            dead_ends_[side].push_back({UINT32_MAX, kNullCorner, kNullVertex});
            dead[side] = dead_ends_[side].data();
            while (dead[side]->edge <= last) ++dead[side];
        }
        std::uint32_t i = last;
        for (std::uint32_t v = base; v < base + size; ++v) {
            if (++i == size) {
                i = 0;
                for (std::uint32_t side = 0; side < 2; ++side) dead[side] = dead_ends_[side].data();
            }
            number_[walk.start(i).value] = v;
            for (std::uint32_t side = 0; side < 2; ++side) {
                const std::uint32_t slot = 2 * v + side;
                CornerId c = walk.face(side, i);
                VertexId tip = walk.tip(side, i);
                std::uint32_t flags = 0;
                if (c.is_null()) {
                    out_.lr[slot] = word::kBorder | word::kTip;
                    continue;
                }
                const bool dead_end = i == dead[side]->edge;
                if (dead_end) ++dead[side];
                if (t3[side] ? v != base : dead_end) {
                    if (!t3[side] || v == base + 1) ++out_.statistics.t2;
                    const DeadEnd& end = dead[side][-1];
                    if (end.wart.is_null()) {
                        const std::size_t n = walk.after(i);
                        out_.lr[slot] = i == last && side == 0 ? word::kClosing | walk.start(n).value
                                                               : word::kRedundant | walk.start(walk.after(n)).value;
                        continue;
                    }
                    c = end.wart;
                    tip = end.tip;
                    flags = word::kWart;
                    warts_.push_back({slot, c});
                }
                if (table_.flipped(triangle(c))) flags |= word::kFlip;
                out_.lr[slot] = flags | tip.value;
                place_[triangle(c).value] = 4 * slot + c.value % 3;
            }
        }
    }

    /// Marks the triangles at the ring's edges, and lists those at two ring edges as dead ends.
    void find_dead_ends(const RingWalk& walk) {
        const auto size = static_cast<std::uint32_t>(walk.size());
        for (std::uint32_t side = 0; side < 2; ++side) {
            dead_ends_[side].clear();
            CornerId here = walk.face(side, 0);
            for (std::uint32_t i = 0; i < size; ++i) {
                const CornerId there = walk.face(side, walk.after(i));
                if (!here.is_null()) {
                    rung_.set(triangle(here).value);
                    if (triangle(here) == triangle(there)) dead_ends_[side].push_back({i, kNullCorner, kNullVertex});
                }
                here = there;
            }
        }
    }

    /// Assigns the T0 across to dead ends; a T0 goes to the first dead end beside it.
    void take_warts(const RingWalk& walk, std::uint32_t side) {
        std::vector<DeadEnd>& ends = dead_ends_[side];
        for (std::size_t i = 0; i < ends.size(); ++i) {
            if (i + kPrefetched < ends.size()) fetch(walk.face(side, ends[i + kPrefetched].edge));
            ends[i].wart = walk.across_t2(table_, side, ends[i].edge);
        }
        for (std::size_t i = 0; i < ends.size(); ++i) {
            if (i + kPrefetched < ends.size()) fetch(ends[i + kPrefetched].wart);
            CornerId& wart = ends[i].wart;
            if (wart.is_null()) continue;
            if (rung_.test(triangle(wart).value)) {
                wart = kNullCorner;
                continue;
            }
            rung_.set(triangle(wart).value);
            ends[i].tip = table_.vertex(wart);
        }
    }
    void fetch(CornerId c) const {
        if (!c.is_null()) detail::prefetch(&table_.corners[c.value]);
    }

    /// Numbers the triangles without a slot.
    void number_t0() {
        std::uint32_t number = 2 * out_.ring_vertices;
        for (std::uint32_t t = 0; t < table_.triangle_count(); ++t) {
            if (rung_.test(t) || table_.degenerate(TriangleId{t})) continue;
            t0_.push_back(TriangleId{t});
            place_[t] = 4 * number++;
        }
        out_.statistics.t0 = static_cast<std::uint32_t>(t0_.size());
    }

    /// Numbers the vertices off the rings: first those used by triangles.
    void number_isolated() {
        BitVector used(table_.vertex_count);
        // Tips may be off the rings if the rings were not made by expand_rings.
        for (std::size_t i = 0; i < out_.lr.size() && out_.ring_vertices < table_.vertex_count; ++i) {
            if ((out_.lr[i] & word::kKind) != word::kBorder) used.set(out_.lr[i] & word::kTip);
        }
        for (const TriangleId t : t0_) {
            for (std::uint32_t k = 0; k < 3; ++k) used.set(table_.vertex(corner(t, k)).value);
        }
        std::uint32_t number = out_.ring_vertices;
        for (const bool wanted : {true, false}) {
            for (std::uint32_t v = 0; v < table_.vertex_count && number < table_.vertex_count; ++v) {
                if (number_[v] == UINT32_MAX && used.test(v) == wanted) number_[v] = number++;
            }
            if (wanted) out_.c.assign(number - out_.ring_vertices, UINT32_MAX);
        }
        out_.statistics.isolated = static_cast<std::uint32_t>(out_.c.size());
    }

    void fill_t0() {
        out_.vo.reserve(t0_.size() * 6);
        for (std::size_t i = 0; i < t0_.size(); ++i) {
            for (std::uint32_t k = 0; k < 3 && i + kPrefetched < t0_.size(); ++k) {
                const CornerId c = corner(t0_[i + kPrefetched], k);
                detail::prefetch(&number_[table_.vertex(c).value]);
                fetch_place(table_.opposite(c));
            }
            const TriangleId t = t0_[i];
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::uint32_t v = number_[table_.vertex(corner(t, k)).value];
                out_.vo.push_back(v | (k == 0 && table_.flipped(t) ? word::kT0Flip : 0));
                if (v >= out_.ring_vertices) out_.c[v - out_.ring_vertices] = lr_corner(corner(t, k)).value;
            }
            for (std::uint32_t k = 0; k < 3; ++k) out_.vo.push_back(lr_corner(table_.opposite(corner(t, k))).value);
        }
        for (std::uint32_t i = 0; i < out_.lr.size() && !out_.c.empty(); ++i) {
            const std::uint32_t v = out_.lr[i] & word::kTip;
            if ((out_.lr[i] & word::kKind) == word::kBorder || v < out_.ring_vertices) continue;
            out_.c[v - out_.ring_vertices] = 4 * i + 1;
        }
    }

    /// Sets kIrregular and leaves the tips unchanged.
    void mark_irregular() {
        const auto mark = [&](CornerId c) {
            if (!c.is_null() && c.value < 8 * out_.ring_vertices) out_.lr[c.value / 4] |= word::kIrregular;
        };
        // If no two edges have the same ends, the operators infer all opposites between triangles with ring edges, so
        // only triangles next to a T0 are irregular. Without non-manifold and cut edges this is the case.
        const Topology& topology = table_.topology;
        if (topology.nonmanifold_edges == 0 && topology.cut_edges == 0) {
            for (std::size_t i = 0; i < out_.vo.size(); i += 6) {
                for (std::size_t k = 3; k < 6; ++k) mark(CornerId{out_.vo[i + k]});
            }
            return;
        }
        std::vector<CornerId> irregular;
        const Operators<LrView> ops(out_.view());
        for_slots([](std::uint32_t) { return true; },
                  [&](std::uint32_t slot, CornerId tip) {
                      const CornerId start = start_corner(slot, tip), end = end_corner(slot, tip);
                      if (ops.opposite(lr_corner(start)) != lr_corner(table_.opposite(start)) ||
                          ops.opposite(lr_corner(end)) != lr_corner(table_.opposite(end))) {
                          irregular.push_back(lr_corner(tip));
                      }
                  });
        for (const CornerId c : irregular) mark(c);
    }

    /// Returns false if VO* outgrows its index.
    bool fill_irregular() {
        std::vector<Slot> irregular;
        for_slots([](std::uint32_t w) { return (w & word::kIrregular) != 0; },
                  [&](std::uint32_t slot, CornerId tip) {
                      irregular.push_back({slot, tip});
                  });
        if (irregular.size() * 3 > word::kTip) return false;
        out_.star.reserve(irregular.size() * 3);
        for (std::size_t i = 0; i < irregular.size(); ++i) {
            if (i + kPrefetched < irregular.size()) fetch(irregular[i + kPrefetched].tip);
            const auto [slot, tip] = irregular[i];
            std::uint32_t& w = out_.lr[slot];
            const bool t2 = slot >= 2 && precedes_t2(slot - 2);
            ++(t2 ? out_.statistics.t2_irregular : out_.statistics.t1_irregular);
            out_.star.push_back(w & word::kTip);
            w = (w & ~word::kTip) | static_cast<std::uint32_t>(3 * i);
            out_.star.push_back(table_.opposite(start_corner(slot, tip)).value);
            out_.star.push_back(table_.opposite(end_corner(slot, tip)).value);
        }
        // Up to here, VO* holds corners of the corner table.
        for (std::size_t i = 0; i < out_.star.size(); i += 3) {
            for (const std::size_t k : {i + 1, i + 2}) {
                if (k + kPrefetched < out_.star.size()) fetch_place(CornerId{out_.star[k + kPrefetched]});
                out_.star[k] = lr_corner(CornerId{out_.star[k]}).value;
            }
        }
        return true;
    }
    void fetch_place(CornerId c) const {
        if (!c.is_null()) detail::prefetch(&place_[triangle(c).value]);
    }
    bool precedes_t2(std::uint32_t slot) const {
        const std::uint32_t kind = out_.lr[slot] & word::kKind;
        return (kind & word::kWart) != 0 || kind == word::kRedundant;
    }

    /// Calls visit(slot, tip corner in the corner table) in order for every slot that has its own triangle and for
    /// whose word wanted(word) is true.
    template <class Wanted, class Visit>
    void for_slots(Wanted wanted, Visit visit) const {
        auto wart = warts_.begin();
        for (std::size_t r = 0; r < rings_.count(); ++r) {
            const RingWalk walk(rings_.ring(r));
            std::size_t i = first_edge_[r];
            for (std::uint32_t slot = 2 * rings_.first[r]; slot < 2 * rings_.first[r + 1]; ++slot) {
                const std::uint32_t w = out_.lr[slot];
                const bool own = (w & word::kSpecial) == 0, is_wart = own && (w & word::kWart) != 0;
                if (own && wanted(w)) visit(slot, is_wart ? wart->tip : walk.face(slot % 2, i));
                if (is_wart) ++wart;
                if (slot % 2 == 1) i = walk.after(i);
            }
        }
    }
    static CornerId start_corner(std::uint32_t slot, CornerId tip) { return slot % 2 == 0 ? previous(tip) : next(tip); }
    static CornerId end_corner(std::uint32_t slot, CornerId tip) { return slot % 2 == 0 ? next(tip) : previous(tip); }

    /// The LR number of a corner of the corner table.
    CornerId lr_corner(CornerId c) const {
        if (c.is_null()) return c;
        const std::uint32_t place = place_[triangle(c).value], first = place & ~3U;
        if (first >= 8 * out_.ring_vertices) return CornerId{first + c.value % 3};
        const CornerId tip{c.value - c.value % 3 + place % 4};
        // The corner after the tip is the end on the left (8v+2) and the start on the right (8v+6).
        return CornerId{first + (c == tip ? 1U : c == next(tip) ? 2U : 0U)};
    }

    void fill(LrMap& map) const {
        map.vertex.resize(out_.vertices);
        for (std::uint32_t v = 0; v < out_.vertices; ++v) map.vertex[number_[v]] = VertexId{v};
        const std::uint32_t slots = 2 * out_.ring_vertices;
        map.triangle.assign(slots + t0_.size(), kNullTriangle);
        map.start.assign(map.triangle.size(), 0);
        for_slots([](std::uint32_t) { return true; },
                  [&](std::uint32_t slot, CornerId tip) {
                      map.triangle[slot] = triangle(tip);
                      map.start[slot] = previous(tip).value % 3;  // corner 4t precedes the tip
                  });
        std::copy(t0_.begin(), t0_.end(), map.triangle.begin() + slots);
    }

    const CornerTable& table_;
    const Rings& rings_;
    const LrOptions& options_;
    BitVector rung_;                     // triangles with a ring edge or in a wart
    std::vector<std::uint32_t> number_;  // LR number of each vertex
    // Per triangle: 4 slot + tip corner % 3, or 4 (2 m_r + i) for T0 i.
    std::unique_ptr<std::uint32_t[]> place_;
    std::vector<std::uint32_t> first_edge_;  // per ring: the edge at its first vertex
    std::vector<DeadEnd> dead_ends_[2];      // dead ends of the current ring, left and right
    std::vector<TriangleId> t0_;
    std::vector<Slot> warts_;  // in order
    LrTable out_;
};

}  // namespace

Result<LrTable> build_lr(const CornerTable& table, const Rings& rings, const LrOptions& options, LrMap* map) {
    if (table.vertex_count >= word::kTip) {
        return Error{ErrorCode::too_large,
                     detail::message(table.vertex_count, " vertices; LR tables number at most ", word::kTip - 1)};
    }
    return Builder(table, rings, options).build(map);
}

}  // namespace lacedring
