#include "lrcore/codec/storage/packed_steps.h"

#include <algorithm>
#include <array>
#include <unordered_map>
#include <utility>

#include "lrcore/codec/bit_reader.h"
#include "lrcore/codec/packed/packed_format.h"

namespace lacedring::storage {
namespace {

struct Entry {
    PackedEdge edge{};
    bool reversed = false;
};

struct Scope {
    std::uint32_t end;
    Entry rest;
};

class StepReader {
  public:
    explicit StepReader(const PackedView& view)
        : view_(view), groups_(view.words.subspan(view.groups_word())), bits_(view.vertex_bits) {}

    PackedSteps read() {
        out_.reserve(view_.own);
        const std::uint32_t blocks = (view_.own + LR_PACKED_BLOCK - 1) / LR_PACKED_BLOCK;
        for (std::uint32_t block = 0; block < blocks; block += LR_PACKED_GROUP) {
            read_group(block, std::min(LR_PACKED_GROUP, blocks - block));
        }
        if (!plain_.empty()) find_plain();
        return std::move(out_);
    }

  private:
    void read_group(std::uint32_t first, std::uint32_t blocks) {
        const std::uint32_t group = first / LR_PACKED_GROUP;
        const std::uint64_t begin = group == 0 ? 0 : std::uint64_t{32} * view_.words[view_.table_word() + group - 1];
        BitReader head(groups_, begin, std::uint64_t{32} * groups_.size());
        const std::uint32_t step = head.take(LR_PACKED_STEP_FIELD);
        const std::uint32_t offset_bits = head.take(LR_PACKED_OFFSET_FIELD);
        const std::uint32_t entry_bits = head.take(LR_PACKED_ENTRY_FIELD);
        gap_bits_ = head.take(LR_PACKED_GAP_FIELD);
        wart_bits_ = head.take(LR_PACKED_WART_FIELD);
        split_order_ = head.take(LR_PACKED_SPLIT_FIELD);
        count_order_ = head.take(LR_PACKED_COUNT_FIELD);
        const bool has_kinds = head.take(LR_PACKED_KINDS_FIELD) != 0;
        std::array<bool, LR_PACKED_GROUP> own{true};
        std::array<Entry, LR_PACKED_GROUP> entries;
        std::array<std::uint32_t, LR_PACKED_GROUP> kinds{}, ends{};
        for (std::uint32_t k = 1; k < blocks; ++k) own[k] = head.take(1) != 0;
        for (std::uint32_t k = 0; k < blocks; ++k) {
            if (own[k]) entries[k] = take_entry(head);
        }
        for (std::uint32_t k = 0; k < blocks && has_kinds; ++k) kinds[k] = head.take(LR_PACKED_KIND_BITS);
        for (std::uint32_t k = 0; k < blocks; ++k) {
            ends[k] = (k + 1) * step + head.take(offset_bits) - (1U << offset_bits >> 1);
        }
        std::uint32_t from = 0;
        for (std::uint32_t k = 1; k < blocks; ++k) {
            const std::uint32_t said = head.take(entry_bits);
            if (own[k]) from = k;
            if (own[k]) continue;
            const PackedEdge& e = entries[from].edge;
            const std::uint32_t apart = k - from,
                                a = e.a + apart * (LR_PACKED_BLOCK / 2) + said - (1U << entry_bits >> 1);
            entries[k] = {{a, a + (e.b - e.a) - apart * LR_PACKED_BLOCK}, entries[from].reversed};
        }
        const std::uint64_t records = 8 * ((head.at() + 7) / 8);
        for (std::uint32_t k = 0; k < blocks; ++k) {
            const std::uint64_t at = records + (k == 0 ? 0 : std::uint64_t{8} * ends[k - 1]);
            const std::uint32_t triangle = (first + k) * LR_PACKED_BLOCK;
            const std::uint32_t end = std::min(triangle + LR_PACKED_BLOCK, view_.own);
            if (kinds[k] == LR_PACKED_PLAIN) {
                read_plain(at, triangle, end);
            } else if (kinds[k] == LR_PACKED_RECORD) {
                BitReader bits(groups_, at, records + std::uint64_t{8} * ends[k]);
                read_record(bits, entries[k], triangle, end, false);
            } else {
                read_parts(at, entries[k], triangle, end);
            }
        }
    }

    /// Reads the triangles of a plain block, which are (a, x, b) or (a, b, x). Assumes (a, b, x); find_plain() decides.
    void read_plain(std::uint64_t at, std::uint32_t triangle, std::uint32_t end) {
        plain_.push_back({triangle, end});
        BitReader bits(groups_, at, at + std::uint64_t{3} * (end - triangle) * bits_);
        for (; triangle < end; ++triangle) {
            const std::uint32_t a = bits.take(bits_), second = bits.take(bits_);
            out_.add({a, second}, bits.take(bits_), 0);
        }
    }

    /// Decides for each triangle of a plain block whether it is (a, x, b) or (a, b, x): the form whose edge (a, b) an
    /// earlier step left open, most recently if both are open. If neither is open, takes the form of the previous
    /// triangle. This is a guess: store_packed restores the stream and compares.
    void find_plain() {
        const auto key = [](std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; };
        // By edge: 1 + the step that left it open.
        std::unordered_map<std::uint64_t, std::uint32_t> open;
        open.reserve(view_.own);
        const auto left_by = [&](std::uint32_t a, std::uint32_t b) {
            const auto found = open.find(key(a, b));
            return found == open.end() ? 0 : found->second;
        };
        auto plain = plain_.begin();
        for (std::uint32_t i = 0; i < out_.size(); ++i) {
            PackedSteps::Step& s = out_.step(i);
            if (plain != plain_.end() && i == plain->end) ++plain;
            if (plain != plain_.end() && i >= plain->first) {
                const std::uint32_t by_x = left_by(s.edge.a, s.third), by_b = left_by(s.edge.a, s.edge.b);
                const bool as_before = i > 0 && out_.on_right(i - 1);
                if (by_x > by_b || (by_x == by_b && as_before)) {
                    std::swap(s.edge.b, s.third);
                    out_.flags_of(i) = CorridorStep::kRight;
                }
            }
            open.erase(key(s.edge.a, s.edge.b));
            open[key(s.edge.a, s.third)] = open[key(s.third, s.edge.b)] = i + 1;
        }
    }

    void read_parts(std::uint64_t at, Entry entry, std::uint32_t triangle, std::uint32_t end) {
        BitReader lengths(groups_, at, at + 32);
        at += 32;
        for (std::uint32_t part = 0; triangle < end; ++part, triangle += LR_PACKED_PART) {
            const std::uint64_t part_end = at + std::uint64_t{8} * lengths.take(8);
            BitReader bits(groups_, at, part_end);
            if (part > 0) entry = take_entry(bits);
            read_record(bits, entry, triangle, std::min(triangle + LR_PACKED_PART, end), part > 0);
            at = part_end;
        }
    }

    Entry take_entry(BitReader& bits) const {
        Entry out;
        out.edge.a = bits.take(bits_);
        out.edge.b = bits.take(bits_);
        out.reversed = bits.take(1) != 0;
        return out;
    }

    bool turn(std::uint32_t i) const { return (view_.words[LR_PACKED_HEADER_WORDS + i / 32] >> (i % 32) & 1) != 0; }

    PackedEvent take_event(BitReader& bits, std::uint32_t& at, std::uint32_t first, std::uint32_t end) {
        PackedEvent e{};
        at += bits.rice(gap_bits_);
        e.triangle = static_cast<std::uint8_t>(at);
        e.code = static_cast<std::uint8_t>(bits.unary(LR_PACKED_EVENT_CODES));
        switch (e.code) {
            case LR_PACKED_SPLIT:
                e.v = 3 + bits.golomb(split_order_);
                e.w = e.v - 1;
                break;
            case LR_PACKED_JUMP:
                e.v = 2 + bits.golomb(LR_PACKED_JUMP_ORDER);
                e.choice = static_cast<std::uint8_t>(bits.take(1));
                if (e.choice == 1) e.w = 1 + bits.golomb(LR_PACKED_FAR_ORDER);
                break;
            case LR_PACKED_FAR:
                e.choice = static_cast<std::uint8_t>(bits.take(2));
                e.v = bits.take(bits_);
                if (e.choice == 3) e.w = 1 + bits.golomb(LR_PACKED_FAR_ORDER);
                break;
            case LR_PACKED_BESIDE:
                e.choice = static_cast<std::uint8_t>(bits.take(3));
                e.v = bits.golomb(LR_PACKED_BESIDE_ORDER);
                e.w = bits.take(bits_);
                break;
            case LR_PACKED_START:
                e.choice = static_cast<std::uint8_t>(bits.unary(3));
                if (e.choice == LR_PACKED_START_ANY) {
                    e.v = bits.take(bits_);
                    e.w = bits.take(bits_);
                    e.reversed = bits.take(1) != 0;
                } else {
                    e.v = e.choice == LR_PACKED_START_NEAR ? bits.golomb(LR_PACKED_SIZE_ORDER) : 1;
                    e.w = e.choice == LR_PACKED_START_OTHER ? 0 : 2 + bits.golomb(LR_PACKED_SIZE_ORDER);
                }
                break;
            case LR_PACKED_FLIPS:
                flips_.assign(end - first, false);
                for (std::uint32_t i = 0; i < end - first; ++i) flips_[i] = bits.take(1) != 0;
                break;
            default:
                break;
        }
        if (e.code == LR_PACKED_SPLIT || e.code == LR_PACKED_JUMP || e.code == LR_PACKED_FAR) ++at;
        return e;
    }

    /// Reads the record of triangles [first, end); a record without content has no bits.
    void read_record(BitReader& bits, const Entry& entry, std::uint32_t first, std::uint32_t end, bool has_entry) {
        events_.clear();
        flips_.clear();
        warts_.assign(end - first, false);
        if (has_entry || !bits.is_at_end()) {
            const std::uint32_t count = bits.golomb(count_order_);
            for (std::uint32_t k = 0, at = 0; k < count; ++k) events_.push_back(take_event(bits, at, first, end));
            read_warts(bits, first, end);
        }
        now_ = begun_ = entry;
        finished_ = false;
        scopes_.clear();
        auto event = events_.begin();
        for (std::uint32_t i = first; i < end; ++i) {
            while (!scopes_.empty() && scopes_.back().end == i) {
                now_ = scopes_.back().rest;
                finished_ = false;
                scopes_.pop_back();
            }
            for (; event != events_.end() && first + event->triangle == i && comes_before(*event); ++event) {
                begin(*event);
            }
            if (finished_) repeat();
            const bool third = event != events_.end() && first + event->triangle == i;
            if (third) {
                take_third(*event++, i, first, end);
            } else if (warts_[i - first]) {
                const auto [a, b] = now_.edge;
                const bool up = turn(i);
                add(i, first, now_.edge, up ? a + 2 : b - 2);
                if (i + 1 < end) {
                    ++i;
                    add(i, first, up ? PackedEdge{a, a + 2} : PackedEdge{b - 2, b}, up ? a + 1 : b - 1);
                    (up ? now_.edge.a : now_.edge.b) += up ? 2U : 0U - 2U;
                }
            } else {
                take_turn(i, first);
            }
        }
    }

    static bool comes_before(const PackedEvent& e) {
        return e.code == LR_PACKED_FLIPS || e.code == LR_PACKED_START || e.code == LR_PACKED_BESIDE ||
               e.code == LR_PACKED_TURN;
    }

    void read_warts(BitReader& bits, std::uint32_t first, std::uint32_t end) {
        std::uint32_t left = bits.rice(wart_bits_);
        for (std::uint32_t i = first; i < end && left != UINT32_MAX; ++i) {
            if (i + 1 < end && turn(i) != turn(i + 1)) continue;
            if (left-- > 0) continue;
            warts_[i - first] = true;
            left = bits.rice(wart_bits_);
        }
    }

    void begin(const PackedEvent& e) {
        if (e.code == LR_PACKED_FLIPS) return;
        if (e.code == LR_PACKED_TURN) {
            now_.reversed = !now_.reversed;
            return;
        }
        Entry next = begun_;
        const PackedEdge before = begun_.edge;
        if (e.code == LR_PACKED_BESIDE) {
            const std::uint32_t step = (e.v & 1) != 0 ? ~(e.v >> 1) : e.v >> 1, from = e.choice >> 1;
            const std::array<std::uint32_t, 4> origin{now_.edge.b, now_.edge.a, before.a, before.b};
            const std::uint32_t near = origin[from] + step;
            const bool counts_a = from == LR_PACKED_BESIDE_NOW_B || from == LR_PACKED_BESIDE_BEGUN_A;
            next.edge = counts_a ? PackedEdge{near, e.w} : PackedEdge{e.w, near};
            next.reversed = now_.reversed != ((e.choice & 1) != 0);
        } else if (e.choice == LR_PACKED_START_ANY) {
            next = {{e.v, e.w}, e.reversed};
        } else if (e.choice == LR_PACKED_START_OTHER) {
            next.reversed = !begun_.reversed;
        } else {
            next.edge.a = before.b + e.v;
            next.edge.b = next.edge.a + e.w;
            next.reversed = e.choice != LR_PACKED_START_NEXT && begun_.reversed;
        }
        now_ = next;
        finished_ = false;
        if (scopes_.empty()) begun_ = next;
    }

    /// Continues with the polygon after the last one begun, with the same size.
    void repeat() {
        const std::uint32_t size = begun_.edge.b - begun_.edge.a;
        now_.edge.a = begun_.edge.b + 1;
        now_.edge.b = now_.edge.a + size;
        finished_ = false;
        if (scopes_.empty()) begun_.edge = now_.edge;
    }

    void take_third(const PackedEvent& e, std::uint32_t i, std::uint32_t first, std::uint32_t end) {
        const auto [a, b] = now_.edge;
        const bool up = turn(i);
        const std::uint32_t x = e.code == LR_PACKED_FAR ? e.v : up ? a + e.v : b - e.v;
        const bool both = e.code == LR_PACKED_SPLIT || (e.code == LR_PACKED_JUMP && e.choice == 1);
        const std::uint32_t enters = e.code == LR_PACKED_FAR ? e.choice : both ? 3 : up ? 2 : 1;
        add(i, first, now_.edge, x);
        if ((enters & 1) != 0) out_.flags_of(i) |= CorridorStep::kEnterA;
        if ((enters & 2) != 0) out_.flags_of(i) |= CorridorStep::kEnterB;
        if (enters == 3 && up) out_.flags_of(i) |= CorridorStep::kFirstA;
        const Entry rest{up ? PackedEdge{x, b} : PackedEdge{a, x}, now_.reversed};
        const bool along_b = enters == 3 ? !up : enters == 2;
        (along_b ? now_.edge.a : now_.edge.b) = x;
        finished_ = enters == 0;
        if (e.w > 0 && e.w < end - (i + 1)) scopes_.push_back({i + 1 + e.w, rest});
    }

    void take_turn(std::uint32_t i, std::uint32_t first) {
        const bool up = turn(i);
        const std::uint32_t x = up ? now_.edge.a + 1 : now_.edge.b - 1;
        add(i, first, now_.edge, x);
        (up ? now_.edge.a : now_.edge.b) = x;
        finished_ = now_.edge.b - now_.edge.a == 1;
    }

    void add(std::uint32_t i, std::uint32_t first, PackedEdge edge, std::uint32_t third) {
        const bool flip = !flips_.empty() && flips_[i - first];
        out_.add(edge, third, now_.reversed != flip ? CorridorStep::kRight : 0);
    }

    const PackedView& view_;
    std::span<const std::uint32_t> groups_;
    std::uint32_t bits_;
    std::uint32_t gap_bits_ = 0, wart_bits_ = 0, split_order_ = 0, count_order_ = 0;
    std::vector<PackedEvent> events_;
    std::vector<bool> warts_, flips_;  // per triangle of the record
    Entry now_, begun_;
    bool finished_ = false;
    std::vector<Scope> scopes_;
    struct Plain {
        std::uint32_t first, end;
    };
    std::vector<Plain> plain_;
    PackedSteps out_;
};

}  // namespace

PackedSteps read_steps(const PackedView& view) {
    return StepReader(view).read();
}

}  // namespace lacedring::storage
