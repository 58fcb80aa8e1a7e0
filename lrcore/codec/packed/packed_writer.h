#pragma once
// Writes the steps of a walk as a packed stream.

#include <algorithm>
#include <optional>
#include <vector>

#include "lacedring/lacedring.hpp"
#include "lacedring/streams.hpp"
#include "lrcore/codec/packed/group_layout.h"
#include "lrcore/codec/packed/packed_c.h"
#include "lrcore/codec/packed/packed_format.h"
#include "lrcore/codec/packed/planner.h"

namespace lacedring {

/// Writes groups of blocks.
template <class Steps>
class GroupWriter {
  public:
    GroupWriter(Planner<Steps>& planner, std::uint32_t triangles, std::uint32_t vertex_bits,
                PackedStatistics& statistics)
        : planner_(planner),
          triangles_(triangles),
          vertex_bits_(vertex_bits),
          statistics_(statistics),
          layout_(vertex_bits) {}

    /// Appends the group that begins at block `block`.
    void write(std::uint32_t block, std::vector<std::uint8_t>& out) {
        const std::uint32_t end =
            std::min(block + LR_PACKED_GROUP, (triangles_ + LR_PACKED_BLOCK - 1) / LR_PACKED_BLOCK);
        records_.clear();
        for (std::uint32_t k = block; k < end; ++k) {
            const std::uint32_t first = k * LR_PACKED_BLOCK;
            records_.push_back(planner_.plan(first, std::min(first + LR_PACKED_BLOCK, triangles_)));
        }
        codes_ = choose_codes(records_);
        bodies_.clear();
        blocks_.clear();
        for (const PackedRecordPlan& record : records_) {
            const std::uint32_t kind = write_records(record, record.first, record.first + record.triangles);
            blocks_.push_back({kind, record.entry, record.reversed, static_cast<std::uint32_t>(bodies_.size())});
        }
        layout_.write(blocks_, bodies_, codes_, out);
    }

  private:
    /// Appends the block's records to bodies_ and returns the block's kind.
    std::uint32_t write_records(const PackedRecordPlan& record, std::uint32_t first, std::uint32_t end) {
        const PackedStatistics before = statistics_;
        const std::vector<std::uint8_t>& whole = bytes_of(record, false);
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
            const std::vector<std::uint8_t>& bytes = bytes_of(of_part, part > 0);
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
            const PackedEdge e = planner_.edge(i);
            const std::uint32_t x = planner_.third(i);
            const bool r = planner_.comes_reversed(i);
            for (const std::uint32_t v : {e.a, r ? x : e.b, r ? e.b : x}) bits_.put(v, vertex_bits_);
        }
        const std::vector<std::uint8_t>& bytes = bits_.finish();
        bodies_.insert(bodies_.end(), bytes.begin(), bytes.end());
        return LR_PACKED_PLAIN;
    }

    const std::vector<std::uint8_t>& bytes_of(const PackedRecordPlan& record, bool has_entry) {
        bits_.clear();
        write_record(record, codes_, vertex_bits_, has_entry, bits_, statistics_);
        return bits_.finish();
    }

    Planner<Steps>& planner_;
    std::uint32_t triangles_, vertex_bits_;
    PackedStatistics& statistics_;
    GroupCodes codes_;
    GroupLayout layout_;
    std::vector<PackedRecordPlan> records_;
    std::vector<PackedBlockPlan> blocks_;
    std::vector<std::uint8_t> bodies_;
    BitWriter bits_;
};

/// The stream of all steps, without doubles. Steps: as for Planner. Cost: O(T). Errors: too_large.
template <class Steps>
Result<std::vector<std::uint32_t>> write_packed(const Steps& steps, std::uint32_t vertices,
                                                PackedStatistics& statistics) {
    const std::uint32_t triangles = steps.size(), vertex_bits = packed_vertex_bits(vertices);
    std::vector<std::uint32_t> words = begin_packed(vertices, triangles);
    Planner<Steps> planner(steps, vertex_bits, words.data() + LR_PACKED_HEADER_WORDS);
    GroupWriter<Steps> writer(planner, triangles, vertex_bits, statistics);
    const std::size_t blocks = (std::size_t{triangles} + LR_PACKED_BLOCK - 1) / LR_PACKED_BLOCK;
    const std::size_t table = words.size() - (blocks + LR_PACKED_GROUP - 1) / LR_PACKED_GROUP;  // group 0 has no word
    std::vector<std::uint8_t> groups;
    for (std::size_t block = 0; block < blocks; block += LR_PACKED_GROUP) {
        if (groups.size() / 4 > UINT32_MAX) return Error{ErrorCode::too_large, "packed stream: groups of 16 GiB"};
        if (block > 0) words[table + block / LR_PACKED_GROUP] = static_cast<std::uint32_t>(groups.size() / 4);
        writer.write(static_cast<std::uint32_t>(block), groups);
    }
    finish_packed(words, groups);
    return words;
}

}  // namespace lacedring
