#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "lrcore/base/result.h"
#include "lrio/mesh/mesh.h"
#include "lrio/mesh/read.h"

namespace lr {

/// Differences of a written file from the mesh, a line each: "NORMAL: 3 of no length were made from the triangles".
using WriteNotes = std::vector<std::string>;

/// Writes GLB, binary PLY or OBJ by the extension of `path` (.glb, .ply, .obj). PLY keeps every attribute bit for bit;
/// GLB keeps what glTF can hold, and OBJ positions, normals, texture coordinates and colors (docs/formats-read.md).
/// `notes`, if given, tells of everything else. The file is whole or untouched (write_file). Errors: cannot_write,
/// invalid_argument (extension, or a mesh that breaks its invariants), unsupported (no triangles), too_large (GLB above
/// 4 GiB). Cost: O(file).
Result<void> write_mesh(const Mesh& mesh, const std::filesystem::path& path, WriteNotes* notes = nullptr);

/// The same to an open descriptor: GLB (MeshFormat::gltf), PLY or OBJ.
Result<void> write_mesh(const Mesh& mesh, MeshFormat format, int descriptor, WriteNotes* notes = nullptr);

/// The format that write_mesh takes for a path; any: none.
MeshFormat writable_format(const std::filesystem::path& path);

}  // namespace lr
