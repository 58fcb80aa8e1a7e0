#pragma once
// The packed stream: connectivity in little more than one bit a triangle, any block of 256 triangles on its own.
//
// Where the ring is a cycle, each side of it is a polygon cut into triangles, and walking the polygon from edge to edge
// needs a *turn bit* a triangle: with the edge (a, b) entered, the third vertex is a+1 or b-1, and is the new a or b.
// What a turn bit cannot say are *events*: a T0, whose third vertex lies further along and which splits the polygon in
// two, and the rare start of another polygon. docs/packed-format.md has all of it to the bit. Beyond the paper.

#include <cstdint>
#include <span>
#include <vector>

#include "lrcore/base/result.h"
#include "lrcore/ring/optimize.h"
#include "lrcore/ring/ring.h"
#include "lrcore/topology/corner_table.h"

namespace lr {

struct PackedStatistics {
    std::uint32_t ring_vertices = 0;
    std::uint32_t events[8] = {};      ///< by code (packed_format.h)
    std::uint64_t event_bits[8] = {};  ///< with their gaps
    std::uint32_t parted_blocks = 0;   ///< whose events are too many for one record
    std::uint32_t plain_blocks = 0;    ///< stored as three vertices a triangle
};

/// A packed stream and how it maps to the mesh that it was made from.
struct PackedStream {
    std::vector<std::uint32_t> words;           ///< the whole stream
    std::vector<std::uint32_t> vertex_order;    ///< vertex_order[new] = old, a permutation of the mesh's vertices
    std::vector<std::uint32_t> triangle_order;  ///< triangle_order[i] = the mesh's triangle decoded i-th
    PackedStatistics statistics;
};

enum class PackedProfile {
    small,  ///< the fewest bits
    cache,  ///< an order nearly as good for the vertex cache as the best, in about one bit and a half more
};

/// Encodes every triangle of the table that is not degenerate.
/// Cost: O(T) time; beside the result 5 bytes a triangle, 5 a vertex and 4 bits a triangle while it runs.
/// Errors: too_large (2^29 vertices; records of 4 GiB: at least 300 million triangles).
Result<PackedStream> encode_packed(const CornerTable& table, const Rings& rings,
                                   PackedProfile profile = PackedProfile::small);

/// The smaller of two streams: over the rings of expand_rings, and over these optimised. Errors: encode_packed's.
struct PackedChoice {
    PackedStream stream;
    std::uint32_t passes = 0;  ///< of the optimiser; 0 where its rings were no better
};
Result<PackedChoice> encode_smallest_packed(const CornerTable& table, const RingOptions& ring,
                                            const OptimizeOptions& optimize,
                                            PackedProfile profile = PackedProfile::small);

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
