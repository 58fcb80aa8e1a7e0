#pragma once
// PNG in memory. picture.h writes and reads PNG files.

#include <cstddef>
#include <vector>

#include "renderer/draw/picture.h"

namespace lacedring::gpu {

/// Returns the bytes of an opaque PNG file. Errors: cannot_write.
Result<std::vector<std::byte>> encode_png(const Picture& picture);

}  // namespace lacedring::gpu
