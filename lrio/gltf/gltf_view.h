#pragma once
// Buffer views, those too that EXT_meshopt_compression or KHR_meshopt_compression holds. Internal to lrio.

#include <cstddef>
#include <span>

#include "lacedring/base.hpp"
#include "lrio/gltf/gltf_file.h"

namespace lacedring::detail {

/// Was lrio built with meshoptimizer?
bool has_meshoptimizer();

/// Returns the byteLength bytes of buffer view `index`, which exists. A compressed one is decoded once and kept in the
/// file; its uncompressed copy is read only where the file has one and this meshoptimizer does not read the other.
/// Errors: malformed, unsupported, memory_limit, GltfBuffers::open's.
Result<std::span<const std::byte>> open_view(GltfFile& file, std::size_t index);

}  // namespace lacedring::detail
