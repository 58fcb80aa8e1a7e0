#pragma once
// From a corner table and its rings to a packed stream (packed_stream.h).

#include <cstdint>
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

}  // namespace lr
