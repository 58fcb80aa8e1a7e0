#pragma once
// Triangle meshes in one vertex reference per triangle, or in little more than one bit: encode() turns an index list
// into a stream; validate() and decode() (streams.hpp) read its triangles. This header includes all C++ headers of the
// library's core.
//
// encode() consists of steps that can also be called one by one: build_corner_table (topology.hpp), expand_rings and
// optimize_rings (ring.hpp), and encode_lean, encode_packed or build_lr below.

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
    /// The fewest bits.
    small,
    /// An order nearly as good for the vertex cache as the best; about 1.5 bits per triangle more.
    cache,
};

/// Counts of triangles by the way a lean stream stores them, over all rings. Paper: LR 2011, section 4.3.
struct LeanStatistics {
    std::uint32_t ring_vertices = 0;
    std::uint32_t isolated = 0;   ///< used vertices that are on no ring
    std::uint32_t t0 = 0;         ///< T0 left after wart skipping; stored verbatim
    std::uint32_t t0_wart = 0;    ///< T0 stored in the redundant copy of a T2
    std::uint32_t t2 = 0;         ///< triangles with two or three ring edges
    std::uint32_t irregular = 0;  ///< T1 and T2 next to a T0 that is left after wart skipping
    /// T1 and T2 stored verbatim because their ring, or one side of it, would cost more as slots.
    std::uint32_t unrung = 0;
};

/// Counts of a packed stream's events and blocks.
struct PackedStatistics {
    std::uint32_t ring_vertices = 0;
    std::uint32_t events[8] = {};      ///< number of events by code (docs/packed-format.md)
    std::uint64_t event_bits[8] = {};  ///< bits of events by code, including their gaps
    std::uint32_t warts = 0;
    std::uint64_t wart_bits = 0;
    std::uint32_t doubles = 0;        ///< triangles stored as the number of an equal triangle
    std::uint32_t parted_blocks = 0;  ///< blocks with too many events for one record
    std::uint32_t plain_blocks = 0;   ///< blocks stored as three vertices per triangle
};

/// Counts of triangles by kind in LR tables, standard or bit-efficient. Paper: LR 2011, section 8.
struct LrStatistics {
    std::uint32_t t0 = 0, t0_wart = 0, t1_irregular = 0, t2_irregular = 0, t2 = 0, isolated = 0;
};

struct EncodeOptions {
    Format format = Format::packed;
    PackedProfile profile = PackedProfile::small;  ///< packed only
    bool wart_skipping = true;                     ///< lean and lr only; packed and lr_compact always skip warts
    /// 0 to 9: time spent on better rings. It determines seeds, passes and periods that are not set.
    std::uint32_t effort = 6;

    std::optional<std::uint32_t> seeds = {};  ///< RingOptions::seeds
    /// OptimizeOptions::passes; lr_compact does not optimize its rings.
    std::optional<std::uint32_t> passes = {};
    /// RingOptions::k. lr_compact tries each value and keeps the best; any other format takes at most one.
    std::vector<std::uint32_t> periods = {};
    std::uint64_t random_seed = 1;
    unsigned threads = 1;  ///< maximum, including the calling thread; does not change the words

    /// The calling thread calls it after each optimizer pass with the number of passes done. If it returns false, the
    /// best rings so far are encoded. The optimizer makes fewer passes if nothing is left to gain. lr_compact has no
    /// such passes and never calls it.
    std::function<bool(std::uint32_t)> progress = {};
};

/// Number of optimizer passes for a format at an effort.
std::uint32_t passes_at(std::uint32_t effort, Format format);

/// How a mesh was encoded.
struct EncodeReport {
    Topology topology;            ///< how the triangles were joined; counts the degenerate ones, which are left out
    std::uint32_t triangles = 0;  ///< in the stream
    std::uint32_t copies = 0;     ///< vertices added to the mesh's: LR tables copy non-manifold vertices
    std::uint32_t k = 0;          ///< RingOptions::k of the rings used
    std::uint32_t passes = 0;     ///< optimizer passes requested; 0 if the rings are not optimized
    std::variant<LeanStatistics, PackedStatistics, LrStatistics> statistics;
};

/// A stream and its mapping to the encoded mesh.
struct Encoded {
    Format format = Format::packed;
    std::vector<std::uint32_t> words;  ///< the whole stream
    /// vertex_order[new] = old: bring the vertices' attributes into this order. A permutation of the mesh's vertices.
    /// In LR tables of a mesh with non-manifold vertices, entries repeat (copies).
    std::vector<std::uint32_t> vertex_order;
    std::vector<std::uint32_t> triangle_order;  ///< triangle_order[i] = the mesh's triangle decoded i-th
    EncodeReport report;

    std::span<const std::byte> bytes() const { return std::as_bytes(std::span(words)); }
};

/// Encodes any triangle soup: three `indices` per triangle, below `vertex_count`. Triangles with a repeated vertex are
/// left out; all others keep their orientation. The words are the same on every machine. Cost: O(T) time for each pass
/// and seed; about 70 bytes per triangle. Errors: malformed (index out of range), invalid_argument (a number of indices
/// that is no multiple of three, an option out of its range), too_large.
Result<Encoded> encode(std::span<const std::uint32_t> indices, std::uint32_t vertex_count,
                       const EncodeOptions& options = {});

/// Encodes the triangles of a corner table. For LR tables, the const overload copies the table.
Result<Encoded> encode(const CornerTable& table, const EncodeOptions& options = {});
Result<Encoded> encode(CornerTable&& table, const EncodeOptions& options = {});

/// The seam section of a surface that encode() has encoded. `indices` belong to the mesh with seams; vertex_of[v] is
/// the surface vertex of the mesh's vertex v, so encode() got vertex_of[indices[i]] for each i. The result's
/// copy_order[new] is the mesh's vertex of each copy, also for vertices without corners. Cost and errors: encode_seams'
/// (seams.hpp); also invalid_argument if several of the mesh's vertices map to a surface vertex without corners.
Result<EncodedSeams> encode_seams(const Encoded& surface, std::span<const std::uint32_t> indices,
                                  std::span<const std::uint32_t> vertex_of);

// The steps of encode(). Rings must come from expand_rings or optimize_rings: the triangles on each ring's left are a
// tree.

// Makes a lean stream (streams.hpp) from a corner table and its rings. Paper: LR 2011, sections 7 and 5.

struct LeanOptions {
    bool wart_skipping = true;
};

/// A lean stream and its mapping to the encoded mesh.
struct EncodedLean {
    std::vector<std::uint32_t> words;          ///< header and payload: the whole stream
    std::vector<std::uint32_t> vertex_order;   ///< vertex_order[new] = old, a permutation of the mesh's vertices
    std::vector<std::uint32_t> slot_triangle;  ///< the mesh's triangle at each slot, UINT32_MAX if degenerate
    LeanStatistics statistics;
};

/// Encodes every triangle of the table that is not degenerate.
/// Cost: O(T) time; 4 bytes per reference for the words, 4 per slot for slot_triangle, 4 per vertex for vertex_order,
/// and 4 more per vertex while it runs. Errors: too_large (2^29 vertices, or 2^32 / 3 slots).
Result<EncodedLean> encode_lean(const CornerTable& table, const Rings& rings, const LeanOptions& options = {});

// Makes a packed stream (streams.hpp) from a corner table and its rings.

/// A packed stream and its mapping to the encoded mesh.
struct EncodedPacked {
    std::vector<std::uint32_t> words;           ///< the whole stream
    std::vector<std::uint32_t> vertex_order;    ///< vertex_order[new] = old, a permutation of the mesh's vertices
    std::vector<std::uint32_t> triangle_order;  ///< triangle_order[i] = the mesh's triangle decoded i-th
    PackedStatistics statistics;
};

/// Encodes every triangle of the table that is not degenerate.
/// Cost: O(T) time; while it runs, beside the result, 5.5 bytes per triangle and 5 per vertex.
/// Errors: too_large (2^29 vertices; records of 4 GiB: at least 300 million triangles).
Result<EncodedPacked> encode_packed(const CornerTable& table, const Rings& rings,
                                    PackedProfile profile = PackedProfile::small);

/// The smaller of two streams: from the rings of expand_rings, and from the same rings optimized. Rings are made
/// without doubled triangles; the stream stores those as doubles. Errors: those of encode_packed.
struct PackedChoice {
    EncodedPacked stream;
    std::uint32_t passes = 0;  ///< optimizer passes; 0 if its rings were no better
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

/// Maps the elements of the LR tables to those of the corner table.
struct LrMap {
    std::vector<VertexId> vertex;  ///< vertex[LR vertex] = corner table's
    /// triangle[LR triangle] = corner table's; null for redundant copies and borders.
    std::vector<TriangleId> triangle;
    /// start[LR triangle] = 0, 1, 2: which corner of the table's triangle is the LR triangle's first.
    std::vector<std::uint32_t> start;
};

/// A copy of a vertex whose triangles form several fans (split_fans), and its original; LR numbers.
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

/// Converts standard tables to bit-efficient ones. Vertices, triangles and corners keep their numbers. Cost: O(T). If
/// VO* has more than 2^27 entries, records are padded and indexed in units of 4 or 8 entries; with 8, each record takes
/// one unit. Errors: too_large (more than 2^26 records).
Result<CompactLrTable> build_compact_lr(const LrView& lr);

/// Words of an LR stream: header, L and R, VO, VO*, C, copies. 40 bytes plus 4 per reference and 8 per copy.
std::vector<std::uint32_t> serialize(const LrTable& table, std::span<const VertexCopy> copies);
std::vector<std::uint32_t> serialize(const CompactLrTable& table, std::span<const VertexCopy> copies);

// Makes LR tables from a pseudo-manifold corner table, or LR streams from any corner table.

struct LrOptions {
    bool wart_skipping = true;
};

/// Builds the tables from a pseudo-manifold corner table (split_fans) and its rings, one per shell
/// (RingOptions::one_per_shell). Degenerate triangles are ignored. Cost: O(T) time; 4 bytes per reference, and about 8
/// bytes per triangle while it runs. `map` may be null.
/// Errors: too_large (2^28 vertices).
Result<LrTable> build_lr(const CornerTable& table, const Rings& rings, const LrOptions& options = {},
                         LrMap* map = nullptr);

struct EncodedLr {
    std::vector<std::uint32_t> words;         ///< the stream (streams.hpp)
    std::vector<std::uint32_t> vertex_order;  ///< vertex_order[LR vertex] = the table's; copies repeat their original's
    /// triangle_order[i] = the table's triangle that decode_lr gives i-th.
    std::vector<std::uint32_t> triangle_order;
    LrStatistics statistics;
    std::uint32_t copies = 0;  ///< vertices added to the table's for fans of non-manifold vertices
    std::uint32_t k = 0;       ///< RingOptions::k of the rings used
};

/// Makes the standard tables from any corner table: splits it into a pseudo-manifold, makes one ring per shell and
/// optimizes the rings as `optimize` says. Cost: O(T) per seed and pass. Errors: those of build_lr.
Result<EncodedLr> encode_lr(CornerTable table, const RingOptions& ring, const OptimizeOptions& optimize = {.passes = 0},
                            bool wart_skipping = true);

/// Makes the bit-efficient tables, with the best of `periods` (smallest_compact_lr).
Result<EncodedLr> encode_compact_lr(CornerTable table, const RingOptions& ring, std::span<const std::uint32_t> periods);

// Choice of the k with the smallest bit-efficient tables. Paper: LR 2011, section 8: run several times, keep the best.

/// Values of RingOptions::k worth trying on a mesh of that size, 0 (depth first) first unless the mesh is very large;
/// fewer for large meshes.
std::vector<std::uint32_t> recommended_periods(std::size_t triangles);

struct CompactChoice {
    std::uint32_t k = 0;
    LrTable lr;  ///< the standard tables that `compact` was made from
    LrMap map;
    CompactLrTable compact;
};

/// Makes bit-efficient tables with each of `periods` as k and keeps the smallest. Ignores `options.k`; makes one ring
/// per shell. Cost: that of the rings and tables, times the number of periods. Errors: those of build_lr and
/// build_compact_lr.
Result<CompactChoice> smallest_compact_lr(const CornerTable& table, const RingOptions& options,
                                          std::span<const std::uint32_t> periods);

/// Converts a step's result to encode()'s. The caller fills report.topology and report.passes.
Encoded as_encoded(EncodedLean stream);
Encoded as_encoded(EncodedPacked stream);
Encoded as_encoded(EncodedLr stream);

}  // namespace lacedring
