#pragma once
// From a corner table and its rings to a lean stream (lean_stream.h). Paper: LR 2011, section 7 and section 5.

#include <cstdint>
#include <vector>

#include "lrcore/base/result.h"
#include "lrcore/ring/ring.h"
#include "lrcore/topology/corner_table.h"

namespace lr {

struct LeanOptions {
    bool wart_skipping = true;
};

/// What the triangles became. Counts are of triangles, and over all rings. Paper: section 4.3.
struct LeanStatistics {
    std::uint32_t ring_vertices = 0;
    std::uint32_t isolated = 0;   ///< vertices used by triangles, but on no ring
    std::uint32_t t0 = 0;         ///< verbatim because without a ring edge, after wart skipping
    std::uint32_t t0_wart = 0;    ///< T0 stored in the redundant copy of a T2
    std::uint32_t t2 = 0;         ///< with two ring edges (or all three)
    std::uint32_t irregular = 0;  ///< T1 and T2 that share an edge with a T0 left after wart skipping
    std::uint32_t unrung = 0;     ///< T1 and T2 stored verbatim because their ring, or its side, is not worth its slots
};

/// A lean stream and how it maps to the mesh that it was made from.
struct LeanStream {
    std::vector<std::uint32_t> words;          ///< header and payload (lean_format.h); this is the whole stream
    std::vector<std::uint32_t> vertex_order;   ///< vertex_order[new] = old, a permutation of the mesh's vertices
    std::vector<std::uint32_t> slot_triangle;  ///< triangle of the mesh at each slot, UINT32_MAX where degenerate
    LeanStatistics statistics;
};

/// Encodes every triangle of the table that is not degenerate.
/// Cost: O(T) time; 4 bytes a reference for the words, 4 for slot_triangle, 4 a vertex for vertex_order, 4 while it
/// runs. Errors: too_large (2^29 vertices, or 2^32 / 3 slots).
Result<LeanStream> encode_lean(const CornerTable& table, const Rings& rings, const LeanOptions& options = {});

}  // namespace lr
