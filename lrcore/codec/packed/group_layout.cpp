#include "lrcore/codec/packed/group_layout.h"

#include <algorithm>
#include <cstring>

#include "lacedring/streams.hpp"
#include "lrcore/codec/packed/packed_format.h"

namespace lacedring {
namespace {

/// The argument below `end` with the least `cost`.
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

/// Bits of a Rice code. A reader accepts at most 31 ones. Codes with at least one low bit never need more in the
/// records of parts, which are planned later.
std::uint64_t rice_bits(std::uint32_t gap, std::uint32_t low) {
    static_assert((LR_PACKED_PART - 1) >> 1 <= 31);
    return low == 0 || gap >> low > 31 ? UINT32_MAX : std::uint64_t{gap >> low} + 1 + low;
}

void write_event(const PackedRecordPlan& r, const PackedEvent& e, const GroupCodes& codes, std::uint32_t vertex_bits,
                 BitWriter& bits) {
    bits.put_unary(e.code);
    switch (e.code) {
        case LR_PACKED_SPLIT:
            bits.put_golomb(e.v, codes.split_order);
            break;
        case LR_PACKED_JUMP:
            bits.put_golomb(e.v, LR_PACKED_JUMP_ORDER);
            bits.put(e.choice, 1);
            if (e.choice == 1) bits.put_golomb(e.w, LR_PACKED_FAR_ORDER);
            break;
        case LR_PACKED_FAR:
            bits.put(e.choice, 2);
            bits.put(e.v, vertex_bits);
            if (e.choice == 3) bits.put_golomb(e.w, LR_PACKED_FAR_ORDER);
            break;
        case LR_PACKED_BESIDE:
            bits.put(e.choice, 3);
            bits.put_golomb(e.v, LR_PACKED_BESIDE_ORDER);
            bits.put(e.w, vertex_bits);
            break;
        case LR_PACKED_START:
            if (e.choice == LR_PACKED_START_ANY) {
                bits.put(0x7, 3);
                bits.put(e.v, vertex_bits);
                bits.put(e.w, vertex_bits);
                bits.put(e.reversed ? 1 : 0, 1);
            } else {
                bits.put_unary(e.choice);
                if (e.choice == LR_PACKED_START_NEAR) bits.put_golomb(e.v, LR_PACKED_SIZE_ORDER);
                if (e.choice != LR_PACKED_START_OTHER) bits.put_golomb(e.w, LR_PACKED_SIZE_ORDER);
            }
            break;
        case LR_PACKED_FLIPS:
            for (std::uint32_t i = 0; i < r.triangles; ++i) bits.put(r.flips[i / 32] >> (i % 32) & 1, 1);
            break;
        default:
            break;
    }
}

}  // namespace

GroupCodes choose_codes(std::span<const PackedRecordPlan> records) {
    GroupCodes codes;
    codes.gap_bits = cheapest(8, [&](std::uint32_t low) {
        std::uint64_t bits = low == 0 ? 1 : 0;
        for (const PackedRecordPlan& r : records) {
            for_each_gap(r, [&](const PackedEvent&, std::uint32_t gap) { bits += rice_bits(gap, low); });
        }
        return bits;
    });
    codes.wart_bits = cheapest(8, [&](std::uint32_t low) {
        std::uint64_t bits = low == 0 ? 1 : 0;
        for (const PackedRecordPlan& r : records) {
            for (const std::uint32_t gap : r.wart_gaps) bits += rice_bits(gap, low);
        }
        return bits;
    });
    codes.split_order = cheapest(4, [&](std::uint32_t order) {
        std::uint64_t bits = 0;
        for (const PackedRecordPlan& r : records) {
            for (const PackedEvent& e : r.events) {
                if (e.code == LR_PACKED_SPLIT) bits += BitWriter::golomb_bits(e.v, order);
            }
        }
        return bits;
    });
    codes.count_order = cheapest(4, [&](std::uint32_t order) {
        std::uint64_t bits = 0;
        for (const PackedRecordPlan& r : records) {
            if (!r.events.empty() || !r.wart_gaps.empty()) {
                bits += BitWriter::golomb_bits(static_cast<std::uint32_t>(r.events.size()), order);
            }
        }
        return bits;
    });
    return codes;
}

void write_record(const PackedRecordPlan& record, const GroupCodes& codes, std::uint32_t vertex_bits, bool has_entry,
                  BitWriter& out, PackedStatistics& statistics) {
    if (has_entry) {
        out.put(record.entry.a, vertex_bits);
        out.put(record.entry.b, vertex_bits);
        out.put(record.reversed ? 1 : 0, 1);
    }
    if (!has_entry && record.events.empty() && record.wart_gaps.empty()) return;
    out.put_golomb(static_cast<std::uint32_t>(record.events.size()), codes.count_order);
    for_each_gap(record, [&](const PackedEvent& e, std::uint32_t gap) {
        const std::size_t begin = out.bits();
        out.put_rice(gap, codes.gap_bits);
        write_event(record, e, codes, vertex_bits, out);
        ++statistics.events[e.code];
        statistics.event_bits[e.code] += out.bits() - begin;
    });
    const std::size_t begin = out.bits();
    for (const std::uint32_t gap : record.wart_gaps) out.put_rice(gap, codes.wart_bits);
    statistics.warts += static_cast<std::uint32_t>(record.wart_gaps.size());
    statistics.wart_bits += out.bits() - begin;
}

/// Fills entries_; returns the bits they take with `bits` bits per step.
std::uint64_t GroupLayout::set_entries(std::uint32_t bits) {
    const std::int32_t half = 1 << bits >> 1;
    entries_.assign(blocks_.size(), {});
    std::uint64_t cost = 0;
    std::size_t from = 0;
    bool begun = blocks_[0].kind != LR_PACKED_PLAIN;  // does a block so far have an entry?
    for (std::size_t k = 1; k < blocks_.size(); ++k) {
        cost += bits;
        if (blocks_[k].kind == LR_PACKED_PLAIN) {
            entries_[k].own = false;
            continue;
        }
        const PackedBlockPlan &before = blocks_[from], &r = blocks_[k];
        const auto blocks = static_cast<std::uint32_t>(k - from);
        const auto step = static_cast<std::int32_t>(r.entry.a - before.entry.a - blocks * (LR_PACKED_BLOCK / 2));
        const bool goes_on = begun && r.reversed == before.reversed &&
                             r.entry.b - r.entry.a == before.entry.b - before.entry.a - blocks * LR_PACKED_BLOCK;
        if (goes_on && step >= -half && (bits == 0 ? step == 0 : step < half)) {
            entries_[k] = {false, step};
            continue;
        }
        from = k;
        begun = true;
        cost += 2 * vertex_bits_ + 1;
    }
    return cost;
}
void GroupLayout::choose_entries() {
    entry_bits_ = cheapest(LR_PACKED_MAX_ENTRY_BITS + 1, [&](std::uint32_t bits) { return set_entries(bits); });
    set_entries(entry_bits_);
}

/// Chooses the fewest offset bits with which one step size can express the end of every record.
void GroupLayout::choose_offsets() {
    for (offset_bits_ = 0;; ++offset_bits_) {
        const std::int64_t half = 1 << offset_bits_ >> 1, most = std::max<std::int64_t>(half - 1, 0);
        std::int64_t least = 0, greatest = (1 << LR_PACKED_STEP_FIELD) - 1;
        for (std::size_t k = 0; k < blocks_.size(); ++k) {
            const auto n = static_cast<std::int64_t>(k + 1);
            least = std::max(least, (std::int64_t{blocks_[k].end} - most + n - 1) / n);
            greatest = std::min(greatest, (std::int64_t{blocks_[k].end} + half) / n);
        }
        if (least > greatest) continue;
        step_ = static_cast<std::uint32_t>(least);
        return;
    }
}

void GroupLayout::write(std::span<const PackedBlockPlan> blocks, std::span<const std::uint8_t> bodies,
                        const GroupCodes& codes, std::vector<std::uint8_t>& out) {
    blocks_ = blocks;
    choose_entries();
    choose_offsets();
    head_.clear();
    head_.put(step_, LR_PACKED_STEP_FIELD);
    head_.put(offset_bits_, LR_PACKED_OFFSET_FIELD);
    head_.put(entry_bits_, LR_PACKED_ENTRY_FIELD);
    head_.put(codes.gap_bits, LR_PACKED_GAP_FIELD);
    head_.put(codes.wart_bits, LR_PACKED_WART_FIELD);
    head_.put(codes.split_order, LR_PACKED_SPLIT_FIELD);
    head_.put(codes.count_order, LR_PACKED_COUNT_FIELD);
    const bool has_kinds = std::ranges::any_of(blocks, [](const auto& b) { return b.kind != LR_PACKED_RECORD; });
    head_.put(has_kinds ? 1 : 0, LR_PACKED_KINDS_FIELD);
    for (std::size_t k = 1; k < blocks.size(); ++k) head_.put(entries_[k].own ? 1 : 0, 1);
    for (std::size_t k = 0; k < blocks.size(); ++k) {
        if (!entries_[k].own) continue;
        const PackedBlockPlan& b = blocks[k];
        const bool plain = b.kind == LR_PACKED_PLAIN;
        head_.put(plain ? 0 : b.entry.a, vertex_bits_);
        head_.put(plain ? 0 : b.entry.b, vertex_bits_);
        head_.put(!plain && b.reversed ? 1 : 0, 1);
    }
    for (const PackedBlockPlan& b : blocks) head_.put(b.kind, has_kinds ? LR_PACKED_KIND_BITS : 0);
    for (std::size_t k = 0; k < blocks.size(); ++k) {
        const std::uint32_t middle = 1U << offset_bits_ >> 1;
        head_.put(blocks[k].end + middle - static_cast<std::uint32_t>(k + 1) * step_, offset_bits_);
    }
    for (std::size_t k = 1; k < blocks.size(); ++k) {
        const std::uint32_t middle = 1U << entry_bits_ >> 1;
        const bool says = !entries_[k].own && blocks[k].kind != LR_PACKED_PLAIN;
        head_.put(says ? static_cast<std::uint32_t>(entries_[k].step) + middle : 0, entry_bits_);
    }
    const std::vector<std::uint8_t>& head = head_.finish();
    out.insert(out.end(), head.begin(), head.end());
    out.insert(out.end(), bodies.begin(), bodies.end());
    out.resize((out.size() + 3) / 4 * 4, 0);
}

std::vector<std::uint32_t> begin_packed(std::uint32_t vertices, std::uint32_t triangles) {
    PackedView view;
    view.triangles = view.own = triangles;
    std::vector<std::uint32_t> words(view.groups_word());
    words[LR_PACKED_WORD_MAGIC] = LR_PACKED_MAGIC;
    words[LR_PACKED_WORD_VERTICES] = vertices;
    words[LR_PACKED_WORD_TRIANGLES] = triangles;
    return words;
}

void finish_packed(std::vector<std::uint32_t>& words, std::span<const std::uint8_t> groups) {
    const std::size_t begin = words.size();
    words.resize(begin + groups.size() / 4);
    if (!groups.empty()) std::memcpy(words.data() + begin, groups.data(), groups.size());
    words[LR_PACKED_WORD_CHECKSUM] = packed_checksum(words);
}

}  // namespace lacedring
