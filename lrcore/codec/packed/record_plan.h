#pragma once
// The entry, events and warts of a packed record, before they are written as bits.

#include <cstdint>
#include <vector>

namespace lacedring {

/// The edge across which a triangle is entered: two vertices by their new numbers.
struct PackedEdge {
    std::uint32_t a, b;
    bool operator==(const PackedEdge&) const = default;
};

struct PackedEvent {
    std::uint8_t triangle;  ///< its number in the record
    std::uint8_t code;      ///< LR_PACKED_SPLIT, ...
    std::uint8_t choice;    ///< the small field of BESIDE, START and FAR
    bool reversed;          ///< orientation, for LR_PACKED_START_ANY
    std::uint32_t v, w;     ///< the other fields, in the order of writing
};

/// A record: triangles [first, first + triangles) of the stream.
struct PackedRecordPlan {
    std::uint32_t first = 0, triangles = 0;
    PackedEdge entry{};
    bool reversed = false;
    std::vector<PackedEvent> events;
    std::vector<std::uint32_t> wart_gaps;  ///< number of candidates between two warts
    std::uint32_t flips[8] = {};           ///< field of FLIPS; bit t: triangle t is flipped
};

}  // namespace lacedring
