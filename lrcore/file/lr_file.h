#pragma once
// The .lr file: a lean stream, the vertex attributes in ring order and, on request, the way back to the input's order.
// docs/lr-file.md has the format to the byte.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "lrcore/base/result.h"
#include "lrcore/lean/lean_stream.h"
#include "lrcore/mesh/mesh.h"

namespace lr {

struct LrFile {
    std::uint32_t vertex_count = 0;
    std::uint32_t input_triangles = 0;  ///< of the mesh it was made from, degenerate ones included
    std::vector<std::uint32_t> lean;    ///< the stream, header included
    std::vector<Attribute> attributes;  ///< in ring order
    std::vector<std::uint32_t> vertex_order;    ///< vertex_order[new] = old; empty unless kept
    std::vector<std::uint32_t> triangle_order;  ///< triangle_order[i] = input triangle of the stream's i-th; empty unless kept
};

/// Packs an encoded mesh. With `keep_order` the permutations go along: 4 bytes a vertex and 4 a triangle.
LrFile make_lr_file(const Mesh& mesh, LeanStream stream, bool keep_order);

/// The file's bytes. Cost: O(file).
std::vector<std::byte> serialize_lr(const LrFile& file);

/// Reads and checks everything: structure, checksums, stream, permutations, finite positions.
/// Errors: malformed, too_large. Untrusted input: safe. Cost: O(file).
Result<LrFile> parse_lr(std::span<const std::byte> bytes);

Result<void> write_lr(const LrFile& file, const std::filesystem::path& path);
Result<LrFile> read_lr(const std::filesystem::path& path);

/// Does the file begin as .lr files do? False where it cannot be read.
bool is_lr(const std::filesystem::path& path);

/// Decodes to a mesh in stream order. `file` is valid (parse_lr checked it, or make_lr_file made it).
Mesh decode_lr(const LrFile& file);

/// Decodes to the input's order of vertices and triangles; triangles are rotated, degenerate ones missing.
/// Errors: invalid_argument if the permutations were not kept.
Result<Mesh> decode_lr_original_order(const LrFile& file);

}  // namespace lr
