// Writes the steps of walk_corridors as turn bits, events and warts. The writer keeps the state that a reader of the
// block has, and says in events whatever the next triangle needs and that state does not give.

#include <algorithm>
#include <array>
#include <bit>
#include <optional>

#include "lacedring/lacedring.hpp"
#include "lacedring/streams.hpp"
#include "lrcore/base/message.h"
#include "lrcore/codec/bit_writer.h"
#include "lrcore/codec/packed/corridors.h"
#include "lrcore/codec/packed/doubles.h"
#include "lrcore/codec/packed/packed_c.h"
#include "lrcore/codec/packed/packed_format.h"
#include "lrcore/codec/packed/planner.h"

namespace lacedring {
namespace {

using Edge = PackedEdge;

constexpr std::uint32_t kMostPackedVertices = 1U << 29;  // keeps folded BESIDE steps below 2^30

/// Widths and orders of one group.
struct GroupCodes {
    std::uint32_t step = 0, offset_bits = 0, entry_bits = 0;
    std::uint32_t gap_bits = 0, wart_bits = 0, split_order = 0, count_order = 0;
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
        bodies_.clear();
        ends_.clear();
        kinds_.clear();
        for (std::size_t k = 0; k < records_.size(); ++k) write_block(k);
        choose_entries();
        choose_offsets();

        head_.clear();
        head_.put(codes_.step, LR_PACKED_STEP_FIELD);
        head_.put(codes_.offset_bits, LR_PACKED_OFFSET_FIELD);
        head_.put(codes_.entry_bits, LR_PACKED_ENTRY_FIELD);
        head_.put(codes_.gap_bits, LR_PACKED_GAP_FIELD);
        head_.put(codes_.wart_bits, LR_PACKED_WART_FIELD);
        head_.put(codes_.split_order, LR_PACKED_SPLIT_FIELD);
        head_.put(codes_.count_order, LR_PACKED_COUNT_FIELD);
        const bool has_kinds = std::any_of(kinds_.begin(), kinds_.end(), [](auto k) { return k != LR_PACKED_RECORD; });
        head_.put(has_kinds ? 1 : 0, LR_PACKED_KINDS_FIELD);
        for (std::size_t k = 1; k < records_.size(); ++k) head_.put(entries_[k].own ? 1 : 0, 1);
        for (std::size_t k = 0; k < records_.size(); ++k) {
            if (!entries_[k].own) continue;
            const PackedRecordPlan& r = records_[k];
            const bool plain = kinds_[k] == LR_PACKED_PLAIN;
            head_.put(plain ? 0 : r.entry.a, vertex_bits_);
            head_.put(plain ? 0 : r.entry.b, vertex_bits_);
            head_.put(!plain && r.reversed ? 1 : 0, 1);
        }
        for (const std::uint32_t kind : kinds_) head_.put(kind, has_kinds ? LR_PACKED_KIND_BITS : 0);
        for (std::size_t k = 0; k < records_.size(); ++k) {
            const std::uint32_t middle = 1U << codes_.offset_bits >> 1;
            head_.put(ends_[k] + middle - static_cast<std::uint32_t>(k + 1) * codes_.step, codes_.offset_bits);
        }
        for (std::size_t k = 1; k < records_.size(); ++k) {
            const std::uint32_t middle = 1U << codes_.entry_bits >> 1;
            const bool says = !entries_[k].own && kinds_[k] != LR_PACKED_PLAIN;
            head_.put(says ? static_cast<std::uint32_t>(entries_[k].step) + middle : 0, codes_.entry_bits);
        }
        const std::vector<std::uint8_t>& head = head_.finish();
        out.insert(out.end(), head.begin(), head.end());
        out.insert(out.end(), bodies_.begin(), bodies_.end());
        out.resize((out.size() + 3) / 4 * 4, 0);
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

    /// How the head says a block's entry: in full (own), or as a step. The step is added to the a that the block would
    /// have if half of all turns since the last entry in full were 1.
    struct Entry {
        bool own = true;
        std::int32_t step = 0;
    };

    /// Into entries_; returns what they take with so many bits for a step.
    std::uint64_t set_entries(std::uint32_t bits) {
        const std::int32_t half = 1 << bits >> 1;
        entries_.assign(records_.size(), {});
        std::uint64_t cost = 0;
        std::size_t from = 0;
        bool begun = kinds_[0] != LR_PACKED_PLAIN;  // does any block say where it begins?
        for (std::size_t k = 1; k < records_.size(); ++k) {
            cost += bits;
            if (kinds_[k] == LR_PACKED_PLAIN) {
                entries_[k].own = false;
                continue;
            }
            const PackedRecordPlan &before = records_[from], &r = records_[k];
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
    void choose_entries() {
        codes_.entry_bits =
            cheapest(LR_PACKED_MAX_ENTRY_BITS + 1, [&](std::uint32_t bits) { return set_entries(bits); });
        set_entries(codes_.entry_bits);
    }

    /// The fewest bits with which some step leads near every end.
    void choose_offsets() {
        for (codes_.offset_bits = 0;; ++codes_.offset_bits) {
            const std::int64_t half = 1 << codes_.offset_bits >> 1, most = std::max<std::int64_t>(half - 1, 0);
            std::int64_t least = 0, greatest = (1 << LR_PACKED_STEP_FIELD) - 1;
            for (std::size_t k = 0; k < ends_.size(); ++k) {
                const auto n = static_cast<std::int64_t>(k + 1);
                least = std::max(least, (ends_[k] - most + n - 1) / n);
                greatest = std::min(greatest, (ends_[k] + half) / n);
            }
            if (least > greatest) continue;
            codes_.step = static_cast<std::uint32_t>(least);
            return;
        }
    }

    /// Appends the block's records to bodies_; sets its kind and where it ends.
    void write_block(std::size_t k) {
        const std::uint32_t first = records_[k].first, end = first + records_[k].triangles;
        kinds_.push_back(write_records(records_[k], first, end));
        ends_.push_back(static_cast<std::uint32_t>(bodies_.size()));
    }

    std::uint32_t write_records(const PackedRecordPlan& record, std::uint32_t first, std::uint32_t end) {
        const PackedStatistics before = statistics_;
        const std::vector<std::uint8_t>& whole = write_record(record, false);
        if (whole.size() <= LR_PACKED_MAX_RECORD) {
            bodies_.insert(bodies_.end(), whole.begin(), whole.end());
            return LR_PACKED_RECORD;
        }
        const std::size_t begin = bodies_.size();
        const std::uint32_t plain = (3 * (end - first) * vertex_bits_ + 7) / 8;
        statistics_ = before;
        bodies_.resize(begin + LR_PACKED_PARTS);
        bool fits = true;
        for (std::uint32_t part = 0; part < LR_PACKED_PARTS && first + part * LR_PACKED_PART < end; ++part) {
            const std::uint32_t from = first + part * LR_PACKED_PART;
            const PackedRecordPlan of_part = planner_.plan(from, std::min(from + LR_PACKED_PART, end),
                                                           part == 0 ? std::optional(record.reversed) : std::nullopt);
            const std::vector<std::uint8_t>& bytes = write_record(of_part, part > 0);
            fits = fits && bytes.size() <= LR_PACKED_MAX_PART;
            bodies_[begin + part] = static_cast<std::uint8_t>(bytes.size());
            bodies_.insert(bodies_.end(), bytes.begin(), bytes.end());
        }
        if (fits && bodies_.size() - begin < plain) {
            ++statistics_.parted_blocks;
            return LR_PACKED_PARTED;
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
        return LR_PACKED_PLAIN;
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
    std::vector<Entry> entries_;
    std::vector<std::uint32_t> ends_, kinds_;  // of each block: where it ends in bodies_; its kind
    std::vector<std::uint8_t> bodies_;
    BitWriter bits_, head_;
};

Result<EncodedPacked> write_stream(const CornerTable& table, const Corridors& corridors) {
    EncodedPacked out;
    const auto triangles = static_cast<std::uint32_t>(corridors.corners.size());
    const std::uint32_t vertex_bits = packed_vertex_bits(table.vertex_count);
    PackedView view;
    view.triangles = view.own = triangles;
    std::vector<std::uint32_t>& words = out.words;
    words.assign(view.groups_word(), 0);
    Planner planner(table, corridors, vertex_bits, words.data() + LR_PACKED_HEADER_WORDS);
    GroupWriter writer(planner, triangles, vertex_bits, out.statistics);
    std::vector<std::uint8_t> groups;
    for (std::uint32_t block = 0; block < view.blocks(); block += LR_PACKED_GROUP) {
        if (groups.size() / 4 > UINT32_MAX) return Error{ErrorCode::too_large, "packed stream: groups of 16 GiB"};
        if (block > 0) {
            words[view.table_word() + block / LR_PACKED_GROUP - 1] = static_cast<std::uint32_t>(groups.size() / 4);
        }
        writer.write(block, groups);
    }
    words.resize(words.size() + groups.size() / 4);
    std::copy(groups.begin(), groups.end(), reinterpret_cast<std::uint8_t*>(words.data() + view.groups_word()));
    words[LR_PACKED_WORD_MAGIC] = LR_PACKED_MAGIC;
    words[LR_PACKED_WORD_VERTICES] = table.vertex_count;
    words[LR_PACKED_WORD_TRIANGLES] = triangles;
    words[LR_PACKED_WORD_CHECKSUM] = packed_checksum(words);
    return out;
}

}  // namespace

Result<EncodedPacked> encode_packed(const CornerTable& table, const Rings& rings, PackedProfile profile) {
    if (table.vertex_count > kMostPackedVertices) {
        return Error{
            ErrorCode::too_large,
            detail::message(table.vertex_count, " vertices; a packed stream numbers at most ", kMostPackedVertices)};
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

namespace {

Result<PackedChoice> encode_smallest(const CornerTable& table, const RingOptions& ring, const OptimizeOptions& optimize,
                                     PackedProfile profile) {
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

}  // namespace

Result<PackedChoice> encode_smallest_packed(const CornerTable& table, const RingOptions& ring,
                                            const OptimizeOptions& optimize, PackedProfile profile) {
    const std::optional<Doubles> doubles = find_doubles(table);
    if (!doubles) return encode_smallest(table, ring, optimize, profile);
    Result<PackedChoice> out = encode_smallest(doubles->table, ring, optimize, profile);
    if (out) add_doubles(out->stream, *doubles);
    return out;
}

}  // namespace lacedring
