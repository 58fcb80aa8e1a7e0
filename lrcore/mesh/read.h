#pragma once
#include <filesystem>

#include "lrcore/base/result.h"
#include "lrcore/mesh/mesh.h"

namespace lr {

/// Reads glTF/GLB, OBJ, PLY, OFF/COFF or STL, told apart by content where the format has a signature, else by extension.
/// Several meshes or primitives become one list of all triangles, node transforms applied, attributes kept where every
/// primitive has them. Polygons are split into fans. STL vertices with identical position bits are merged.
/// Errors: cannot_open, malformed, unsupported, too_large. Untrusted input: safe. Cost: O(file).
Result<Mesh> read_mesh(const std::filesystem::path& path);

}  // namespace lr
