#pragma once
// Buffer views, plain or compressed with EXT_meshopt_compression or KHR_meshopt_compression. Internal to lrio.

#include <cstddef>
#include <span>

#include "lacedring/base.hpp"
#include "lrio/gltf/gltf_file.h"

namespace lacedring::detail {

/// Was lrio built with meshoptimizer?
bool has_meshoptimizer();

/// Returns the byteLength bytes of buffer view `index`, which exists. A compressed view is decoded once and kept in the
/// file. If meshoptimizer does not support it and the file has an uncompressed fallback, returns the fallback. Errors:
/// malformed, unsupported, memory_limit, those of GltfBuffers::open.
Result<std::span<const std::byte>> open_view(GltfFile& file, std::size_t index);

}  // namespace lacedring::detail
