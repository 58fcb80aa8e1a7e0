#pragma once
// Writes the bits of a group from planned records: chooses code parameters, writes the head and the records. Used by
// the encoder of packed streams and by the decoder of their storage form.

#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/lacedring.hpp"
#include "lrcore/codec/bit_writer.h"
#include "lrcore/codec/packed/record_plan.h"

namespace lacedring {

/// Parameters of a group's codes: the number of low bits, or the order.
struct GroupCodes {
    std::uint32_t gap_bits = 0, wart_bits = 0, split_order = 0, count_order = 0;
    bool operator==(const GroupCodes&) const = default;
};

/// The parameters with which the records take the fewest bits. gap_bits and wart_bits are at least 1.
GroupCodes choose_codes(std::span<const PackedRecordPlan> records);

/// Writes a record. `has_entry`: the record includes its entry, as all parts of a block except the first do. Adds the
/// sizes of its events and warts to `statistics`.
void write_record(const PackedRecordPlan& record, const GroupCodes& codes, std::uint32_t vertex_bits, bool has_entry,
                  BitWriter& out, PackedStatistics& statistics);

/// A block whose records have been written.
struct PackedBlockPlan {
    std::uint32_t kind = 0;  ///< LR_PACKED_RECORD, _PARTED or _PLAIN
    PackedEdge entry{};      ///< unused for plain blocks
    bool reversed = false;
    std::uint32_t end = 0;  ///< end of its bytes, among those of all blocks
};

/// Writes groups, one after the other.
class GroupLayout {
  public:
    explicit GroupLayout(std::uint32_t vertex_bits) : vertex_bits_(vertex_bits) {}

    /// Appends a group of `blocks`, whose records are the bytes `bodies`.
    void write(std::span<const PackedBlockPlan> blocks, std::span<const std::uint8_t> bodies, const GroupCodes& codes,
               std::vector<std::uint8_t>& out);

  private:
    /// A block's entry in the head: in full (own), or as a step relative to the last full entry. A step of 0 means that
    /// half of the turn bits since then are 1.
    struct Entry {
        bool own = true;
        std::int32_t step = 0;
    };

    std::uint64_t set_entries(std::uint32_t bits);
    void choose_entries();
    void choose_offsets();

    std::uint32_t vertex_bits_;
    std::span<const PackedBlockPlan> blocks_;
    std::uint32_t step_ = 0, offset_bits_ = 0, entry_bits_ = 0;
    std::vector<Entry> entries_;
    BitWriter head_;
};

/// The words of a stream before its groups: header, turn bits and table, with zeros in place of values not known yet.
std::vector<std::uint32_t> begin_packed(std::uint32_t vertices, std::uint32_t triangles);
/// Appends the groups and sets the checksum.
void finish_packed(std::vector<std::uint32_t>& words, std::span<const std::uint8_t> groups);

}  // namespace lacedring
