// LR 2011, sections 4.4 to 4.6 and 5. The ring decides every slot; a triangle is irregular where what the operators
// infer across an edge is not what the corner table says. That is the paper's Ti, next to a T0, and also the rare
// triangle at an edge that shares both its ends with another.

#include <fmt/format.h>

#include <algorithm>

#include "lrcore/base/bits.h"
#include "lrcore/lr/lr_table.h"
#include "lrcore/lr/operators.h"
#include "lrcore/ring/ring_walk.h"

namespace lr {
namespace {

constexpr std::uint32_t kAhead = 24;  // slots for which memory is fetched before their turn

class Builder {
  public:
    Builder(const CornerTable& table, const Rings& rings, const LrOptions& options)
        : table_(table), rings_(rings), options_(options), rung_(table.triangle_count()) {}

    LrTable build(LrMap* map) {
        out_.vertices = table_.vertex_count;
        out_.ring_vertices = static_cast<std::uint32_t>(rings_.edges.size());
        number_.assign(table_.vertex_count, UINT32_MAX);
        number_of_triangle_.assign(table_.triangle_count(), UINT32_MAX);
        tip_corner_.assign(2 * rings_.edges.size(), null_corner);
        out_.lr.resize(2 * rings_.edges.size());
        for (const RingEdge& edge : rings_.edges) {
            rung_.set(triangle(edge.left).value);
            if (!edge.right.is_null()) rung_.set(triangle(edge.right).value);
        }
        for (std::size_t r = 0; r < rings_.count(); ++r) place_ring(rings_.ring(r), rings_.first[r]);
        out_.statistics.t0_wart = static_cast<std::uint32_t>(wart_slots_.size());
        number_t0();
        number_isolated();
        // Until now words hold the corner table's vertices.
        for (std::size_t i = 0; i < out_.lr.size(); ++i) {
            if (i + kAhead < out_.lr.size()) __builtin_prefetch(number_.data() + (out_.lr[i + kAhead] & word::kTip));
            std::uint32_t& w = out_.lr[i];
            if ((w & word::kKind) != word::kBorder) w = (w & ~word::kTip) | number_[w & word::kTip];
        }
        fill_t0();
        find_irregular();
        if (map != nullptr) fill(*map);
        return std::move(out_);
    }

  private:
    /// Sets the slots of one ring, whose vertices are numbered from `base`. The ring is turned so that its last edge
    /// has the first copy of a T2 on its left, which no wart takes: that slot holds the ring's first vertex.
    void place_ring(std::span<const RingEdge> ring, std::uint32_t base) {
        const RingWalk walk(ring);
        const std::size_t size = walk.size();
        wart_[0].assign(size, null_corner);
        wart_[1].assign(size, null_corner);
        for (std::uint32_t side = 0; side < 2 && options_.wart_skipping; ++side) {
            for (std::size_t i = 0; i < size; ++i) {
                if (!walk.repeats(side, i) || walk.is_t3(side)) continue;
                const CornerId y = walk.across_t2(table_, side, i);
                if (y.is_null() || rung_.test(triangle(y).value)) continue;
                rung_.set(triangle(y).value);
                wart_[side][i] = y;
            }
        }
        std::size_t closing = size;
        for (std::size_t i = 0; i < size; ++i) {
            if (!walk.repeats(0, i)) continue;
            if (closing == size || !wart_[0][closing].is_null()) closing = i;
            if (wart_[0][i].is_null()) break;
        }
        if (CornerId& wart = wart_[0][closing]; !wart.is_null()) {  // every dead end is a wart: give one up
            rung_.clear(triangle(wart).value);
            wart = null_corner;
        }
        const bool t3[2] = {walk.is_t3(0), walk.is_t3(1)};
        std::uint32_t v = base;
        std::size_t i = closing;
        do {
            i = walk.after(i);
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
                if (t3[side] ? v != base : walk.repeats(side, i)) {
                    if (!t3[side] || v == base + 1) ++out_.statistics.t2;
                    if (wart_[side][i].is_null()) {
                        const std::size_t after = walk.after(walk.after(i));
                        out_.lr[slot] = i == closing && side == 0 ? word::kClosing | walk.start(walk.after(i)).value
                                                                  : word::kRedundant | walk.start(after).value;
                        continue;
                    }
                    c = wart_[side][i];
                    tip = table_.vertex(c);
                    flags = word::kWart;
                    wart_slots_.push_back(slot);
                }
                if (table_.flipped(triangle(c))) flags |= word::kFlip;
                out_.lr[slot] = flags | tip.value;
                tip_corner_[slot] = c;
                number_of_triangle_[triangle(c).value] = slot;
            }
            ++v;
        } while (i != closing);
    }

    /// Numbers the triangles without a slot.
    void number_t0() {
        std::uint32_t number = 2 * out_.ring_vertices;
        for (std::uint32_t t = 0; t < table_.triangle_count(); ++t) {
            if (number_of_triangle_[t] != UINT32_MAX || table_.degenerate({t})) continue;
            t0_.push_back({t});
            number_of_triangle_[t] = number++;
        }
        out_.statistics.t0 = static_cast<std::uint32_t>(t0_.size());
    }

    /// Numbers the vertices off the rings: those of triangles first. All triangles of such a vertex are T0, in warts or
    /// not.
    void number_isolated() {
        std::vector<bool> used(table_.vertex_count, false);
        for (const TriangleId t : t0_) {
            for (std::uint32_t k = 0; k < 3; ++k) used[table_.vertex(corner(t, k)).value] = true;
        }
        for (const std::uint32_t slot : wart_slots_) used[out_.lr[slot] & word::kTip] = true;
        std::uint32_t next_number = out_.ring_vertices;
        for (const bool wanted : {true, false}) {
            for (std::uint32_t v = 0; v < table_.vertex_count; ++v) {
                if (number_[v] == UINT32_MAX && used[v] == wanted) number_[v] = next_number++;
            }
            if (wanted) out_.c.assign(next_number - out_.ring_vertices, UINT32_MAX);
        }
        out_.statistics.isolated = static_cast<std::uint32_t>(out_.c.size());
    }

    void fill_t0() {
        out_.vo.reserve(t0_.size() * 6);
        for (const TriangleId t : t0_) {
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::uint32_t v = number_[table_.vertex(corner(t, k)).value];
                out_.vo.push_back(v | (k == 0 && table_.flipped(t) ? word::kT0Flip : 0));
                if (v >= out_.ring_vertices) out_.c[v - out_.ring_vertices] = lr_corner(corner(t, k)).value;
            }
            for (std::uint32_t k = 0; k < 3; ++k) out_.vo.push_back(lr_corner(table_.opposite(corner(t, k))).value);
        }
        for (const std::uint32_t slot : wart_slots_) {
            const std::uint32_t v = out_.lr[slot] & word::kTip;
            if (v >= out_.ring_vertices) out_.c[v - out_.ring_vertices] = lr_corner(tip_corner_[slot]).value;
        }
    }

    void find_irregular() {
        std::vector<std::uint32_t> irregular;
        {
            const LrOperators<LrView> ops(out_.view());
            for (std::uint32_t slot = 0; slot < out_.lr.size(); ++slot) {
                if (slot + kAhead < out_.lr.size() && !tip_corner_[slot + kAhead].is_null()) {
                    __builtin_prefetch(&table_.corners[tip_corner_[slot + kAhead].value]);
                }
                const CornerId c = tip_corner_[slot];
                if (c.is_null()) continue;
                const std::uint32_t v = slot / 2, side = slot % 2;
                const CornerId start{8 * v + (side == 0 ? 0 : 6)}, end{8 * v + (side == 0 ? 2 : 4)};
                if (table_corner(ops.opposite(start)) != table_.opposite(side == 0 ? previous(c) : next(c)) ||
                    table_corner(ops.opposite(end)) != table_.opposite(side == 0 ? next(c) : previous(c))) {
                    irregular.push_back(slot);
                }
            }
        }
        out_.star.reserve(irregular.size() * 3);
        for (const std::uint32_t slot : irregular) {
            const CornerId c = tip_corner_[slot];
            const std::uint32_t w = out_.lr[slot];
            const bool t2 = slot >= 2 && precedes_t2(slot - 2);
            ++(t2 ? out_.statistics.t2_irregular : out_.statistics.t1_irregular);
            out_.lr[slot] = (w & ~word::kTip) | word::kIrregular | static_cast<std::uint32_t>(out_.star.size());
            out_.star.push_back(w & word::kTip);
            out_.star.push_back(lr_corner(table_.opposite(slot % 2 == 0 ? previous(c) : next(c))).value);
            out_.star.push_back(lr_corner(table_.opposite(slot % 2 == 0 ? next(c) : previous(c))).value);
        }
    }
    bool precedes_t2(std::uint32_t slot) const {
        const std::uint32_t kind = out_.lr[slot] & word::kKind;
        return (kind & word::kWart) != 0 || kind == word::kRedundant;
    }

    /// The LR number of a corner of the corner table.
    CornerId lr_corner(CornerId c) const {
        if (c.is_null()) return c;
        const std::uint32_t t = number_of_triangle_[triangle(c).value];
        if (t >= 2 * out_.ring_vertices) return {4 * t + c.value % 3};
        const CornerId tip = tip_corner_[t];
        if (c == tip) return {4 * t + 1};
        const bool after_tip = c == next(tip);
        // After the tip comes the end on the left (8v+2), the start on the right (8v+6).
        return {4 * t + (after_tip ? 2U : 0U)};
    }

    /// The corner table's number of a canonical ring corner.
    CornerId table_corner(CornerId c) const {
        if (c.is_null()) return c;
        const CornerId tip = tip_corner_[c.value / 4];
        const std::uint32_t k = c.value % 4;
        return k == 1 ? tip : k == 0 ? previous(tip) : next(tip);
    }

    void fill(LrMap& map) const {
        map.vertex.resize(out_.vertices);
        for (std::uint32_t v = 0; v < out_.vertices; ++v) map.vertex[number_[v]] = {v};
        map.triangle.assign(2 * out_.ring_vertices + t0_.size(), null_triangle);
        map.start.assign(map.triangle.size(), 0);
        for (std::uint32_t slot = 0; slot < tip_corner_.size(); ++slot) {
            if (tip_corner_[slot].is_null()) continue;
            map.triangle[slot] = triangle(tip_corner_[slot]);
            map.start[slot] = previous(tip_corner_[slot]).value % 3;  // corner 4t is the one before the tip
        }
        std::copy(t0_.begin(), t0_.end(), map.triangle.begin() + static_cast<std::ptrdiff_t>(tip_corner_.size()));
    }

    const CornerTable& table_;
    const Rings& rings_;
    const LrOptions& options_;
    BitVector rung_;                                 // triangles with a ring edge, or taken by a wart
    std::vector<std::uint32_t> number_;              // LR number of each vertex
    std::vector<std::uint32_t> number_of_triangle_;  // LR number of each triangle: its slot, or 2 m_r + i for T0 i
    std::vector<CornerId> tip_corner_;               // of each slot, null where it has no triangle of its own
    std::vector<CornerId> wart_[2];  // of one ring: the T0's corner across the T2 whose first copy is here
    std::vector<TriangleId> t0_;
    std::vector<std::uint32_t> wart_slots_;
    LrTable out_;
};

}  // namespace

Result<LrTable> build_lr(const CornerTable& table, const Rings& rings, const LrOptions& options, LrMap* map) {
    if (table.vertex_count >= word::kTip) {
        return Error{ErrorCode::too_large,
                     fmt::format("{} vertices; LR tables number at most {}", table.vertex_count, word::kTip - 1)};
    }
    LrTable out = Builder(table, rings, options).build(map);
    if (std::uint64_t{8} * out.ring_vertices + std::uint64_t{4} * (out.vo.size() / 6) > UINT32_MAX) {
        return Error{ErrorCode::too_large, "more corners than 32 bits number"};
    }
    if (out.star.size() > word::kTip) return Error{ErrorCode::too_large, "VO* outgrows its 28-bit index"};
    return out;
}

}  // namespace lr
