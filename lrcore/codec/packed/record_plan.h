#pragma once
// A packed record's entry, events and warts, before they are written as bits.

#include <cstdint>
#include <vector>

namespace lacedring {

/// The edge entered: two vertices by their new numbers.
struct PackedEdge {
    std::uint32_t a, b;
    bool operator==(const PackedEdge&) const = default;
};

struct PackedEvent {
    std::uint8_t triangle;  ///< of the record
    std::uint8_t code;      ///< LR_PACKED_SPLIT, ...
    std::uint8_t choice;    ///< the small field of BESIDE, START, FAR
    bool reversed;          ///< of START any
    std::uint32_t v, w;     ///< the other fields, in the order in which they are written
};

/// A record: triangles [first, first + triangles) of the stream.
struct PackedRecordPlan {
    std::uint32_t first = 0, triangles = 0;
    PackedEdge entry{};
    bool reversed = false;
    std::vector<PackedEvent> events;
    std::vector<std::uint32_t> wart_gaps;  ///< candidates between one wart and the next
    std::uint32_t flips[8] = {};           ///< of FLIPS, bit t: triangle t
};

}  // namespace lacedring
