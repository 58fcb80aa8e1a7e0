#pragma once
// From planned records to the bits of a group: widths and orders, the head, the records. What writes a packed stream
// and what restores one from its storage form do so by this.

#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/lacedring.hpp"
#include "lrcore/codec/bit_writer.h"
#include "lrcore/codec/packed/record_plan.h"

namespace lacedring {

/// Low bits and orders of a group's codes.
struct GroupCodes {
    std::uint32_t gap_bits = 0, wart_bits = 0, split_order = 0, count_order = 0;
    bool operator==(const GroupCodes&) const = default;
};

/// The widths and orders with which the records take the fewest bits. gap_bits and wart_bits are 1 or more.
GroupCodes choose_codes(std::span<const PackedRecordPlan> records);

/// Writes a record. `has_entry`: it says its own entry, as all parts of a block but the first do. What its events and
/// warts take is added to `statistics`.
void write_record(const PackedRecordPlan& record, const GroupCodes& codes, std::uint32_t vertex_bits, bool has_entry,
                  BitWriter& out, PackedStatistics& statistics);

/// A block whose records are written.
struct PackedBlockPlan {
    std::uint32_t kind = 0;  ///< LR_PACKED_RECORD, ...
    PackedEdge entry{};      ///< not of plain ones
    bool reversed = false;
    std::uint32_t end = 0;  ///< of its bytes, in those of all blocks
};

/// Writes groups, one behind the other.
class GroupLayout {
  public:
    explicit GroupLayout(std::uint32_t vertex_bits) : vertex_bits_(vertex_bits) {}

    /// Appends a group of these blocks, whose bytes are `bodies`.
    void write(std::span<const PackedBlockPlan> blocks, std::span<const std::uint8_t> bodies, const GroupCodes& codes,
               std::vector<std::uint8_t>& out);

  private:
    /// A block's entry in the head: in full (own), or as a step from the last one that is in full. A step of 0 means
    /// that half of the turns since then are 1.
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

/// A stream up to its groups: header, turn bits and table, but for the checksum zeros where nothing is known yet.
std::vector<std::uint32_t> begin_packed(std::uint32_t vertices, std::uint32_t triangles);
/// Adds the groups and the checksum.
void finish_packed(std::vector<std::uint32_t>& words, std::span<const std::uint8_t> groups);

}  // namespace lacedring
