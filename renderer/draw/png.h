#pragma once
// PNG in memory; files are written and read through picture.h.

#include <cstddef>
#include <vector>

#include "renderer/draw/picture.h"

namespace lacedring::gpu {

/// The bytes of an opaque PNG file. Errors: cannot_write.
Result<std::vector<std::byte>> encode_png(const Picture& picture);

}  // namespace lacedring::gpu
