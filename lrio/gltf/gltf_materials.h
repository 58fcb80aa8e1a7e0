#pragma once
// The materials of a glTF, and the images of their textures. Internal to lrio.

#include "lacedring/base.hpp"
#include "lacedring/materials.hpp"
#include "lrio/gltf/gltf_file.h"

namespace lacedring::detail {

/// All materials of the file, and behind them glTF's default one; of_triangle is empty. The report gets a line for each
/// image that cannot be read, and one for extensions that change how a material looks and are not read. Errors:
/// malformed (a value of the wrong type, a number of nothing), memory_limit.
Result<Materials> read_materials(GltfFile& file, Reading& reading);

}  // namespace lacedring::detail
