#pragma once
// Triangle meshes in one vertex reference a triangle, or in little more than one bit: encode() makes a stream of an
// index list, validate() and decode() (streams.hpp) give its triangles back. This header has everything of the
// library's core.
//
// The steps behind encode(), for those who want them one by one, are below it: build_corner_table (topology.hpp),
// expand_rings and optimize_rings (ring.hpp), encode_lean, encode_packed, build_lr.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "lacedring/base.hpp"
#include "lacedring/operators.hpp"
#include "lacedring/ring.hpp"
#include "lacedring/seams.hpp"
#include "lacedring/streams.hpp"
#include "lacedring/topology.hpp"
#include "lacedring/vertices.hpp"

namespace lacedring {

enum class PackedProfile {
    small,  ///< the fewest bits
    cache,  ///< an order nearly as good for the vertex cache as the best, in about one bit and a half more
};

/// Counts of triangles by how a lean stream stores them, over all rings. Paper: section 4.3.
struct LeanStatistics {
    std::uint32_t ring_vertices = 0;
    std::uint32_t isolated = 0;   ///< vertices used by triangles, but on no ring
    std::uint32_t t0 = 0;         ///< verbatim because without a ring edge, after wart skipping
    std::uint32_t t0_wart = 0;    ///< T0 stored in the redundant copy of a T2
    std::uint32_t t2 = 0;         ///< with two ring edges (or all three)
    std::uint32_t irregular = 0;  ///< T1 and T2 that share an edge with a T0 left after wart skipping
    std::uint32_t unrung = 0;     ///< T1 and T2 stored verbatim because their ring, or its side, is not worth its slots
};

/// Counts of a packed stream's events and blocks.
struct PackedStatistics {
    std::uint32_t ring_vertices = 0;
    std::uint32_t events[8] = {};      ///< by code (docs/packed-format.md)
    std::uint64_t event_bits[8] = {};  ///< with their gaps
    std::uint32_t warts = 0;
    std::uint64_t wart_bits = 0;
    std::uint32_t doubles = 0;        ///< triangles stored as another one's number
    std::uint32_t parted_blocks = 0;  ///< whose events are too many for one record
    std::uint32_t plain_blocks = 0;   ///< stored as three vertices a triangle
};

/// Counts of triangles by kind in LR tables, standard or bit-efficient. Paper: LR 2011, section 8.
struct LrStatistics {
    std::uint32_t t0 = 0, t0_wart = 0, t1_irregular = 0, t2_irregular = 0, t2 = 0, isolated = 0;
};

struct EncodeOptions {
    Format format = Format::packed;
    PackedProfile profile = PackedProfile::small;  ///< of packed; any other format has one profile
    bool wart_skipping = true;                     ///< of lean and lr; packed and lr_compact always do
    /// 0 to 9: how long to look for good rings. It decides seeds, passes and periods where they say nothing.
    std::uint32_t effort = 6;

    std::optional<std::uint32_t> seeds = {};  ///< RingOptions::seeds
    std::optional<std::uint32_t> passes =
        {};  ///< OptimizeOptions::passes; lr_compact takes its rings as they are found
    /// RingOptions::k: of lr_compact the values of which the best is kept, of any other format one or none.
    std::vector<std::uint32_t> periods = {};
    std::uint64_t random_seed = 1;
    unsigned threads = 1;  ///< run on at most that many, including the calling one; the same words for any

    /// Called after each pass of the optimizer, by the calling thread, with how many are done; false: stop, the best so
    /// far is encoded. Fewer passes are made where nothing is left to gain.
    /// lr_compact, which has no such passes, never calls it.
    std::function<bool(std::uint32_t)> progress = {};
};

/// The optimizer's passes for a format at that effort.
std::uint32_t passes_at(std::uint32_t effort, Format format);

/// How a mesh was encoded.
struct EncodeReport {
    Topology topology;            ///< how the triangles were joined; how many were degenerate and are left out
    std::uint32_t triangles = 0;  ///< in the stream
    std::uint32_t copies = 0;     ///< vertices of the stream beyond the mesh's: LR tables copy non-manifold ones
    std::uint32_t k = 0;          ///< RingOptions::k of the rings that were kept
    std::uint32_t passes = 0;     ///< asked of the optimizer; 0 where the rings are as they were found
    std::variant<LeanStatistics, PackedStatistics, LrStatistics> statistics;
};

/// A stream, and how it maps to the mesh that it was made from.
struct Encoded {
    Format format = Format::packed;
    std::vector<std::uint32_t> words;  ///< the whole stream
    /// vertex_order[new] = old: bring the vertices' attributes into this order. A permutation of the mesh's
    /// vertices; LR tables of a mesh with non-manifold vertices have entries that repeat (copies).
    std::vector<std::uint32_t> vertex_order;
    std::vector<std::uint32_t> triangle_order;  ///< triangle_order[i] = the mesh's triangle decoded i-th
    EncodeReport report;

    std::span<const std::byte> bytes() const { return std::as_bytes(std::span(words)); }
};

/// Encodes the triangles of `indices` (three each, below `vertex_count`): any triangle soup. Triangles with a
/// repeated vertex are left out; all others come back with their orientation. The same words on every machine.
/// Cost: O(T) time for each pass and seed; about 60 bytes a triangle. Errors: malformed (index out of range),
/// invalid_argument (a number of indices that is no multiple of three, an option out of its range), too_large.
Result<Encoded> encode(std::span<const std::uint32_t> indices, std::uint32_t vertex_count,
                       const EncodeOptions& options = {});

/// The same from a corner table that is there already. LR tables copy one that is not given up with std::move.
Result<Encoded> encode(const CornerTable& table, const EncodeOptions& options = {});
Result<Encoded> encode(CornerTable&& table, const EncodeOptions& options = {});

/// The seam section of a surface that encode() made a stream of. `indices` are those of the mesh with seams, and
/// vertex_of[v] the surface's vertex of each of the mesh's vertices: encode() got vertex_of[indices[i]] for each i.
/// copy_order[new] is the mesh's vertex of each copy; of a vertex without corners it is the one that the mesh has.
/// Cost and errors: encode_seams' (seams.hpp); invalid_argument, too, where a vertex without corners is not alone.
Result<EncodedSeams> encode_seams(const Encoded& surface, std::span<const std::uint32_t> indices,
                                  std::span<const std::uint32_t> vertex_of);

// The steps. Rings are as expand_rings and optimize_rings make them: the triangles on each ring's left are a tree.

// From a corner table and its rings to a lean stream (streams.hpp). Paper: LR 2011, section 7 and section 5.

struct LeanOptions {
    bool wart_skipping = true;
};

/// A lean stream and how it maps to the mesh that it was made from.
struct EncodedLean {
    std::vector<std::uint32_t> words;          ///< header and payload: the whole stream
    std::vector<std::uint32_t> vertex_order;   ///< vertex_order[new] = old, a permutation of the mesh's vertices
    std::vector<std::uint32_t> slot_triangle;  ///< triangle of the mesh at each slot, UINT32_MAX where degenerate
    LeanStatistics statistics;
};

/// Encodes every triangle of the table that is not degenerate.
/// Cost: O(T) time; 4 bytes a reference for the words, 4 for slot_triangle, 4 a vertex for vertex_order, 4 while it
/// runs. Errors: too_large (2^29 vertices, or 2^32 / 3 slots).
Result<EncodedLean> encode_lean(const CornerTable& table, const Rings& rings, const LeanOptions& options = {});

// From a corner table and its rings to a packed stream (streams.hpp).

/// A packed stream and how it maps to the mesh that it was made from.
struct EncodedPacked {
    std::vector<std::uint32_t> words;           ///< the whole stream
    std::vector<std::uint32_t> vertex_order;    ///< vertex_order[new] = old, a permutation of the mesh's vertices
    std::vector<std::uint32_t> triangle_order;  ///< triangle_order[i] = the mesh's triangle decoded i-th
    PackedStatistics statistics;
};

/// Encodes every triangle of the table that is not degenerate.
/// Cost: O(T) time; beside the result 5 bytes a triangle, 5 a vertex and 4 bits a triangle while it runs.
/// Errors: too_large (2^29 vertices; records of 4 GiB: at least 300 million triangles).
Result<EncodedPacked> encode_packed(const CornerTable& table, const Rings& rings,
                                    PackedProfile profile = PackedProfile::small);

/// The smaller of two streams: over the rings of expand_rings, and over these optimized; of a mesh with doubled
/// triangles both are of the mesh without the doubles, which only the stream gets. Errors: encode_packed's.
struct PackedChoice {
    EncodedPacked stream;
    std::uint32_t passes = 0;  ///< of the optimizer; 0 where its rings were no better
};
Result<PackedChoice> encode_smallest_packed(const CornerTable& table, const RingOptions& ring,
                                            const OptimizeOptions& optimize,
                                            PackedProfile profile = PackedProfile::small);

// LR tables.

struct LrTable {
    std::uint32_t vertices = 0, ring_vertices = 0;
    std::vector<std::uint32_t> lr, vo, star, c;
    LrStatistics statistics;

    LrView view() const { return {vertices, ring_vertices, lr, vo, star, c}; }
};

/// Which element of the corner table each element of the LR tables is.
struct LrMap {
    std::vector<VertexId> vertex;  ///< vertex[LR vertex] = corner table's
    std::vector<TriangleId>
        triangle;  ///< triangle[LR triangle] = corner table's, null for redundant copies and borders
    std::vector<std::uint32_t>
        start;  ///< start[LR triangle] = 0, 1, 2: which of its corners is the LR triangle's first
};

/// A copy of a vertex whose triangles form several fans (split_fans), and the vertex that it is a copy of; LR numbers.
struct VertexCopy {
    std::uint32_t copy, original;
};

struct CompactLrTable {
    std::uint32_t vertices = 0, ring_vertices = 0, unit = 2;
    std::vector<std::uint32_t> lr, vo, star, c;
    std::uint32_t irregular = 0;  ///< n_i: triangles with opposites in VO*
    std::uint32_t long_tips = 0;  ///< n_l: slots with a long reference and no opposites

    CompactLrView view() const { return {vertices, ring_vertices, unit, lr, vo, star, c}; }
};

/// Packs standard tables. Vertices, triangles and corners keep their numbers. Cost: O(T).
/// A VO* beyond 2^27 entries is indexed in units of 4 or 8, its records padded; at 8 each record takes one unit.
/// Errors: too_large (more than 2^26 records).
Result<CompactLrTable> build_compact_lr(const LrView& lr);

/// Header, L and R, VO, VO*, C, copies. 40 bytes beside 4 a reference and 8 a copy.
std::vector<std::uint32_t> serialize(const LrTable& table, std::span<const VertexCopy> copies);
std::vector<std::uint32_t> serialize(const CompactLrTable& table, std::span<const VertexCopy> copies);

// From a corner table to LR tables, and to LR streams in one call, non-manifold vertices and all.

struct LrOptions {
    bool wart_skipping = true;
};

/// Builds the tables from a pseudo-manifold corner table (split_fans) and its rings, one per shell
/// (RingOptions::one_per_shell). Degenerate triangles take no part.
/// Cost: O(T) time; 4 bytes a reference, and about 8 bytes a triangle while it runs. `map` may be null.
/// Errors: too_large (2^28 vertices).
Result<LrTable> build_lr(const CornerTable& table, const Rings& rings, const LrOptions& options = {},
                         LrMap* map = nullptr);

struct EncodedLr {
    std::vector<std::uint32_t> words;         ///< the stream (streams.hpp)
    std::vector<std::uint32_t> vertex_order;  ///< vertex_order[LR vertex] = the table's; copies repeat their original's
    std::vector<std::uint32_t> triangle_order;  ///< the table's triangle of each one that decode_lr gives, in its order
    LrStatistics statistics;
    std::uint32_t copies = 0;  ///< vertices beyond the table's, for fans of non-manifold vertices
    std::uint32_t k = 0;       ///< of the ring that was kept; 0: depth first
};

/// The standard tables. `table` is any corner table; it is split into a pseudo-manifold here, and one ring made per
/// shell, optimized as `optimize` says. Cost: O(T) per seed and pass. Errors: those of build_lr.
Result<EncodedLr> encode_lr(CornerTable table, const RingOptions& ring, const OptimizeOptions& optimize = {.passes = 0},
                            bool wart_skipping = true);

/// The bit-efficient tables, with the best of `periods` (smallest_compact_lr).
Result<EncodedLr> encode_compact_lr(CornerTable table, const RingOptions& ring, std::span<const std::uint32_t> periods);

// Which k makes the bit-efficient tables smallest. Paper: LR 2011, section 8: run several times, keep the best.

/// Periods worth trying on a mesh of that size, 0 (depth first) among them: fewer on large meshes.
std::vector<std::uint32_t> recommended_periods(std::size_t triangles);

struct CompactChoice {
    std::uint32_t k = 0;
    LrTable lr;  ///< the tables that were packed
    LrMap map;
    CompactLrTable compact;
};

/// Builds and packs the tables with each k and keeps the smallest. `options.k` is ignored; one ring per shell is made.
/// Cost: that of the rings and tables, times the number of periods. Errors: those of build_lr and build_compact_lr.
Result<CompactChoice> smallest_compact_lr(const CornerTable& table, const RingOptions& options,
                                          std::span<const std::uint32_t> periods);

/// Converts a step's result to encode()'s. The caller fills report.topology and report.passes.
Encoded as_encoded(EncodedLean stream);
Encoded as_encoded(EncodedPacked stream);
Encoded as_encoded(EncodedLr stream);

}  // namespace lacedring
