#pragma once
// The .lr file: a mesh's connectivity as a lean or packed stream or as LR tables, the vertex attributes in ring order and, on
// request, the way back to the input's order.
// docs/lr-file.md has the format to the byte.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "lrcore/base/result.h"
#include "lrcore/mesh/mesh.h"

namespace lr {

/// What a file's connectivity is. The values are the section kinds.
enum class Connectivity : std::uint32_t { lean = 1, lr = 5, lr_compact = 6, packed = 7 };

struct LrFile {
    std::uint32_t vertex_count = 0;     ///< of the connectivity: with LR tables, copies of non-manifold vertices included
    std::uint32_t input_triangles = 0;  ///< of the mesh it was made from, degenerate ones included
    Connectivity format = Connectivity::lean;
    std::vector<std::uint32_t> words;   ///< the connectivity, its own header included (lean_format.h, lr_stream.h, packed_format.h)
    std::vector<Attribute> attributes;  ///< in ring order, one value for each of vertex_count
    std::vector<std::uint32_t> vertex_order;    ///< vertex_order[new] = old; empty unless kept
    std::vector<std::uint32_t> triangle_order;  ///< triangle_order[i] = input triangle of the i-th decoded; empty unless kept
};

/// An encoded mesh. words, vertex_order (a permutation, but for the old numbers that copies repeat) and triangle_order (in
/// the order in which the words decode, UINT32_MAX for degenerate slots) are kept only with `keep_order`: 4 bytes a vertex
/// and 4 a triangle.
LrFile make_lr_file(const Mesh& mesh, Connectivity format, std::vector<std::uint32_t> words,
                    std::vector<std::uint32_t> vertex_order, std::vector<std::uint32_t> triangle_order, bool keep_order);

/// The file's bytes. Cost: O(file).
std::vector<std::byte> serialize_lr(const LrFile& file);

/// Reads and checks everything: structure, checksums, stream, permutations, finite positions.
/// Errors: malformed, too_large. Untrusted input: safe. Cost: O(file).
Result<LrFile> parse_lr(std::span<const std::byte> bytes);

Result<void> write_lr(const LrFile& file, const std::filesystem::path& path);
Result<LrFile> read_lr(const std::filesystem::path& path);

/// Does the file begin as .lr files do? False where it cannot be read.
bool is_lr(const std::filesystem::path& path);

/// The connectivity's words where they lie in a file's bytes (memory-mapped, at an address that is a multiple of 8), for
/// view_lean, view_packed, view_lr or view_compact_lr. Checks the structure of the file, not the words: validate them, or trust them.
/// Errors: malformed. Untrusted input: safe. Cost: O(1) in the size of the mesh.
struct ConnectivityWords {
    Connectivity format;
    std::span<const std::uint32_t> words;
};
Result<ConnectivityWords> connectivity_in(std::span<const std::byte> bytes);

/// Decodes to a mesh in stream order, copies of non-manifold vertices left out again. `file` is valid (parse_lr checked it, or make_lr_file made it).
Mesh decode_lr(const LrFile& file);

/// Decodes to the input's order of vertices and triangles; triangles are rotated, degenerate ones missing.
/// Errors: invalid_argument if the permutations were not kept.
Result<Mesh> decode_lr_original_order(const LrFile& file);

}  // namespace lr
