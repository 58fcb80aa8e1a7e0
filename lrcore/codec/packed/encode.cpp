// Writes the steps of walk_corridors as turn bits, events and warts. The writer keeps the state that a reader of the
// block has, and says in events whatever the next triangle needs and that state does not give.

#include <algorithm>
#include <array>
#include <bit>
#include <optional>

#include "lacedring/lacedring.hpp"
#include "lacedring/streams.hpp"
#include "lrcore/base/message.h"
#include "lrcore/codec/packed/bit_writer.h"
#include "lrcore/codec/packed/corridors.h"
#include "lrcore/codec/packed/packed_c.h"
#include "lrcore/codec/packed/packed_format.h"
#include "lrcore/codec/packed/record_plan.h"

namespace lacedring {
namespace {

using Edge = PackedEdge;

constexpr std::uint32_t kMostVertices = 1U << 29;  // keeps folded BESIDE steps below 2^30
constexpr std::uint32_t kSplitOrder = 2;           // a group's is known only when its events are

/// Turns steps into records, and sets their turn bits.
class Planner {
  public:
    Planner(const CornerTable& table, const Corridors& corridors, std::uint32_t vertex_bits, std::uint32_t* turns)
        : table_(table),
          corridors_(corridors),
          number_(table.vertex_count),
          step_(table.triangle_count(), UINT32_MAX),
          vertex_bits_(vertex_bits),
          turns_(turns) {
        for (std::uint32_t v = 0; v < table.vertex_count; ++v) number_[corridors.vertex_order[v]] = v;
        for (std::uint32_t i = 0; i < corridors.corners.size(); ++i) step_[triangle(corridors.corners[i]).value] = i;
    }

    /// The record of triangles [first, end), and their turns. `reversed`: the orientation that its reader begins with,
    /// where that is said elsewhere.
    PackedRecordPlan plan(std::uint32_t first, std::uint32_t end, std::optional<bool> reversed = {}) {
        bitmap_ = false;
        base_ = false;
        PackedRecordPlan out = attempt(first, end, reversed.value_or(comes_reversed(first)));
        constexpr std::uint32_t kTurnBits = 11;  // about what a TURN takes
        const auto turned = std::count_if(out.events.begin(), out.events.end(),
                                          [](const PackedEvent& e) { return e.code == LR_PACKED_TURN; });
        if (static_cast<std::uint32_t>(turned) * kTurnBits <= end - first + kTurnBits) return out;
        // Where flips are many, their base stays what it was: blocks can go on from each other.
        bitmap_ = true;
        base_ = reversed ? *reversed != on_right(first) : last_base_;
        last_base_ = base_;
        return attempt(first, end, on_right(first) != base_);
    }

    void clear_turns(std::uint32_t first, std::uint32_t end) {
        for (std::uint32_t i = first; i < end; ++i) turns_[i / 32] &= ~(1U << (i % 32));
    }

    Edge edge(std::uint32_t i) const { return {number(facing(i, true)), number(facing(i, false))}; }
    std::uint32_t third(std::uint32_t i) const { return number(corridors_.corners[i]); }
    /// Does the triangle come out as (a, x, b), not (a, b, x)?
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

    std::uint32_t number(CornerId c) const { return number_[table_.vertex(c).value]; }
    std::uint8_t flags(std::uint32_t i) const { return corridors_.flags[i]; }
    bool on_right(std::uint32_t i) const { return (flags(i) & CorridorStep::kRight) != 0; }
    bool flipped(std::uint32_t i) const { return table_.flipped(triangle(corridors_.corners[i])); }
    CornerId facing(std::uint32_t i, bool a) const {  // the corner at a, or at b
        const CornerId c = corridors_.corners[i];
        return on_right(i) == a ? previous(c) : next(c);
    }
    /// The orientation that events have to say: flips, too, where no bitmap says these.
    bool reversed(std::uint32_t i) const { return on_right(i) != (bitmap_ ? base_ : flipped(i)); }
    bool turn(std::uint32_t i) const { return (turns_[i / 32] >> (i % 32) & 1) != 0; }
    void set_turn(std::uint32_t i, bool bit) { turns_[i / 32] |= (bit ? 1U : 0U) << (i % 32); }

    /// The step that enters what lies across (x, b) of triangle i, or across (a, x); UINT32_MAX: none does.
    std::uint32_t step_across(std::uint32_t i, bool a) const {
        const CornerId o = table_.opposite(facing(i, !a));
        if (o.is_null()) return UINT32_MAX;
        const std::uint32_t step = step_[triangle(o).value];
        return step != UINT32_MAX && step > i && corridors_.corners[step] == o ? step : UINT32_MAX;
    }

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

    /// Another corridor, said in the fewest bits.
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
        // In the order of LR_PACKED_BESIDE_*; a step back is folded in between the steps forward.
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
        if (!scopes_.empty()) return;  // where a scope ends, all is as it was before it
        begun_ = wanted;
        begun_reversed_ = r;
    }

    /// Writes triangle i, and the one after it too if both are a wart's. Returns how many.
    std::uint32_t write_triangle(std::uint32_t i) {
        const auto [a, b] = now_;
        const std::uint32_t x = third(i);
        const bool enter_a = (flags(i) & CorridorStep::kEnterA) != 0, enter_b = (flags(i) & CorridorStep::kEnterB) != 0;
        if (x == a + 1 && x + 1 == b && !enter_a && !enter_b) {  // the corridor's last: both turns are true
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

    /// A T0 with something across both other edges.
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
        // Where the walk comes back to the rest; a record's reader need not know if that is behind its end.
        const std::uint32_t back = std::min(step_across(i, !first_a), end_);
        if (back == i + 1) {
            one_way(i, x, !first_a);
            return 1;
        }
        const bool ascends = (first_a ? x > a : x < b) && size > 1;
        const bool counts = ascends && size > 2 && (size < end_ - i ? back == i + size : back == end_);
        const bool split = counts && BitWriter::golomb_bits(size - 3, kSplitOrder) <= vertex_bits_ + 6;
        if (back > outer || (back == end_ && (outer < end_ || !split))) {  // never, as far as the reader is concerned
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

    /// Is the smaller part of T0 i one triangle that is next and turned the same way, with more behind it?
    bool is_wart(std::uint32_t i, std::uint32_t outer) const {
        if (i + 1 == corridors_.corners.size() || (i + 1 < end_ && i + 1 >= outer)) return false;
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

    /// Warts are counted among the triangles whose turn is that of the next one.
    void write_warts() {
        std::uint32_t gap = 0;
        auto wart = warts_.begin();
        for (std::uint32_t i = first_; i < end_ && wart != warts_.end(); ++i) {
            if (i + 1 < end_ && turn(i) != turn(i + 1)) continue;
            if (i == *wart) {
                out_->wart_gaps.push_back(gap);
                gap = 0;
                ++wart;
            } else {
                ++gap;
            }
        }
    }

    const CornerTable& table_;
    const Corridors& corridors_;
    std::vector<std::uint32_t> number_, step_;
    std::uint32_t vertex_bits_;
    std::uint32_t* turns_;
    bool bitmap_ = false;                    // does FLIPS say which triangles are flipped?
    bool base_ = false, last_base_ = false;  // the flip that its bits are relative to
    PackedRecordPlan* out_ = nullptr;
    std::uint32_t first_ = 0, end_ = 0;
    // What a reader of the block knows.
    Edge now_{}, begun_{};
    bool reversed_ = false, begun_reversed_ = false, finished_ = false;
    std::vector<Scope> scopes_;
    std::vector<std::uint32_t> warts_;
};

/// Widths and orders of one group.
struct GroupCodes {
    std::uint32_t length_bits = 0, entry_bits = 0, gap_bits = 0, wart_bits = 0, split_order = 0, count_order = 0;
};

/// The argument below `end` at which `cost` is least.
template <class Cost>
std::uint32_t cheapest(std::uint32_t end, const Cost& cost) {
    std::uint32_t best = 0;
    std::uint64_t least = cost(0);
    for (std::uint32_t k = 1; k < end; ++k) {
        const std::uint64_t c = cost(k);
        if (c < least) {
            least = c;
            best = k;
        }
    }
    return best;
}

bool names_triangle(std::uint32_t code) {
    return code == LR_PACKED_SPLIT || code == LR_PACKED_FAR || code == LR_PACKED_JUMP;
}

template <class Use>
void for_each_gap(const PackedRecordPlan& record, const Use& use) {
    std::uint32_t at = 0;
    for (const PackedEvent& e : record.events) {
        use(e, e.triangle - at);
        at = e.triangle + (names_triangle(e.code) ? 1U : 0U);
    }
}

/// Writes the blocks of one group after the other.
class GroupWriter {
  public:
    GroupWriter(Planner& planner, std::uint32_t triangles, std::uint32_t vertex_bits, PackedStatistics& statistics)
        : planner_(planner), triangles_(triangles), vertex_bits_(vertex_bits), statistics_(statistics) {}

    /// Appends the group that begins at a block.
    void write(std::uint32_t block, std::vector<std::uint8_t>& out) {
        const std::uint32_t end =
            std::min(block + LR_PACKED_GROUP, (triangles_ + LR_PACKED_BLOCK - 1) / LR_PACKED_BLOCK);
        records_.clear();
        for (std::uint32_t k = block; k < end; ++k) {
            const std::uint32_t first = k * LR_PACKED_BLOCK;
            records_.push_back(planner_.plan(first, std::min(first + LR_PACKED_BLOCK, triangles_)));
        }
        choose_codes();
        choose_entries();
        bodies_.clear();
        lengths_.clear();
        for (std::size_t k = 0; k < records_.size(); ++k) write_block(k);
        codes_.length_bits =
            static_cast<std::uint32_t>(std::bit_width(*std::max_element(lengths_.begin(), lengths_.end())));

        head_.clear();
        head_.put(codes_.length_bits, LR_PACKED_LENGTH_FIELD);
        head_.put(codes_.entry_bits, LR_PACKED_ENTRY_FIELD);
        head_.put(codes_.gap_bits, LR_PACKED_GAP_FIELD);
        head_.put(codes_.wart_bits, LR_PACKED_WART_FIELD);
        head_.put(codes_.split_order, LR_PACKED_SPLIT_FIELD);
        head_.put(codes_.count_order, LR_PACKED_COUNT_FIELD);
        const bool plain = lengths_[0] == LR_PACKED_PLAIN;
        head_.put(plain ? 0 : records_[0].entry.a, vertex_bits_);
        head_.put(plain ? 0 : records_[0].entry.b, vertex_bits_);
        head_.put(!plain && records_[0].reversed ? 1 : 0, 1);
        for (std::size_t k = 0; k < records_.size(); ++k) {
            head_.put(lengths_[k], codes_.length_bits);
            if (k > 0) head_.put(entries_[k], codes_.entry_bits);
        }
        const std::vector<std::uint8_t>& head = head_.finish();
        out.insert(out.end(), head.begin(), head.end());
        out.insert(out.end(), bodies_.begin(), bodies_.end());
    }

  private:
    /// A reader takes 31 ones at most. With a low bit or more, the records of parts, which are planned later, have no
    /// more.
    static std::uint64_t rice_bits(std::uint32_t gap, std::uint32_t low) {
        static_assert((LR_PACKED_PART - 1) >> 1 <= 31);
        return low == 0 || gap >> low > 31 ? UINT32_MAX : std::uint64_t{gap >> low} + 1 + low;
    }

    void choose_codes() {
        codes_.gap_bits = cheapest(8, [&](std::uint32_t low) {
            std::uint64_t bits = low == 0 ? 1 : 0;
            for (const PackedRecordPlan& r : records_) {
                for_each_gap(r, [&](const PackedEvent&, std::uint32_t gap) { bits += rice_bits(gap, low); });
            }
            return bits;
        });
        codes_.wart_bits = cheapest(8, [&](std::uint32_t low) {
            std::uint64_t bits = low == 0 ? 1 : 0;
            for (const PackedRecordPlan& r : records_) {
                for (const std::uint32_t gap : r.wart_gaps) bits += rice_bits(gap, low);
            }
            return bits;
        });
        codes_.split_order = cheapest(4, [&](std::uint32_t order) {
            std::uint64_t bits = 0;
            for (const PackedRecordPlan& r : records_) {
                for (const PackedEvent& e : r.events) {
                    if (e.code == LR_PACKED_SPLIT) bits += BitWriter::golomb_bits(e.v, order);
                }
            }
            return bits;
        });
        codes_.count_order = cheapest(4, [&](std::uint32_t order) {
            std::uint64_t bits = 0;
            for (const PackedRecordPlan& r : records_) {
                if (!r.events.empty() || !r.wart_gaps.empty()) {
                    bits += BitWriter::golomb_bits(static_cast<std::uint32_t>(r.events.size()), order);
                }
            }
            return bits;
        });
    }

    /// A block whose (a, b) is what is left of the block before it needs no entry of its own, only a step of a.
    static std::optional<std::int32_t> entry_step(const PackedRecordPlan& before, const PackedRecordPlan& r) {
        if (r.reversed != before.reversed ||
            r.entry.b - r.entry.a != before.entry.b - before.entry.a - LR_PACKED_BLOCK) {
            return std::nullopt;
        }
        const auto step = static_cast<std::int32_t>(r.entry.a - before.entry.a - LR_PACKED_BLOCK / 2);
        return step >= -127 && step <= 127 ? std::optional(step) : std::nullopt;
    }

    void choose_entries() {
        const auto fits = [](std::int32_t step, std::uint32_t bits) {
            const std::int32_t half = bits == 0 ? 0 : 1 << (bits - 1);
            return bits > 0 && step > -half && step < half;
        };
        codes_.entry_bits = cheapest(9, [&](std::uint32_t bits) {
            std::uint64_t cost = 0;
            for (std::size_t k = 1; k < records_.size(); ++k) {
                const auto step = entry_step(records_[k - 1], records_[k]);
                cost += bits + (step && fits(*step, bits) ? 0 : 2 * vertex_bits_ + 1);
            }
            return cost;
        });
        entries_.assign(records_.size(), 0);
        for (std::size_t k = 1; k < records_.size(); ++k) {
            const auto step = entry_step(records_[k - 1], records_[k]);
            if (step && fits(*step, codes_.entry_bits)) {
                entries_[k] = static_cast<std::uint32_t>(*step + (1 << (codes_.entry_bits - 1)));
            }
        }
    }

    /// Appends the block's records to bodies_ and its length to lengths_.
    void write_block(std::size_t k) {
        const std::uint32_t first = records_[k].first, end = first + records_[k].triangles;
        const bool has_entry = k > 0 && entries_[k] == 0;
        const PackedStatistics before = statistics_;
        const std::vector<std::uint8_t>& whole = write_record(records_[k], has_entry);
        if (whole.size() <= LR_PACKED_MAX_RECORD) {
            bodies_.insert(bodies_.end(), whole.begin(), whole.end());
            lengths_.push_back(static_cast<std::uint32_t>(whole.size()));
            return;
        }
        const std::size_t begin = bodies_.size();
        const std::uint32_t plain = (3 * (end - first) * vertex_bits_ + 7) / 8;
        statistics_ = before;
        bodies_.resize(begin + LR_PACKED_PARTS);
        bool fits = true;
        for (std::uint32_t part = 0; part < LR_PACKED_PARTS && first + part * LR_PACKED_PART < end; ++part) {
            const std::uint32_t from = first + part * LR_PACKED_PART;
            const PackedRecordPlan record =
                planner_.plan(from, std::min(from + LR_PACKED_PART, end),
                              part == 0 ? std::optional(records_[k].reversed) : std::nullopt);
            const std::vector<std::uint8_t>& bytes = write_record(record, part > 0 || has_entry);
            fits = fits && bytes.size() <= LR_PACKED_MAX_PART;
            bodies_[begin + part] = static_cast<std::uint8_t>(bytes.size());
            bodies_.insert(bodies_.end(), bytes.begin(), bytes.end());
        }
        const std::size_t eighths = (bodies_.size() - begin + 7) / 8;
        if (fits && 8 * eighths < plain && eighths < LR_PACKED_PLAIN - LR_PACKED_MAX_RECORD) {
            ++statistics_.parted_blocks;
            bodies_.resize(begin + 8 * eighths, 0);
            lengths_.push_back(LR_PACKED_MAX_RECORD + static_cast<std::uint32_t>(eighths));
            return;
        }
        bodies_.resize(begin);
        statistics_ = before;
        ++statistics_.plain_blocks;
        bits_.clear();
        planner_.clear_turns(first, end);
        for (std::uint32_t i = first; i < end; ++i) {
            const Edge e = planner_.edge(i);
            const std::uint32_t x = planner_.third(i);
            const bool r = planner_.comes_reversed(i);
            for (const std::uint32_t v : {e.a, r ? x : e.b, r ? e.b : x}) bits_.put(v, vertex_bits_);
        }
        const std::vector<std::uint8_t>& bytes = bits_.finish();
        bodies_.insert(bodies_.end(), bytes.begin(), bytes.end());
        lengths_.push_back(LR_PACKED_PLAIN);
        entries_[k] = 0;
        if (k + 1 < entries_.size()) entries_[k + 1] = 0;
    }

    const std::vector<std::uint8_t>& write_record(const PackedRecordPlan& r, bool has_entry) {
        bits_.clear();
        if (has_entry) {
            bits_.put(r.entry.a, vertex_bits_);
            bits_.put(r.entry.b, vertex_bits_);
            bits_.put(r.reversed ? 1 : 0, 1);
        }
        if (!has_entry && r.events.empty() && r.wart_gaps.empty()) return bits_.finish();
        bits_.put_golomb(static_cast<std::uint32_t>(r.events.size()), codes_.count_order);
        for_each_gap(r, [&](const PackedEvent& e, std::uint32_t gap) {
            const std::size_t begin = bits_.bits();
            bits_.put_rice(gap, codes_.gap_bits);
            write_event(r, e);
            ++statistics_.events[e.code];
            statistics_.event_bits[e.code] += bits_.bits() - begin;
        });
        const std::size_t begin = bits_.bits();
        for (const std::uint32_t gap : r.wart_gaps) bits_.put_rice(gap, codes_.wart_bits);
        statistics_.warts += static_cast<std::uint32_t>(r.wart_gaps.size());
        statistics_.wart_bits += bits_.bits() - begin;
        return bits_.finish();
    }

    void write_event(const PackedRecordPlan& r, const PackedEvent& e) {
        bits_.put_unary(e.code);
        switch (e.code) {
            case LR_PACKED_SPLIT:
                bits_.put_golomb(e.v, codes_.split_order);
                break;
            case LR_PACKED_JUMP:
                bits_.put_golomb(e.v, LR_PACKED_JUMP_ORDER);
                bits_.put(e.choice, 1);
                if (e.choice == 1) bits_.put_golomb(e.w, LR_PACKED_FAR_ORDER);
                break;
            case LR_PACKED_FAR:
                bits_.put(e.choice, 2);
                bits_.put(e.v, vertex_bits_);
                if (e.choice == 3) bits_.put_golomb(e.w, LR_PACKED_FAR_ORDER);
                break;
            case LR_PACKED_BESIDE:
                bits_.put(e.choice, 3);
                bits_.put_golomb(e.v, LR_PACKED_BESIDE_ORDER);
                bits_.put(e.w, vertex_bits_);
                break;
            case LR_PACKED_START:
                if (e.choice == LR_PACKED_START_ANY) {
                    bits_.put(0x7, 3);
                    bits_.put(e.v, vertex_bits_);
                    bits_.put(e.w, vertex_bits_);
                    bits_.put(e.reversed ? 1 : 0, 1);
                } else {
                    bits_.put_unary(e.choice);
                    if (e.choice == LR_PACKED_START_NEAR) bits_.put_golomb(e.v, LR_PACKED_SIZE_ORDER);
                    if (e.choice != LR_PACKED_START_OTHER) bits_.put_golomb(e.w, LR_PACKED_SIZE_ORDER);
                }
                break;
            case LR_PACKED_FLIPS:
                for (std::uint32_t i = 0; i < r.triangles; ++i) bits_.put(r.flips[i / 32] >> (i % 32) & 1, 1);
                break;
            default:
                break;
        }
    }

    Planner& planner_;
    std::uint32_t triangles_, vertex_bits_;
    PackedStatistics& statistics_;
    GroupCodes codes_;
    std::vector<PackedRecordPlan> records_;
    std::vector<std::uint32_t> entries_, lengths_;
    std::vector<std::uint8_t> bodies_;
    BitWriter bits_, head_;
};

Result<EncodedPacked> write_stream(const CornerTable& table, const Corridors& corridors) {
    EncodedPacked out;
    const auto triangles = static_cast<std::uint32_t>(corridors.corners.size());
    const std::uint32_t vertex_bits = packed_vertex_bits(table.vertex_count);
    PackedView view;
    view.triangles = triangles;
    std::vector<std::uint32_t>& words = out.words;
    words.assign(view.groups_word(), 0);
    Planner planner(table, corridors, vertex_bits, words.data() + LR_PACKED_HEADER_WORDS);
    GroupWriter writer(planner, triangles, vertex_bits, out.statistics);
    std::vector<std::uint8_t> groups;
    for (std::uint32_t block = 0; block < view.blocks(); block += LR_PACKED_GROUP) {
        if (groups.size() > UINT32_MAX) return Error{ErrorCode::too_large, "packed stream: groups of 4 GiB"};
        if (block > 0) {
            words[view.table_word() + block / LR_PACKED_GROUP - 1] = static_cast<std::uint32_t>(groups.size());
        }
        writer.write(block, groups);
    }
    words.resize(words.size() + (groups.size() + 3) / 4, 0);
    std::copy(groups.begin(), groups.end(), reinterpret_cast<std::uint8_t*>(words.data() + view.groups_word()));
    words[LR_PACKED_WORD_MAGIC] = LR_PACKED_MAGIC;
    words[LR_PACKED_WORD_VERTICES] = table.vertex_count;
    words[LR_PACKED_WORD_TRIANGLES] = triangles;
    words[LR_PACKED_WORD_CHECKSUM] = packed_checksum(words);
    return out;
}

}  // namespace

Result<EncodedPacked> encode_packed(const CornerTable& table, const Rings& rings, PackedProfile profile) {
    if (table.vertex_count > kMostVertices) {
        return Error{ErrorCode::too_large,
                     detail::message(table.vertex_count, " vertices; a packed stream numbers at most ", kMostVertices)};
    }
    Corridors corridors = profile == PackedProfile::small ? walk_corridors(table, rings) : walk_pieces(table, rings);
    Result<EncodedPacked> encoded = write_stream(table, corridors);
    if (!encoded) return encoded;
    EncodedPacked& out = *encoded;
    out.statistics.ring_vertices = corridors.ring_vertices;
    for (const CornerId c : corridors.corners) out.triangle_order.push_back(triangle(c).value);
    out.vertex_order = std::move(corridors.vertex_order);
    return encoded;
}

Result<PackedChoice> encode_smallest_packed(const CornerTable& table, const RingOptions& ring,
                                            const OptimizeOptions& optimize, PackedProfile profile) {
    Rings rings = expand_rings(table, ring);
    Result<EncodedPacked> plain = encode_packed(table, rings, profile);
    if (!plain) return plain.error();
    PackedChoice out{std::move(*plain), 0};
    if (optimize.passes == 0) return out;
    Result<EncodedPacked> optimized = encode_packed(table, optimize_rings(table, std::move(rings), optimize), profile);
    if (!optimized) return optimized.error();
    if (optimized->words.size() < out.stream.words.size()) out = {std::move(*optimized), optimize.passes};
    return out;
}

}  // namespace lacedring
