#pragma once
// Finding and expanding one record of a packed stream: what every decoder here does.

#include <cstdint>

#include "lacedring/streams.hpp"
#include "lrcore/codec/packed/packed_format.h"

namespace lacedring {

/// Where the record lies that holds a triangle, and which triangles it holds.
struct PackedRecord {
    const std::uint32_t* turns;  ///< of its first triangle on
    const std::uint8_t* record;
    std::uint32_t length;  ///< in bytes, where it is not plain
    std::uint32_t first;   ///< triangle of the mesh
    std::uint32_t triangles;
    bool plain;
};

PackedRecord find_record(const PackedView& view, std::uint32_t triangle);

/// Bytes of a block's records by what the directory says.
constexpr std::uint32_t block_bytes(std::uint32_t length, std::uint32_t triangles, std::uint32_t vertex_bits) {
    if (length <= LR_PACKED_MAX_RECORD) return length;
    if (length < LR_PACKED_PLAIN) return 8 * (length - LR_PACKED_MAX_RECORD);
    return (3 * triangles * vertex_bits + 7) / 8;
}

/// Expands the first `count` triangles of a record into 3 * count indices. False where the record says something
/// impossible, after which some of `out` is not written. Whatever the record says, nothing else is written or read;
/// vertices may be out of range.
bool expand_record(const PackedView& view, const PackedRecord& record, std::uint32_t count, std::uint32_t* out);

}  // namespace lacedring
