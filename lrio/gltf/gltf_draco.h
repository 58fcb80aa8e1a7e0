#pragma once
// Primitives compressed with KHR_draco_mesh_compression. Internal to lrio.

#include <span>

#include "lacedring/base.hpp"
#include "lrio/gltf/gltf_file.h"

namespace lacedring::detail {

/// Finds the primitives with Draco data. They become triangle lists with indices. An accessor that two primitives use
/// for different data is split into two. Without libdraco, does nothing. Errors: malformed.
Result<void> find_draco_primitives(GltfFile& file);

/// Returns the decoded values of an accessor in file.draco.sources, tightly packed, in the accessor's type. Their
/// number is that of the Draco data, not the accessor's count. The data is decoded once and kept in the file. Errors:
/// malformed, unsupported, memory_limit, those of open_view.
Result<std::span<const std::byte>> draco_values(GltfFile& file, int accessor);

}  // namespace lacedring::detail
