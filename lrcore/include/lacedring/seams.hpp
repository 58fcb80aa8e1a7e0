#pragma once
// Seam sections: which copy of its vertex each corner has. A mesh with seams is stored as its surface, a connectivity
// stream whose vertices have different positions, and a section that tells its corners apart: normals and texture
// coordinates belong to the copies. docs/seams-format.md has the format to the bit.
//
// Each vertex has home copies, those that its triangles on the left of the ring have, numbered vertex by vertex. Any
// other copy is numbered behind these, by the block of 512 triangles that meets it first. A block decodes alone, from
// its triangles and the blocks of its vertices.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/base.hpp"
#include "lacedring/streams.hpp"

namespace lacedring {

/// Triangles of a block.
constexpr std::uint32_t kSeamBlock = 512;

struct EncodedSeams {
    std::vector<std::uint32_t> words;  ///< the whole section
    /// copy_order[new] = old: bring attributes into this order. UINT32_MAX at the copy of a vertex without corners.
    std::vector<std::uint32_t> copy_order;
};

/// Encodes the copies of a surface's corners. `triangles` are the slots of the connectivity stream, in its order and
/// with its numbers (slot_triangles): three vertices each, below `vertices`, or UINT32_MAX three times where a slot has
/// no triangle. `copies` has a number for each of their corners, any numbers: equal where corners share a copy, which
/// only corners of one vertex do. Cost: O(T log T) time, about one microsecond a triangle and up to half a second for
/// the codes; 60 bytes a triangle. Errors: invalid_argument (sizes, a vertex out of range or twice in a triangle, a
/// copy of two vertices), too_large (2^30 copies, 4 GiB).
Result<EncodedSeams> encode_seams(std::span<const std::uint32_t> triangles, std::uint32_t vertices,
                                  std::span<const std::uint32_t> copies);

/// A seam section somewhere in memory, its header read. Holds no copy.
struct SeamView {
    std::span<const std::uint32_t> words;
    std::uint32_t vertices = 0, triangles = 0;
    std::uint32_t homes = 0;   ///< home copies: the first ones, in the order of their vertices
    std::uint32_t copies = 0;  ///< of all vertices

    std::uint32_t blocks() const { return triangles / kSeamBlock + (triangles % kSeamBlock == 0 ? 0 : 1); }
};

/// Reads the header and checks sizes only: of the section of a mesh with so many triangles and vertices. Errors:
/// malformed. Untrusted input: safe.
Result<SeamView> view_seams(std::span<const std::uint32_t> words, std::uint32_t triangles, std::uint32_t vertices);

/// Checks everything that decoders rely on, the checksum included, for these triangles, three vertices each. Cost: O(T)
/// time; 4 bytes a vertex and 4 a copy that is no home. Errors: malformed. Untrusted input, triangles included: safe.
Result<SeamView> validate_seams(std::span<const std::uint32_t> words, std::span<const std::uint32_t> triangles,
                                std::uint32_t vertices);

/// validate_seams, decode_seams and copy_vertices in one pass: fills `copies`, as many as `triangles`, and `vertices`,
/// the vertex of each copy. Errors: malformed; both are then of no use. Cost, and the rest: validate_seams'.
Result<SeamView> decode_seams_checked(std::span<const std::uint32_t> words, std::span<const std::uint32_t> triangles,
                                      std::uint32_t vertex_count, std::span<std::uint32_t> copies,
                                      std::vector<std::uint32_t>& vertices);

/// The copy of each corner of the triangles that the section was validated for; UINT32_MAX where a slot has none. Cost:
/// O(T) time, 4 bytes a vertex.
void decode_seams(const SeamView& view, std::span<const std::uint32_t> triangles, std::span<std::uint32_t> copies);

/// The same of one block; `triangles` are the block's alone: [512 * block, ...), 3 * 512 entries or what the last block
/// has. Reads the directories' groups, the block and the blocks of its vertices: no allocation.
void decode_seam_block(const SeamView& view, std::uint32_t block, std::span<const std::uint32_t> triangles,
                       std::span<std::uint32_t> copies);

/// Three vertices of each slot of a valid stream, UINT32_MAX where it has no triangle: what a seam section goes with.
/// Cost: O(T).
std::vector<std::uint32_t> slot_triangles(const StreamView& stream);

/// The same of one block of 512 slots: what decode_seam_block takes. 3 * 512 entries, or what the last block has.
/// Reads a bounded number of words: no allocation.
void slot_triangles(const StreamView& stream, std::uint32_t block, std::span<std::uint32_t> triangles);

/// The home copies of vertex v are first[v] to first[v + 1] - 1: view.vertices + 1 entries. At least one a vertex: its
/// position is that of copy first[v].
void first_copies(const SeamView& view, std::span<std::uint32_t> first);

/// The vertex of each copy, home or not: view.copies entries. With it, positions and other data of the vertices are
/// expanded to the copies. `triangles` as for decode_seams. Cost: O(T) time, 4 bytes a vertex.
void copy_vertices(const SeamView& view, std::span<const std::uint32_t> triangles, std::span<std::uint32_t> vertices);

/// The copies of single corners, at random access:
///
///     CornerCopies copies(stream, seams);
///     ops.star(v, [&](CornerId c) { use(normals[copies.copy(c)]); });
///
/// A question decodes the corner's block, in about 0.1 ms, if it is not among the last eight that were used. The
/// triangles around a vertex lie in about three blocks, and so do those around the next vertices on the ring. Reads a
/// bounded number of words. An object has 48 KB, allocates nothing, and is for one thread; other threads make their
/// own.
class CornerCopies {
  public:
    /// Both are valid, and the words that they view outlive the object. `seams` is of the slots of `stream`.
    CornerCopies(const StreamView& stream, const SeamView& seams);

    /// The copy at vertex 0, 1 or 2 of decode_triangle(stream, slot); UINT32_MAX if the slot has no triangle.
    std::uint32_t copy(std::uint32_t slot, std::uint32_t place);

    /// The copy at a corner of Operators on the stream, which is LR tables; UINT32_MAX if the corner has no triangle.
    /// The copy's vertex is ops.original(ops.vertex(c)): seam sections take the fans of a vertex for one vertex.
    std::uint32_t copy(CornerId c);

  private:
    struct Cached {
        std::uint32_t block, entry;
    };

    StreamView stream_;
    SeamView seams_;
    std::array<Cached, 8> recent_;  ///< the block in each entry of copies_; the last one used is the first
    std::array<std::array<std::uint32_t, std::size_t{3} * kSeamBlock>, 8> copies_;
};

}  // namespace lacedring
