#pragma once
// The materials of a glTF, and the images of their textures. Internal to lrio.

#include "lacedring/base.hpp"
#include "lacedring/materials.hpp"
#include "lrio/gltf/gltf_file.h"

namespace lacedring::detail {

/// Reads all materials of the file and appends glTF's default material; leaves of_triangle empty. The report gets a
/// line for each image that cannot be read, and a line with the material extensions that are not read. Errors:
/// malformed (a value of the wrong type, an index out of range), memory_limit.
Result<Materials> read_materials(GltfFile& file, Reading& reading);

}  // namespace lacedring::detail
