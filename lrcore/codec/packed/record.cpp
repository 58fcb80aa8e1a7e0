// The state machine of docs/packed-format.md.

#include "lrcore/codec/packed/record.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "lrcore/base/compiler.h"

namespace lacedring {
namespace {

static_assert(std::endian::native == std::endian::little, "streams are little-endian words");

/// The bits of one record; behind its end there are ones. Reads up to eight bytes beyond it, which a stream always has.
class RecordBits {
  public:
    RecordBits(const std::uint8_t* record, std::uint32_t length) : record_(record), bits_(8 * length) {}

    /// At least 57 bits from here on.
    std::uint64_t window() const {
        const std::uint32_t at = std::min(at_, bits_);
        std::uint64_t value;
        std::memcpy(&value, record_ + at / 8, sizeof value);
        value >>= at % 8;
        const std::uint32_t left = bits_ - at;
        return left < 64 ? value | ~std::uint64_t{0} << left : value;
    }
    void skip(std::uint32_t count) { at_ += count; }
    bool past_end() const { return at_ > bits_; }
    bool at_last_byte() const { return at_ <= bits_ && bits_ - at_ < 8; }

    std::uint32_t take(std::uint32_t count) {
        const auto value = static_cast<std::uint32_t>(window() & ((std::uint64_t{1} << count) - 1));
        skip(count);
        return value;
    }
    /// Ones before a zero, at most `limit`: where there are as many, no zero is read.
    std::uint32_t unary(std::uint32_t limit) {
        const std::uint32_t ones = std::min(static_cast<std::uint32_t>(std::countr_one(window())), limit);
        skip(ones + (ones < limit ? 1 : 0));
        return ones;
    }
    std::uint32_t golomb(std::uint32_t order) {
        const std::uint32_t low = unary(31 - order) + order;
        return (take(low) | 1U << low) - (1U << order);
    }

  private:
    const std::uint8_t* record_;
    std::uint32_t bits_, at_ = 0;
};

/// Four turns at once: twelve indices, each a or (where the mask is set) b with something added; then a and b move on.
/// b - a becomes smaller by four whatever the turns.
struct alignas(128) Nibble {
    std::uint32_t mask[12], add[12], ups[4];
};

consteval std::array<Nibble, 16> make_nibbles(bool reversed) {
    std::array<Nibble, 16> out{};
    for (std::uint32_t bits = 0; bits < 16; ++bits) {
        std::uint32_t a = 0, b = 0;  // relative to the first edge's
        for (std::uint32_t k = 0; k < 4; ++k) {
            const bool up = (bits >> k & 1) != 0;
            const std::uint32_t ia = 3 * k, ix = 3 * k + (reversed ? 1 : 2), ib = 3 * k + (reversed ? 2 : 1);
            out[bits].add[ia] = a;
            out[bits].add[ib] = b;
            out[bits].mask[ib] = UINT32_MAX;
            if (up) {
                out[bits].add[ix] = ++a;
            } else {
                out[bits].add[ix] = --b;
                out[bits].mask[ix] = UINT32_MAX;
            }
        }
        for (std::uint32_t& ups : out[bits].ups) ups = a;
    }
    return out;
}

constexpr std::array<Nibble, 16> kNibbles[2] = {make_nibbles(false), make_nibbles(true)};

detail::Lanes load(const std::uint32_t* from) {
    detail::Lanes out;
    std::memcpy(&out, from, sizeof out);
    return out;
}

struct Gate {
    std::uint32_t a, b;
};

class Expander {
  public:
    Expander(const PackedView& view, const PackedRecord& record, std::uint32_t count, std::uint32_t* out)
        : bits_(record.record, record.length),
          turns_(record.turns),
          out_(out),
          width_(view.vertex_bits),
          gap_bits_(view.gap_bits),
          triangles_(record.triangles),
          count_(count) {}

    bool expand() {
        now_.a = bits_.take(width_);
        now_.b = bits_.take(width_);
        reversed_ = bits_.take(1) != 0;
        begun_ = now_;
        begun_reversed_ = reversed_;
        if (!next_event()) return false;
        bool finished = false;
        std::uint32_t i = 0;
        while (i < count_) {
            while (event_ == i && is_before(code_)) {
                if (!before(finished)) return false;
                if (!next_event()) return false;
            }
            if (finished) {
                if (depth_ > 0) {
                    now_ = pop();
                } else {
                    now_ = begun_ = {begun_.b + 1, begun_.b + 1 + (begun_.b - begun_.a)};
                }
            }
            if (event_ == i && code_ != LR_PACKED_WART) {
                if (!third_vertex(i, finished)) return false;
                ++i;
                continue;
            }
            // Up to the next event that is not a wart, or the corridor's end.
            const std::uint32_t left = now_.b - now_.a == 1 ? 1 : now_.b - now_.a - 1;
            const std::uint32_t most = std::min(count_ - i, left);
            std::uint32_t warts = 0;
            while (code_ == LR_PACKED_WART && event_ < i + most) {
                const std::uint32_t wart = event_;
                warts_[warts++] = static_cast<std::uint8_t>(wart);
                if (!next_event()) return false;
                if (event_ < wart + 2) return false;
            }
            const std::uint32_t n = std::min(most, event_ - i);
            if (warts > 0 && warts_[warts - 1] + 1U >= i + n && i + n < count_) return false;
            run(i, i + n);
            for (std::uint32_t k = 0; k < warts; ++k) {
                if (!wart(warts_[k])) return false;
            }
            i += n;
            finished = now_.b - now_.a == 1;
            // Both turns are true of a corridor's last triangle, so the format says which.
            if (finished && turn(i - 1) != (i > 1 && turn(i - 2))) return false;
        }
        return count_ < triangles_ || bits_.at_last_byte();
    }

  private:
    static constexpr bool is_before(std::uint32_t code) {
        return code == LR_PACKED_START || code == LR_PACKED_BESIDE || code >= LR_PACKED_END;
    }
    bool turn(std::uint32_t i) const { return (turns_[i / 32] >> (i % 32) & 1) != 0; }

    /// Reads the gap and the code of the next event. False if it lies behind the record's triangles.
    bool next_event() {
        const std::uint64_t window = bits_.window();
        const auto high = static_cast<std::uint32_t>(std::countr_one(window));
        if (high > LR_PACKED_BLOCK >> LR_PACKED_MIN_GAP_BITS) {  // the ones behind the record
            event_ = UINT32_MAX;
            code_ = LR_PACKED_TURN;
            return true;
        }
        const std::uint64_t rest = window >> (high + 1);
        event_ += (high << gap_bits_) + (static_cast<std::uint32_t>(rest) & ((1U << gap_bits_) - 1));
        code_ = std::min(static_cast<std::uint32_t>(std::countr_one(rest >> gap_bits_)), LR_PACKED_TURN);
        bits_.skip(high + 1 + gap_bits_ + code_ + (code_ < LR_PACKED_TURN ? 1 : 0));
        return event_ < triangles_ && !bits_.past_end();
    }

    /// What an event says about the triangle that follows.
    bool before(bool& finished) {
        if (code_ == LR_PACKED_TURN) {
            reversed_ = !reversed_;
            return true;
        }
        finished = false;
        if (code_ == LR_PACKED_END) {
            if (depth_ == 0) return false;
            now_ = pop();
            return true;
        }
        depth_ = 0;
        if (code_ == LR_PACKED_BESIDE) {
            if (!beside()) return false;
        } else {
            start();
        }
        now_ = begun_;
        begun_reversed_ = reversed_;
        return true;
    }

    /// False for a step that leads past all vertices: readers with fewer bits at hand need not take it.
    bool beside() {
        if (bits_.take(1) != 0) reversed_ = !reversed_;
        const std::uint32_t from = bits_.take(2), folded = bits_.golomb(LR_PACKED_BESIDE_ORDER);
        if (folded >> 30 != 0) return false;
        const std::uint32_t step = (folded & 1) != 0 ? ~(folded >> 1) : folded >> 1, other = bits_.take(width_);
        switch (from) {
            case LR_PACKED_BESIDE_NOW_B:
                begun_ = {now_.b + step, other};
                break;
            case LR_PACKED_BESIDE_NOW_A:
                begun_ = {other, now_.a + step};
                break;
            case LR_PACKED_BESIDE_BEGUN_A:
                begun_ = {begun_.a + step, other};
                break;
            default:
                begun_ = {other, begun_.b + step};
        }
        return true;
    }

    void start() {
        const std::uint32_t kind = bits_.unary(LR_PACKED_START_ANY);
        if (kind == LR_PACKED_START_OTHER) {
            reversed_ = !begun_reversed_;
        } else if (kind == LR_PACKED_START_ANY) {
            begun_.a = bits_.take(width_);
            begun_.b = bits_.take(width_);
            reversed_ = bits_.take(1) != 0;
        } else {
            begun_.a = begun_.b + (kind == LR_PACKED_START_NEXT ? 1 : bits_.golomb(LR_PACKED_SIZE_ORDER));
            begun_.b = begun_.a + 2 + bits_.golomb(LR_PACKED_SIZE_ORDER);
            reversed_ = kind == LR_PACKED_START_NEXT ? false : begun_reversed_;
        }
    }

    /// Triangle i, whose third vertex its event gives.
    bool third_vertex(std::uint32_t i, bool& finished) {
        const auto [a, b] = now_;
        const bool along_a = turn(i);
        std::uint32_t x = 0, enters = along_a ? 2 : 1;
        if (code_ == LR_PACKED_FAR) {
            enters = bits_.take(2);
            x = bits_.take(width_);
            if (along_a && enters != 3) return false;  // a turn that says nothing
        } else {
            const bool split = code_ == LR_PACKED_SPLIT;
            const std::uint32_t size =
                split ? 3 + bits_.golomb(LR_PACKED_SPLIT_ORDER) : 2 + bits_.golomb(LR_PACKED_JUMP_ORDER);
            x = along_a ? a + size : b - size;
            if (split) enters = 3;
        }
        store(i, a, x, b);
        const Gate low{a, x}, high{x, b};
        if (enters == 3) push(along_a ? high : low);
        now_ = enters == 3 ? (along_a ? low : high) : enters == 2 ? high : low;
        finished = enters == 0;
        return next_event() && event_ > i;
    }

    void push(Gate edge) {
        stack_[top_++ % LR_PACKED_STACK] = edge;
        depth_ = std::min(depth_ + 1, LR_PACKED_STACK);
    }
    Gate pop() {
        --depth_;
        return stack_[--top_ % LR_PACKED_STACK];
    }

    void store(std::uint32_t i, std::uint32_t a, std::uint32_t x, std::uint32_t b) {
        std::uint32_t* out = out_ + std::size_t{3} * i;
        out[0] = a;
        out[1] = reversed_ ? x : b;
        out[2] = reversed_ ? b : x;
    }

    /// Triangles [i, end), by their turns alone. The last nibble too is written whole where there is room: what is too
    /// much is written again.
    void run(std::uint32_t i, std::uint32_t end) {
        const std::array<Nibble, 16>& table = kNibbles[reversed_ ? 1 : 0];
        const std::uint32_t span = now_.b - now_.a, first = i;
        detail::Lanes a = detail::Lanes{} + now_.a, width = detail::Lanes{} + span;
        const auto nibble = [&](std::uint64_t turns) {
            const Nibble& n = table[turns & 15];
            std::uint32_t* out = out_ + std::size_t{3} * i;
            for (std::uint32_t k = 0; k < 12; k += 4) {
                const detail::Lanes indices = a + load(n.add + k) + (width & load(n.mask + k));
                std::memcpy(out + k, &indices, sizeof indices);
            }
            a += load(n.ups);
            width -= 4;
            i += 4;
        };
        while (i < end && i + 8 <= count_) {
            std::uint64_t turns;
            std::memcpy(&turns, reinterpret_cast<const std::uint8_t*>(turns_) + i / 8, sizeof turns);
            turns >>= i % 8;
            nibble(turns);
            nibble(turns >> 4);
        }
        while (i < end && i + 4 <= count_) {
            std::uint64_t turns;
            std::memcpy(&turns, reinterpret_cast<const std::uint8_t*>(turns_) + i / 8, sizeof turns);
            nibble(turns >> (i % 8));
        }
        if (i > end) {  // take back what is too much
            std::uint32_t turns;
            std::memcpy(&turns, reinterpret_cast<const std::uint8_t*>(turns_) + end / 8, sizeof turns);
            a -= static_cast<std::uint32_t>(std::popcount(turns >> (end % 8) & ((1U << (i - end)) - 1)));
            i = end;
        }
        now_ = {a[0], a[0] + span - (i - first)};
        for (; i < end; ++i) {
            const bool up = turn(i);
            const std::uint32_t x = up ? now_.a + 1 : now_.b - 1;
            store(i, now_.a, x, now_.b);
            (up ? now_.a : now_.b) = x;
        }
    }

    /// Makes triangle i of a run the T0 of a wart, and the next one its T2.
    bool wart(std::uint32_t i) {
        std::uint32_t* out = out_ + std::size_t{3} * i;
        const bool along_a = turn(i);
        const std::uint32_t a = out[0], b = out[reversed_ ? 2 : 1];
        if (b - a < 4) return false;  // its polygon would be finished, or never have been one
        const Gate inner = along_a ? Gate{a, a + 2} : Gate{b - 2, b};
        out[reversed_ ? 1 : 2] = along_a ? inner.b : inner.a;
        if (i + 1 == count_) return true;
        store(i + 1, inner.a, inner.a + 1, inner.b);
        return turn(i + 1) == along_a;
    }

    RecordBits bits_;
    const std::uint32_t* turns_;
    std::uint32_t* out_;
    std::uint32_t width_, gap_bits_, triangles_, count_;
    Gate now_{}, begun_{};
    bool reversed_ = false, begun_reversed_ = false;
    std::uint32_t event_ = 0, code_ = 0;
    std::uint32_t depth_ = 0;
    std::uint32_t top_ = 0;  // stack_ goes round
    std::array<Gate, LR_PACKED_STACK> stack_;
    std::array<std::uint8_t, LR_PACKED_BLOCK> warts_;
};

}  // namespace

PackedRecord find_record(const PackedView& view, std::uint32_t triangle) {
    const std::uint32_t block = triangle / LR_PACKED_BLOCK, member = block % LR_PACKED_GROUP;
    const std::uint32_t* group =
        view.words.data() + view.directory_word() + std::size_t{block / LR_PACKED_GROUP} * LR_PACKED_GROUP_WORDS;
    const auto length = [&](std::uint32_t i) { return group[1 + i / 4] >> (8 * (i % 4)) & 0xff; };
    std::uint32_t offset = group[0];
    for (std::uint32_t i = 0; i < member; ++i) offset += block_bytes(length(i), LR_PACKED_BLOCK, view.vertex_bits);
    const auto* records = reinterpret_cast<const std::uint8_t*>(view.words.data() + view.records_word());
    PackedRecord out;
    out.first = block * LR_PACKED_BLOCK;
    out.triangles = std::min(view.triangles - out.first, LR_PACKED_BLOCK);
    out.turns = view.words.data() + LR_PACKED_HEADER_WORDS + std::size_t{block} * LR_PACKED_BLOCK_WORDS;
    out.record = records + offset;
    out.length = length(member);
    out.plain = out.length == LR_PACKED_PLAIN;
    if (out.length > LR_PACKED_MAX_RECORD && !out.plain) {
        const std::uint32_t part = triangle % LR_PACKED_BLOCK / LR_PACKED_PART;
        const std::uint8_t* lengths = out.record;
        out.record += LR_PACKED_PARTS;
        for (std::uint32_t i = 0; i < part; ++i) out.record += lengths[i];
        out.length = lengths[part];
        out.first += part * LR_PACKED_PART;
        out.triangles = std::min(view.triangles - out.first, LR_PACKED_PART);
        out.turns += part * LR_PACKED_PART_WORDS;
    }
    return out;
}

bool expand_record(const PackedView& view, const PackedRecord& record, std::uint32_t count, std::uint32_t* out) {
    if (record.plain) {
        const std::uint32_t w = view.vertex_bits;
        for (std::uint32_t i = 0; i < 3 * count; ++i) {
            std::uint64_t value = 0;
            const std::uint32_t first = i * w / 8, last = (i * w + w - 1) / 8;
            for (std::uint32_t k = first; k <= last; ++k) value |= std::uint64_t{record.record[k]} << (8 * (k - first));
            out[i] = static_cast<std::uint32_t>(value >> (i * w % 8) & ((std::uint64_t{1} << w) - 1));
        }
        return true;
    }
    return Expander(view, record, count, out).expand();
}

}  // namespace lacedring
