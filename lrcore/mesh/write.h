#pragma once
#include <filesystem>

#include "lrcore/base/result.h"
#include "lrcore/mesh/mesh.h"

namespace lr {

/// Writes GLB, binary PLY or OBJ by the extension of `path` (.glb, .ply, .obj). PLY keeps every attribute bit for bit; GLB
/// turns f64 into f32 and names attributes it does not know _NAME; OBJ keeps positions, normals and texture coordinates, in
/// the shortest decimals that read back the same. Written to a temporary file beside `path` and renamed: never half a file.
/// Errors: cannot_write, invalid_argument (extension, or a mesh that breaks its invariants), too_large (GLB above 4 GiB).
/// Cost: O(file).
Result<void> write_mesh(const Mesh& mesh, const std::filesystem::path& path);

}  // namespace lr
