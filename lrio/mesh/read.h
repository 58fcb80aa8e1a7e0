#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "lrcore/base/result.h"
#include "lrio/mesh/mesh.h"

namespace lr {

enum class MeshFormat : std::uint8_t {
    any,  ///< told by content where the format has a signature, else by the extension
    gltf,
    obj,
    off,
    ply,
    stl,
};

struct ReadOptions {
    MeshFormat format = MeshFormat::any;
    bool allow_outside = false;  ///< a glTF may name buffers outside its own folder
    /// Bytes that the mesh, and what the caller makes of it, may take. 0: 512 MiB, or 128 times the bytes that were
    /// read where that is more. A small file can place its meshes very often.
    std::uint64_t max_bytes = 0;
    std::uint32_t triangle_bytes = 0;  ///< that the caller will take for each triangle beside the mesh
};

struct ReadReport {
    /// Contents of the file that the mesh lacks, each with its count: "3 materials".
    std::vector<std::string> left_out;
    std::vector<std::filesystem::path> files;  ///< opened beside the file
};

/// Reads glTF/GLB, OBJ, PLY, OFF/COFF or STL. Several meshes or primitives become one list of all triangles, node
/// transforms applied, attributes kept where every primitive has them. Polygons are cut into triangles that cover them
/// (docs/formats-read.md). STL vertices at one position are merged. `report`, if given, is filled even on an error.
/// Errors: cannot_open, malformed, unsupported, too_large, memory_limit. Untrusted input: safe. Cost: O(what is read).
Result<Mesh> read_mesh(const std::filesystem::path& path, const ReadOptions& options = {},
                       ReadReport* report = nullptr);

/// The same of a file that is in memory. `name` gives the extension, and the folder in which a glTF's buffers are
/// looked for; without a name there is neither.
Result<Mesh> read_mesh(std::span<const std::byte> bytes, const std::filesystem::path& name,
                       const ReadOptions& options = {}, ReadReport* report = nullptr);

}  // namespace lr
