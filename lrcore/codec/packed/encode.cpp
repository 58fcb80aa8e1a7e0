// Writes the steps of walk_corridors as turn bits and events. The writer keeps the state that a reader of the block
// has, and says in events whatever the next triangle needs and that state does not give.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "lacedring/lacedring.hpp"
#include "lacedring/streams.hpp"
#include "lrcore/base/crc32.h"
#include "lrcore/base/message.h"
#include "lrcore/codec/packed/bit_writer.h"
#include "lrcore/codec/packed/corridors.h"
#include "lrcore/codec/packed/packed_format.h"
#include "lrcore/codec/packed/record.h"

namespace lacedring {
namespace {

/// The edge entered: two vertices by their new numbers.
struct Edge {
    std::uint32_t a, b;
    bool operator==(const Edge&) const = default;
};

constexpr std::uint32_t kNoEvent = UINT32_MAX;
constexpr std::uint32_t kMostVertices = 1U << 29;  // keeps folded BESIDE steps below 2^30

class Encoder {
  public:
    Encoder(const CornerTable& table, const Corridors& corridors)
        : table_(table), corridors_(corridors), number_(table.vertex_count) {
        for (std::uint32_t v = 0; v < table.vertex_count; ++v) number_[corridors.vertex_order[v]] = v;
    }

    Result<EncodedPacked> encode() {
        EncodedPacked out;
        const auto triangles = static_cast<std::uint32_t>(corridors_.corners.size());
        PackedView view;
        view.triangles = triangles;
        vertex_bits_ = std::max<std::uint32_t>(1, static_cast<std::uint32_t>(std::bit_width(table_.vertex_count - 1)));
        if (table_.vertex_count == 0) vertex_bits_ = 1;
        // The best low part of a gap is about its mean times ln 2.
        const double gap = 0.69 * triangles / (1.0 + corridors_.events);
        gap_bits_ = static_cast<std::uint32_t>(
            std::clamp(std::lround(std::log2(std::max(gap, 1.0))), long{LR_PACKED_MIN_GAP_BITS}, 7L));

        std::vector<std::uint32_t>& words = out.words;
        words.assign(view.records_word(), 0);
        turns_ = words.data() + LR_PACKED_HEADER_WORDS;
        std::uint32_t* directory = words.data() + view.directory_word();
        std::vector<std::uint8_t> records;
        for (std::uint32_t block = 0; block < view.blocks(); ++block) {
            std::uint32_t* group = directory + std::size_t{block / LR_PACKED_GROUP} * LR_PACKED_GROUP_WORDS;
            const std::uint32_t member = block % LR_PACKED_GROUP;
            if (member == 0) group[0] = static_cast<std::uint32_t>(records.size());
            const std::uint32_t length = write_block(block * LR_PACKED_BLOCK, triangles, records, out.statistics);
            group[1 + member / 4] |= length << (8 * (member % 4));
            if (records.size() > UINT32_MAX) return Error{ErrorCode::too_large, "packed stream: records of 4 GiB"};
        }
        words.resize(words.size() + (records.size() + 3) / 4 + LR_PACKED_TAIL_WORDS, 0);
        std::copy(records.begin(), records.end(), reinterpret_cast<std::uint8_t*>(words.data() + view.records_word()));

        words[LR_PACKED_WORD_MAGIC] = LR_PACKED_MAGIC;
        words[LR_PACKED_WORD_VERSION] = LR_PACKED_VERSION;
        words[LR_PACKED_WORD_VERTICES] = table_.vertex_count;
        words[LR_PACKED_WORD_TRIANGLES] = triangles;
        words[LR_PACKED_WORD_RECORD_BYTES] = static_cast<std::uint32_t>(records.size());
        words[LR_PACKED_WORD_WIDTHS] = vertex_bits_ | gap_bits_ << 8U;
        words[LR_PACKED_WORD_CHECKSUM] = packed_checksum(words);
        return out;
    }

  private:
    std::uint32_t number(CornerId c) const { return number_[table_.vertex(c).value]; }
    std::uint8_t flags(std::uint32_t i) const { return corridors_.flags[i]; }
    CornerId facing(std::uint32_t i, bool a) const {  // the corner at a, or at b
        const CornerId c = corridors_.corners[i];
        return ((flags(i) & CorridorStep::kRight) != 0) == a ? previous(c) : next(c);
    }
    Edge edge(std::uint32_t i) const { return {number(facing(i, true)), number(facing(i, false))}; }
    std::uint32_t third(std::uint32_t i) const { return number(corridors_.corners[i]); }
    /// Does the triangle come out as (a, x, b), not (a, b, x)?
    bool reversed(std::uint32_t i) const {
        return ((flags(i) & CorridorStep::kRight) != 0) != table_.flipped(triangle(corridors_.corners[i]));
    }
    bool turn(std::uint32_t i) const { return (turns_[i / 32] >> (i % 32) & 1) != 0; }
    void set_turn(std::uint32_t i, bool bit) { turns_[i / 32] |= (bit ? 1U : 0U) << (i % 32); }

    /// Appends the record of the block that begins at triangle `first`; returns what the directory says of it.
    std::uint32_t write_block(std::uint32_t first, std::uint32_t triangles, std::vector<std::uint8_t>& records,
                              PackedStatistics& statistics) {
        const std::uint32_t end = std::min(first + LR_PACKED_BLOCK, triangles);
        const PackedStatistics before = statistics;
        statistics_ = &statistics;
        const std::vector<std::uint8_t>& whole = write_record(first, end);
        if (whole.size() <= LR_PACKED_MAX_RECORD) {
            records.insert(records.end(), whole.begin(), whole.end());
            return static_cast<std::uint32_t>(whole.size());
        }
        const std::size_t begin = records.size();
        const std::uint32_t plain = block_bytes(LR_PACKED_PLAIN, end - first, vertex_bits_);
        statistics = before;
        records.resize(begin + LR_PACKED_PARTS);
        bool fits = true;
        for (std::uint32_t part = 0; part < LR_PACKED_PARTS && first + part * LR_PACKED_PART < end; ++part) {
            const std::uint32_t from = first + part * LR_PACKED_PART;
            const std::vector<std::uint8_t>& bytes = write_record(from, std::min(from + LR_PACKED_PART, end));
            fits = fits && bytes.size() <= LR_PACKED_MAX_RECORD;
            records[begin + part] = static_cast<std::uint8_t>(bytes.size());
            records.insert(records.end(), bytes.begin(), bytes.end());
        }
        const std::size_t eighths = (records.size() - begin + 7) / 8;
        if (fits && 8 * eighths < plain) {
            ++statistics.parted_blocks;
            records.resize(begin + 8 * eighths, 0);
            return LR_PACKED_MAX_RECORD + static_cast<std::uint32_t>(eighths);
        }
        records.resize(begin);
        statistics = before;
        ++statistics.plain_blocks;
        bits_.clear();
        clear_turns(first, end);
        for (std::uint32_t i = first; i < end; ++i) {
            const Edge e = edge(i);
            const bool r = reversed(i);
            for (const std::uint32_t v : {e.a, r ? third(i) : e.b, r ? e.b : third(i)}) bits_.put(v, vertex_bits_);
        }
        const std::vector<std::uint8_t>& bytes = bits_.finish();
        records.insert(records.end(), bytes.begin(), bytes.end());
        return LR_PACKED_PLAIN;
    }

    /// The record of triangles [first, end), and their turns.
    const std::vector<std::uint8_t>& write_record(std::uint32_t first, std::uint32_t end) {
        clear_turns(first, end);
        bits_.clear();
        record_first_ = first;
        now_ = begun_ = edge(first);
        reversed_ = begun_reversed_ = reversed(first);
        finished_ = false;
        stack_.clear();
        last_event_ = first;
        bits_.put(now_.a, vertex_bits_);
        bits_.put(now_.b, vertex_bits_);
        bits_.put(reversed_ ? 1 : 0, 1);
        for (std::uint32_t i = first; i < end; i += write_triangle(i, end)) {
            if (i != first) enter(i);
            turn_to(i);
        }
        close_event();
        return bits_.finish();
    }

    void clear_turns(std::uint32_t first, std::uint32_t end) {
        for (std::uint32_t i = first; i < end; ++i) turns_[i / 32] &= ~(1U << (i % 32));
    }

    void event(std::uint32_t i, std::uint32_t code) {
        close_event();
        event_code_ = code;
        event_begin_ = bits_.bits();
        bits_.put_rice(i - last_event_, gap_bits_);
        if (code == LR_PACKED_TURN) {
            bits_.put(0x7f, 7);
        } else {
            bits_.put_unary(code);
        }
        last_event_ = i;
    }
    void close_event() {
        if (event_code_ == kNoEvent) return;
        ++statistics_->events[event_code_];
        statistics_->event_bits[event_code_] += bits_.bits() - event_begin_;
        event_code_ = kNoEvent;
    }

    /// The polygon that follows where none is named: behind the one begun last, and as long.
    Edge next_polygon() const { return {begun_.b + 1, begun_.b + 1 + (begun_.b - begun_.a)}; }

    /// Makes (a, b) those of triangle i.
    void enter(std::uint32_t i) {
        const Edge wanted = edge(i);
        if (!finished_) {
            if (!(now_ == wanted)) unstack_or_start(i, wanted);
        } else if (!stack_.empty() && stack_.back() == wanted) {
            stack_.pop_back();
        } else if (stack_.empty() && next_polygon() == wanted) {
            begun_ = wanted;
        } else {
            unstack_or_start(i, wanted);
        }
        now_ = wanted;
        finished_ = false;
    }

    void unstack_or_start(std::uint32_t i, Edge wanted) {
        constexpr std::size_t kLook = 3;
        for (std::size_t depth = 1; depth <= std::min(kLook, stack_.size()); ++depth) {
            if (!(stack_[stack_.size() - depth] == wanted)) continue;
            for (; depth > 0; --depth) {
                event(i, LR_PACKED_END);
                stack_.pop_back();
            }
            return;
        }
        start(i, wanted);
    }

    /// Another corridor, said in the fewest bits.
    void start(std::uint32_t i, Edge wanted) {
        constexpr std::uint32_t kNever = UINT32_MAX;
        const auto golomb = BitWriter::golomb_bits;
        const bool r = reversed(i), ascends = wanted.b >= wanted.a + 2;
        const std::uint32_t size = wanted.b - wanted.a - 2, step = wanted.a - begun_.b;
        const std::array<std::uint32_t, 4> starts{
            wanted == begun_ && r != begun_reversed_ ? 5 : kNever,
            step == 1 && ascends && !r ? 6 + golomb(size, LR_PACKED_SIZE_ORDER) : kNever,
            wanted.a >= begun_.b && ascends && r == begun_reversed_
                ? 7 + golomb(step, LR_PACKED_SIZE_ORDER) + golomb(size, LR_PACKED_SIZE_ORDER)
                : kNever,
            7 + 2 * vertex_bits_ + 1,
        };
        // In the order of LR_PACKED_BESIDE_*; a step back is folded in between the steps forward.
        std::array<std::uint32_t, 4> beside{wanted.a - now_.b, wanted.b - now_.a, wanted.a - begun_.a,
                                            wanted.b - begun_.b};
        for (std::uint32_t& s : beside) s = s >> 31 != 0 ? ~s << 1 | 1 : s << 1;
        const auto nearest = std::min_element(beside.begin(), beside.end());
        const auto kind = std::min_element(starts.begin(), starts.end());
        if (3 + 1 + 2 + golomb(*nearest, LR_PACKED_BESIDE_ORDER) + vertex_bits_ < *kind) {
            event(i, LR_PACKED_BESIDE);
            const auto from = static_cast<std::uint32_t>(nearest - beside.begin());
            bits_.put(r == reversed_ ? 0 : 1, 1);
            bits_.put(from, 2);
            bits_.put_golomb(*nearest, LR_PACKED_BESIDE_ORDER);
            bits_.put(from == LR_PACKED_BESIDE_NOW_B || from == LR_PACKED_BESIDE_BEGUN_A ? wanted.b : wanted.a,
                      vertex_bits_);
        } else {
            event(i, LR_PACKED_START);
            if (*kind == starts[LR_PACKED_START_ANY]) {
                bits_.put(0x7, 3);
                bits_.put(wanted.a, vertex_bits_);
                bits_.put(wanted.b, vertex_bits_);
                bits_.put(r ? 1 : 0, 1);
            } else {
                const auto code = static_cast<std::uint32_t>(kind - starts.begin());
                bits_.put_unary(code);
                if (code == LR_PACKED_START_NEAR) bits_.put_golomb(step, LR_PACKED_SIZE_ORDER);
                if (code != LR_PACKED_START_OTHER) bits_.put_golomb(size, LR_PACKED_SIZE_ORDER);
            }
        }
        begun_ = wanted;
        reversed_ = begun_reversed_ = r;
        stack_.clear();
    }

    void turn_to(std::uint32_t i) {
        if (reversed_ == reversed(i)) return;
        event(i, LR_PACKED_TURN);
        reversed_ = !reversed_;
    }

    /// Writes triangle i, and the one after it too if both are a wart's. Returns how many.
    std::uint32_t write_triangle(std::uint32_t i, std::uint32_t end) {
        const auto [a, b] = now_;
        const std::uint32_t x = third(i);
        const bool enter_a = (flags(i) & CorridorStep::kEnterA) != 0, enter_b = (flags(i) & CorridorStep::kEnterB) != 0;
        const bool first_a = (flags(i) & CorridorStep::kFirstA) != 0;
        if (x == a + 1 && x + 1 == b && !enter_a && !enter_b) {  // the corridor's last: both turns are true
            turn_along(i, x, i > record_first_ && turn(i - 1));
        } else if (x == a + 1 && !enter_a && !(enter_b && x + 1 == b)) {
            turn_along(i, x, true);
        } else if (x + 1 == b && !enter_b && !(enter_a && x == a + 1)) {
            turn_along(i, x, false);
        } else if (enter_a && enter_b) {
            const std::uint32_t size = first_a ? x - a : b - x;
            set_turn(i, first_a);
            if (size == 2 && is_wart(i)) {
                event(i, LR_PACKED_WART);
                now_ = first_a ? Edge{x, b} : Edge{a, x};
                if (i + 1 == end) return 1;
                set_turn(i + 1, first_a);
                return 2;
            }
            if ((first_a ? x > a : x < b) && size > 2 &&
                BitWriter::golomb_bits(size - 3, LR_PACKED_SPLIT_ORDER) <= vertex_bits_ + 5) {
                event(i, LR_PACKED_SPLIT);
                bits_.put_golomb(size - 3, LR_PACKED_SPLIT_ORDER);
            } else {
                far(i, x);
            }
            if (stack_.size() == LR_PACKED_STACK) stack_.erase(stack_.begin());
            stack_.push_back(first_a ? Edge{x, b} : Edge{a, x});
            now_ = first_a ? Edge{a, x} : Edge{x, b};
        } else if (enter_a != enter_b) {
            const std::uint32_t size = enter_a ? b - x : x - a;
            if ((enter_a ? x < b : x > a) && size > 1 &&
                BitWriter::golomb_bits(size - 2, LR_PACKED_JUMP_ORDER) < vertex_bits_) {
                event(i, LR_PACKED_JUMP);
                bits_.put_golomb(size - 2, LR_PACKED_JUMP_ORDER);
                set_turn(i, enter_b);
            } else {
                far(i, x);
            }
            now_ = enter_a ? Edge{a, x} : Edge{x, b};
        } else {
            far(i, x);
            now_.b = x;
            finished_ = true;
        }
        return 1;
    }

    void turn_along(std::uint32_t i, std::uint32_t x, bool bit) {
        set_turn(i, bit);
        (bit ? now_.a : now_.b) = x;
        finished_ = now_.b - now_.a == 1;
    }

    /// Is the smaller part of T0 i one triangle that is next and turned the same way, with more behind it?
    bool is_wart(std::uint32_t i) const {
        if (i + 1 == corridors_.corners.size()) return false;
        const bool first_a = (flags(i) & CorridorStep::kFirstA) != 0;
        const std::uint32_t x = third(i);
        const Edge inner = first_a ? Edge{now_.a, x} : Edge{x, now_.b};
        return (flags(i + 1) & (CorridorStep::kEnterA | CorridorStep::kEnterB)) == 0 && edge(i + 1) == inner &&
               third(i + 1) == inner.a + 1 && reversed(i) == reversed(i + 1) && now_.b - now_.a > 3;
    }

    void far(std::uint32_t i, std::uint32_t x) {
        event(i, LR_PACKED_FAR);
        bits_.put(flags(i) / CorridorStep::kEnterA, 2);
        bits_.put(x, vertex_bits_);
    }

    const CornerTable& table_;
    const Corridors& corridors_;
    std::vector<std::uint32_t> number_;
    std::uint32_t vertex_bits_ = 0, gap_bits_ = 0;
    std::uint32_t* turns_ = nullptr;
    // What a reader of the block knows.
    BitWriter bits_;
    Edge now_{}, begun_{};
    bool reversed_ = false, begun_reversed_ = false, finished_ = false;
    std::vector<Edge> stack_;
    std::uint32_t record_first_ = 0, last_event_ = 0;
    std::uint32_t event_code_ = kNoEvent;  // the event being written, and where it begins
    std::size_t event_begin_ = 0;
    PackedStatistics* statistics_ = nullptr;
};

}  // namespace

Result<EncodedPacked> encode_packed(const CornerTable& table, const Rings& rings, PackedProfile profile) {
    if (table.vertex_count > kMostVertices) {
        return Error{ErrorCode::too_large,
                     detail::message(table.vertex_count, " vertices; a packed stream numbers at most ", kMostVertices)};
    }
    Corridors corridors = profile == PackedProfile::small ? walk_corridors(table, rings) : walk_pieces(table, rings);
    Result<EncodedPacked> encoded = Encoder(table, corridors).encode();
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
