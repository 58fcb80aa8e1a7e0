#pragma once
// Seam sections store the copy of its vertex that each corner has. A mesh with seams is stored as its surface, a
// connectivity stream with one vertex per position, plus a seam section. Normals and texture coordinates belong to the
// copies of vertices. docs/seams-format.md specifies the format.
//
// The home copies of a vertex are the copies of its corners on the left of the ring; they are numbered vertex by
// vertex. All other copies have higher numbers, in the order of the 512-triangle blocks that first contain them. A
// block can be decoded from its triangles and the blocks of its vertices alone.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/base.hpp"
#include "lacedring/streams.hpp"

namespace lacedring {

/// Triangles per block.
constexpr std::uint32_t kSeamBlock = 512;

struct EncodedSeams {
    std::vector<std::uint32_t> words;  ///< the whole section
    /// copy_order[new] = old: bring attributes into this order. UINT32_MAX for the copy of a vertex without corners.
    std::vector<std::uint32_t> copy_order;
};

/// Encodes the copies of a surface's corners. `triangles` are the slots of the connectivity stream (slot_triangles):
/// three vertices each, below `vertices`, or UINT32_MAX three times if the slot is empty. `copies` has any number for
/// each corner; equal numbers mean the same copy, so corners of different vertices must have different numbers. Cost:
/// O(T log T) time, about one microsecond per triangle and up to half a second for choosing codes; 60 bytes per
/// triangle. Errors: invalid_argument (sizes, a vertex out of range or repeated in a triangle, a copy of two vertices),
/// too_large (2^30 copies, 4 GiB).
Result<EncodedSeams> encode_seams(std::span<const std::uint32_t> triangles, std::uint32_t vertices,
                                  std::span<const std::uint32_t> copies);

/// A view of a seam section with its header parsed. Does not own the words.
struct SeamView {
    std::span<const std::uint32_t> words;
    std::uint32_t vertices = 0, triangles = 0;
    std::uint32_t homes = 0;   ///< home copies, numbered first, in the order of their vertices
    std::uint32_t copies = 0;  ///< all copies

    std::uint32_t blocks() const { return triangles / kSeamBlock + (triangles % kSeamBlock == 0 ? 0 : 1); }
};

/// Reads the header and checks sizes only, for a mesh with `triangles` triangles and `vertices` vertices. Errors:
/// malformed. Untrusted input: safe.
Result<SeamView> view_seams(std::span<const std::uint32_t> words, std::uint32_t triangles, std::uint32_t vertices);

/// Checks everything that decoders rely on, including the checksum, for `triangles` (three vertices each). Cost: O(T)
/// time; 4 bytes per vertex and 4 per copy that is not a home copy. Errors: malformed. Untrusted input, including
/// triangles: safe.
Result<SeamView> validate_seams(std::span<const std::uint32_t> words, std::span<const std::uint32_t> triangles,
                                std::uint32_t vertices);

/// validate_seams, decode_seams and copy_vertices in one pass: sets `copies` (same size as `triangles`) and `vertices`,
/// the vertex of each copy. Errors: malformed; the contents of both are then undefined. Cost and safety: as
/// validate_seams.
Result<SeamView> decode_seams_checked(std::span<const std::uint32_t> words, std::span<const std::uint32_t> triangles,
                                      std::uint32_t vertex_count, std::span<std::uint32_t> copies,
                                      std::vector<std::uint32_t>& vertices);

/// The copy of each corner of the triangles that the section was validated for; UINT32_MAX for an empty slot. Cost:
/// O(T) time, 4 bytes per vertex.
void decode_seams(const SeamView& view, std::span<const std::uint32_t> triangles, std::span<std::uint32_t> copies);

/// Decodes the copies of one block. `triangles` are the block's only: from slot 512 * block on, 3 * 512 entries or
/// fewer for the last block. Reads one group of each directory, the block and the blocks of its vertices; no
/// allocation.
void decode_seam_block(const SeamView& view, std::uint32_t block, std::span<const std::uint32_t> triangles,
                       std::span<std::uint32_t> copies);

/// The three vertices of each slot of a valid stream, UINT32_MAX for an empty slot: the `triangles` of the functions
/// above. Cost: O(T).
std::vector<std::uint32_t> slot_triangles(const StreamView& stream);

/// slot_triangles for one block of 512 slots: the `triangles` of decode_seam_block. 3 * 512 entries, or fewer for the
/// last block. Reads a bounded number of words; no allocation.
void slot_triangles(const StreamView& stream, std::uint32_t block, std::span<std::uint32_t> triangles);

/// Sets the view.vertices + 1 entries of `first`: vertex v has the home copies first[v] to first[v + 1] - 1, at least
/// one.
void first_copies(const SeamView& view, std::span<std::uint32_t> first);

/// Sets the vertex of each copy: view.copies entries. Use it to expand positions and other data of vertices to the
/// copies. `triangles` as for decode_seams. Cost: O(T) time, 4 bytes per vertex.
void copy_vertices(const SeamView& view, std::span<const std::uint32_t> triangles, std::span<std::uint32_t> vertices);

/// Random access to the copies of single corners:
///
///     CornerCopies copies(stream, seams);
///     ops.star(v, [&](CornerId c) { use(normals[copies.copy(c)]); });
///
/// A call decodes the corner's block, in about 0.1 ms, unless it is among the eight blocks used last. The triangles
/// around a vertex are in about three blocks, mostly the same for the next vertices on the ring. Reads a bounded number
/// of words. An object has 48 KB, allocates nothing, and must be used by one thread only.
class CornerCopies {
  public:
    /// Both views must be valid, and their words must outlive the object. `seams` belongs to the slots of `stream`.
    CornerCopies(const StreamView& stream, const SeamView& seams);

    /// The copy at vertex number `place` (0, 1 or 2) of decode_triangle(stream, slot); UINT32_MAX if the slot is empty.
    std::uint32_t copy(std::uint32_t slot, std::uint32_t place);

    /// For LR tables: the copy at a corner of Operators on the stream; UINT32_MAX if the corner has no triangle. The
    /// copy's vertex is ops.original(ops.vertex(c)): seam sections treat the fans of a vertex as one vertex.
    std::uint32_t copy(CornerId c);

  private:
    struct Cached {
        std::uint32_t block, entry;
    };

    StreamView stream_;
    SeamView seams_;
    /// Blocks in copies_ with their entries, most recently used first.
    std::array<Cached, 8> recent_;
    std::array<std::array<std::uint32_t, std::size_t{3} * kSeamBlock>, 8> copies_;
};

}  // namespace lacedring
