#pragma once
// The packed stream: connectivity in little more than one bit a triangle, any block of 256 triangles on its own.
//
// Where the ring is a cycle, each side of it is a polygon cut into triangles, and walking the polygon from edge to edge
// needs a *turn bit* a triangle: with the edge (a, b) entered, the third vertex is a+1 or b-1, and is the new a or b.
// What a turn bit cannot say are *events*: a T0, whose third vertex lies further along and which splits the polygon in
// two, and the rare start of another polygon. docs/packed-format.md has all of it to the bit. Beyond the paper.

#include <cstddef>
#include <cstdint>
#include <span>

#include "lrcore/base/result.h"

namespace lr {

/// A packed stream somewhere in memory, its header read. Holds no copy.
struct PackedView {
    std::span<const std::uint32_t> words;  ///< all of it
    std::uint32_t vertices = 0;
    std::uint32_t triangles = 0;
    std::uint32_t record_bytes = 0;
    std::uint32_t vertex_bits = 0;
    std::uint32_t gap_bits = 0;

    std::uint32_t blocks() const;
    std::size_t directory_word() const;  ///< where the directory begins in `words`
    std::size_t records_word() const;    ///< where the records begin
    std::size_t bytes() const { return words.size_bytes(); }
};

/// CRC-32 of a stream without its checksum word. `words` is at least the header.
std::uint32_t packed_checksum(std::span<const std::uint32_t> words);

/// Reads the header of `words` and checks sizes only: call validate_packed on anything that was not just encoded.
/// Errors: malformed. Untrusted input: safe.
Result<PackedView> view_packed(std::span<const std::uint32_t> words);

/// Checks the checksum, the directory and every block: vertices in range, three different ones a triangle.
/// Cost: O(T). Untrusted input: safe.
Result<PackedView> validate_packed(std::span<const std::uint32_t> words);

/// Expands all triangles: indices holds 3 * view.triangles entries. The stream must be valid (validate_packed).
/// Cost: O(T), no allocation. Runs on at most `threads` threads, including the calling one; on fewer if the stream is
/// small or the system creates no more. Never throws.
void decode_packed(const PackedView& view, std::span<std::uint32_t> indices, unsigned threads = 1);

/// Expands one block: triangles [256 * block, ...), 3 * 256 entries or what the last block has.
void decode_packed_block(const PackedView& view, std::uint32_t block, std::span<std::uint32_t> indices);

/// One triangle. Reads at most 8 words of turn bits, 5 of the directory and 43 of the record, beside the header.
struct PackedTriangle {
    std::uint32_t v[3];
};
PackedTriangle decode_packed_triangle(const PackedView& view, std::uint32_t triangle);

}  // namespace lr
