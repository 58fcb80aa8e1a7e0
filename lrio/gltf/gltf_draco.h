#pragma once
// Primitives that KHR_draco_mesh_compression holds. Internal to lrio.

#include <span>

#include "lacedring/base.hpp"
#include "lrio/gltf/gltf_file.h"

namespace lacedring::detail {

/// Finds the primitives that hold Draco's data. They become lists of triangles with indices, and an accessor that two
/// of them name for different data becomes two. Without libdraco they stay as they are. Errors: malformed.
Result<void> find_draco_primitives(GltfFile& file);

/// Returns the decoded values of an accessor in file.draco.sources, tightly packed, in the accessor's type. The data is
/// decoded once and kept in the file. Its counts hold, not the accessors'. Errors: malformed, unsupported,
/// memory_limit, open_view's.
Result<std::span<const std::byte>> draco_values(GltfFile& file, int accessor);

}  // namespace lacedring::detail
