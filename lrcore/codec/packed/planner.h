#pragma once
// Turns the steps of a walk into turn bits, events and warts. The planner tracks the state of a reader of the record,
// and emits an event when the next triangle does not follow from this state.

#include <algorithm>
#include <array>
#include <bit>
#include <optional>

#include "lrcore/codec/bit_writer.h"
#include "lrcore/codec/packed/corridors.h"
#include "lrcore/codec/packed/packed_format.h"
#include "lrcore/codec/packed/record_plan.h"

namespace lacedring {

/// Steps of walk_corridors or walk_pieces, with the stream's numbers of vertices.
class CorridorSteps {
  public:
    CorridorSteps(const CornerTable& table, const Corridors& corridors)
        : table_(table), corridors_(corridors), number_(table.vertex_count), step_(table.triangle_count(), UINT32_MAX) {
        for (std::uint32_t v = 0; v < table.vertex_count; ++v) number_[corridors.vertex_order[v]] = v;
        for (std::uint32_t i = 0; i < size(); ++i) step_[triangle(corridors.corners[i]).value] = i;
    }

    std::uint32_t size() const { return static_cast<std::uint32_t>(corridors_.corners.size()); }
    std::uint8_t flags(std::uint32_t i) const { return corridors_.flags[i]; }  ///< flags of CorridorStep
    bool on_right(std::uint32_t i) const { return (flags(i) & CorridorStep::kRight) != 0; }
    bool flipped(std::uint32_t i) const { return table_.flipped(triangle(corridors_.corners[i])); }
    PackedEdge edge(std::uint32_t i) const { return {number(facing(i, true)), number(facing(i, false))}; }
    std::uint32_t third(std::uint32_t i) const { return number(corridors_.corners[i]); }

    /// The later step that enters the neighbor of triangle i across its edge (a, x) if the argument `a` is true, else
    /// across (x, b). UINT32_MAX if there is none.
    std::uint32_t across(std::uint32_t i, bool a) const {
        const CornerId o = table_.opposite(facing(i, !a));
        if (o.is_null()) return UINT32_MAX;
        const std::uint32_t step = step_[triangle(o).value];
        return step != UINT32_MAX && step > i && corridors_.corners[step] == o ? step : UINT32_MAX;
    }

  private:
    std::uint32_t number(CornerId c) const { return number_[table_.vertex(c).value]; }
    CornerId facing(std::uint32_t i, bool a) const {  // the corner at vertex a if `a`, else at b
        const CornerId c = corridors_.corners[i];
        return on_right(i) == a ? previous(c) : next(c);
    }

    const CornerTable& table_;
    const Corridors& corridors_;
    std::vector<std::uint32_t> number_, step_;
};

/// Turns steps into records and sets their turn bits. Steps has the functions of CorridorSteps.
template <class Steps>
class Planner {
    using Edge = PackedEdge;
    // Estimate: a group's order depends on its events.
    static constexpr std::uint32_t kSplitOrder = 2;

  public:
    Planner(const Steps& steps, std::uint32_t vertex_bits, std::uint32_t* turns)
        : steps_(steps), vertex_bits_(vertex_bits), turns_(turns) {}

    /// Plans the record of triangles [first, end) and sets their turn bits. `reversed`: the reader's initial
    /// orientation, if it is stored outside the record.
    PackedRecordPlan plan(std::uint32_t first, std::uint32_t end, std::optional<bool> reversed = {}) {
        bitmap_ = false;
        base_ = false;
        PackedRecordPlan out = attempt(first, end, reversed.value_or(comes_reversed(first)));
        constexpr std::uint32_t kTurnBits = 11;  // approximate bits of a TURN event
        const auto turned = std::count_if(out.events.begin(), out.events.end(),
                                          [](const PackedEvent& e) { return e.code == LR_PACKED_TURN; });
        if (static_cast<std::uint32_t>(turned) * kTurnBits <= end - first + kTurnBits) return out;
        // Keeps the base of the previous bitmap, so that a block can continue from the previous block.
        bitmap_ = true;
        base_ = reversed ? *reversed != on_right(first) : last_base_;
        last_base_ = base_;
        return attempt(first, end, on_right(first) != base_);
    }

    void clear_turns(std::uint32_t first, std::uint32_t end) {
        for (std::uint32_t i = first; i < end; ++i) turns_[i / 32] &= ~(1U << (i % 32));
    }

    Edge edge(std::uint32_t i) const { return steps_.edge(i); }
    std::uint32_t third(std::uint32_t i) const { return steps_.third(i); }
    /// Is the triangle decoded as (a, x, b), not (a, b, x)?
    bool comes_reversed(std::uint32_t i) const { return on_right(i) != flipped(i); }

  private:
    struct Scope {
        std::uint32_t end;
        Edge edge;
        bool reversed;
    };

    PackedRecordPlan attempt(std::uint32_t first, std::uint32_t end, bool begins_reversed) {
        clear_turns(first, end);
        PackedRecordPlan out;
        out_ = &out;
        first_ = first;
        end_ = end;
        out.first = first;
        out.triangles = end - first;
        out.entry = now_ = begun_ = edge(first);
        out.reversed = reversed_ = begun_reversed_ = begins_reversed;
        finished_ = false;
        scopes_.clear();
        warts_.clear();
        if (bitmap_) {
            event(first, LR_PACKED_FLIPS);
            for (std::uint32_t i = first; i < end; ++i) {
                if (flipped(i) != base_) out.flips[(i - first) / 32] |= 1U << ((i - first) % 32);
            }
        }
        for (std::uint32_t i = first; i < end; i += write_triangle(i)) {
            if (i != first) enter(i);
            if (reversed_ == reversed(i)) continue;
            event(i, LR_PACKED_TURN);
            reversed_ = !reversed_;
        }
        write_warts();
        return out;
    }

    std::uint8_t flags(std::uint32_t i) const { return steps_.flags(i); }
    bool on_right(std::uint32_t i) const { return steps_.on_right(i); }
    bool flipped(std::uint32_t i) const { return steps_.flipped(i); }
    /// The orientation that events must store; it includes flips unless a bitmap stores these.
    bool reversed(std::uint32_t i) const { return on_right(i) != (bitmap_ ? base_ : flipped(i)); }
    bool turn(std::uint32_t i) const { return (turns_[i / 32] >> (i % 32) & 1) != 0; }
    void set_turn(std::uint32_t i, bool bit) { turns_[i / 32] |= (bit ? 1U : 0U) << (i % 32); }

    PackedEvent& event(std::uint32_t i, std::uint32_t code) {
        out_->events.push_back(
            {static_cast<std::uint8_t>(i - first_), static_cast<std::uint8_t>(code), 0, false, 0, 0});
        return out_->events.back();
    }

    /// Sets (a, b) to the entry edge of triangle i.
    void enter(std::uint32_t i) {
        while (!scopes_.empty() && scopes_.back().end == i) {
            now_ = scopes_.back().edge;
            reversed_ = scopes_.back().reversed;
            finished_ = false;
            scopes_.pop_back();
        }
        const Edge wanted = edge(i);
        if (!finished_) {
            if (!(now_ == wanted)) start(i, wanted);
        } else if (const Edge behind{begun_.b + 1, begun_.b + 1 + (begun_.b - begun_.a)};
                   scopes_.empty() && behind == wanted) {
            begun_ = wanted;
        } else {
            start(i, wanted);
        }
        now_ = wanted;
        finished_ = false;
    }

    /// Starts another corridor, with the event of the fewest bits.
    void start(std::uint32_t i, Edge wanted) {
        constexpr std::uint32_t kNever = UINT32_MAX;
        const auto golomb = BitWriter::golomb_bits;
        const bool r = reversed(i), ascends = wanted.b >= wanted.a + 2;
        const std::uint32_t size = wanted.b - wanted.a - 2, step = wanted.a - begun_.b;
        const std::array<std::uint32_t, 4> starts{
            wanted == begun_ && r != begun_reversed_ ? 4 : kNever,
            step == 1 && ascends && !r ? 5 + golomb(size, LR_PACKED_SIZE_ORDER) : kNever,
            wanted.a >= begun_.b && ascends && r == begun_reversed_
                ? 6 + golomb(step, LR_PACKED_SIZE_ORDER) + golomb(size, LR_PACKED_SIZE_ORDER)
                : kNever,
            6 + 2 * vertex_bits_ + 1,
        };
        // In the order of LR_PACKED_BESIDE_*. Signs are folded: n >= 0 to 2n, n < 0 to -2n - 1.
        std::array<std::uint32_t, 4> beside{wanted.a - now_.b, wanted.b - now_.a, wanted.a - begun_.a,
                                            wanted.b - begun_.b};
        for (std::uint32_t& s : beside) s = s >> 31 != 0 ? ~s << 1 | 1 : s << 1;
        const auto nearest = std::min_element(beside.begin(), beside.end());
        const auto kind = std::min_element(starts.begin(), starts.end());
        if (2 + 1 + 2 + golomb(*nearest, LR_PACKED_BESIDE_ORDER) + vertex_bits_ < *kind) {
            PackedEvent& e = event(i, LR_PACKED_BESIDE);
            const auto from = static_cast<std::uint32_t>(nearest - beside.begin());
            e.choice = static_cast<std::uint8_t>((r == reversed_ ? 0 : 1) | from << 1);
            e.v = *nearest;
            e.w = from == LR_PACKED_BESIDE_NOW_B || from == LR_PACKED_BESIDE_BEGUN_A ? wanted.b : wanted.a;
        } else {
            PackedEvent& e = event(i, LR_PACKED_START);
            e.choice = static_cast<std::uint8_t>(kind - starts.begin());
            e.reversed = r;
            e.v = e.choice == LR_PACKED_START_ANY ? wanted.a : step;
            e.w = e.choice == LR_PACKED_START_ANY ? wanted.b : size;
        }
        reversed_ = r;
        if (!scopes_.empty()) return;  // the state before a scope is restored at its end
        begun_ = wanted;
        begun_reversed_ = r;
    }

    /// Writes triangle i, and also triangle i + 1 if both form a wart. Returns the number written.
    std::uint32_t write_triangle(std::uint32_t i) {
        const auto [a, b] = now_;
        const std::uint32_t x = third(i);
        const bool enter_a = (flags(i) & CorridorStep::kEnterA) != 0, enter_b = (flags(i) & CorridorStep::kEnterB) != 0;
        // The corridor's last triangle: either turn is right.
        if (x == a + 1 && x + 1 == b && !enter_a && !enter_b) {
            turn_along(i, x, i > first_ && !turn(i - 1));
        } else if (x == a + 1 && !enter_a && !(enter_b && x + 1 == b)) {
            turn_along(i, x, true);
        } else if (x + 1 == b && !enter_b && !(enter_a && x == a + 1)) {
            turn_along(i, x, false);
        } else if (enter_a && enter_b) {
            return fork(i, x);
        } else if (enter_a != enter_b) {
            one_way(i, x, enter_a);
        } else {
            far(i, x, 0, 0);
            now_.b = x;
            finished_ = true;
        }
        return 1;
    }

    /// Writes a T0 with triangles to visit across both other edges.
    std::uint32_t fork(std::uint32_t i, std::uint32_t x) {
        const auto [a, b] = now_;
        const bool first_a = (flags(i) & CorridorStep::kFirstA) != 0;
        const std::uint32_t size = first_a ? x - a : b - x;
        const Edge part = first_a ? Edge{a, x} : Edge{x, b}, rest = first_a ? Edge{x, b} : Edge{a, x};
        const std::uint32_t outer = scopes_.empty() ? end_ : std::min(end_, scopes_.back().end);
        if (size == 2 && is_wart(i, outer)) {
            set_turn(i, first_a);
            warts_.push_back(i);
            now_ = rest;
            if (i + 1 == end_) return 1;
            set_turn(i + 1, first_a);
            return 2;
        }
        // The triangle at which the walk returns to the larger part; end_ if it is after the record.
        const std::uint32_t back = std::min(steps_.across(i, !first_a), end_);
        if (back == i + 1) {
            one_way(i, x, !first_a);
            return 1;
        }
        const bool ascends = (first_a ? x > a : x < b) && size > 1;
        const bool counts = ascends && size > 2 && (size < end_ - i ? back == i + size : back == end_);
        const bool split = counts && BitWriter::golomb_bits(size - 3, kSplitOrder) <= vertex_bits_ + 6;
        // The record does not return to the other part.
        if (back > outer || (back == end_ && (outer < end_ || !split))) {
            one_way(i, x, first_a);
            return 1;
        }
        if (split) {
            event(i, LR_PACKED_SPLIT).v = size - 3;
        } else if (ascends && BitWriter::golomb_bits(size - 2, LR_PACKED_JUMP_ORDER) < vertex_bits_ + 1) {
            PackedEvent& e = event(i, LR_PACKED_JUMP);
            e.choice = 1;
            e.v = size - 2;
            e.w = back - i - 2;
        } else {
            far(i, x, 3, back - i - 2);
        }
        set_turn(i, first_a);
        if (back < end_) scopes_.push_back({back, rest, reversed_});
        now_ = part;
        return 1;
    }

    void one_way(std::uint32_t i, std::uint32_t x, bool along_a) {
        const auto [a, b] = now_;
        const std::uint32_t size = along_a ? b - x : x - a;
        if ((along_a ? x < b : x > a) && size > 1 &&
            BitWriter::golomb_bits(size - 2, LR_PACKED_JUMP_ORDER) < vertex_bits_) {
            event(i, LR_PACKED_JUMP).v = size - 2;
            set_turn(i, !along_a);
        } else {
            far(i, x, along_a ? 1 : 2, 0);
        }
        now_ = along_a ? Edge{a, x} : Edge{x, b};
    }

    void turn_along(std::uint32_t i, std::uint32_t x, bool bit) {
        set_turn(i, bit);
        (bit ? now_.a : now_.b) = x;
        finished_ = now_.b - now_.a == 1;
    }

    /// Is the smaller part of T0 i a single triangle that comes next with the same orientation, and is the larger part
    /// not empty?
    bool is_wart(std::uint32_t i, std::uint32_t outer) const {
        if (i + 1 == steps_.size() || (i + 1 < end_ && i + 1 >= outer)) return false;
        const bool first_a = (flags(i) & CorridorStep::kFirstA) != 0;
        const std::uint32_t x = third(i);
        const Edge inner = first_a ? Edge{now_.a, x} : Edge{x, now_.b};
        return (flags(i + 1) & (CorridorStep::kEnterA | CorridorStep::kEnterB)) == 0 && edge(i + 1) == inner &&
               third(i + 1) == inner.a + 1 && reversed(i) == reversed(i + 1) && now_.b - now_.a > 3;
    }

    void far(std::uint32_t i, std::uint32_t x, std::uint8_t enters, std::uint32_t count) {
        PackedEvent& e = event(i, LR_PACKED_FAR);
        e.choice = enters;
        e.v = x;
        e.w = count;
    }

    /// Wart gaps count candidates: triangles whose turn equals that of the next triangle.
    void write_warts() {
        std::uint32_t from = first_;
        for (const std::uint32_t wart : warts_) {
            out_->wart_gaps.push_back(candidates(from, wart));
            from = wart + 1;
        }
    }

    /// Counts the triangles of [from, to) whose turn equals that of the next triangle. Triangle `to` is in the record.
    std::uint32_t candidates(std::uint32_t from, std::uint32_t to) const {
        std::uint32_t count = 0;
        for (std::uint32_t i = from; i < to; i = (i / 32 + 1) * 32) {
            const std::uint32_t word = turns_[i / 32], next = i / 32 * 32 + 32 <= to ? turns_[i / 32 + 1] : 0;
            const std::uint32_t same = ~(word ^ (word >> 1 | next << 31)) >> (i % 32);
            const std::uint32_t left = std::min(to - i, 32 - i % 32);
            count += static_cast<std::uint32_t>(std::popcount(left == 32 ? same : same & ((1U << left) - 1)));
        }
        return count;
    }

    const Steps& steps_;
    std::uint32_t vertex_bits_;
    std::uint32_t* turns_;
    bool bitmap_ = false;                    // is there a FLIPS event?
    bool base_ = false, last_base_ = false;  // flip that the FLIPS bits are relative to
    PackedRecordPlan* out_ = nullptr;
    std::uint32_t first_ = 0, end_ = 0;
    // The state of a reader of the block.
    Edge now_{}, begun_{};
    bool reversed_ = false, begun_reversed_ = false, finished_ = false;
    std::vector<Scope> scopes_;
    std::vector<std::uint32_t> warts_;
};

}  // namespace lacedring
