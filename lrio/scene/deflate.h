#pragma once
// Compresses and decompresses zlib streams. Internal to lrio.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/base.hpp"

namespace lacedring::detail {

/// Compresses to a zlib stream. Errors: too_large (4 GiB).
Result<std::vector<std::byte>> deflate_bytes(std::span<const std::byte> bytes);

/// Decompresses a zlib stream. Errors: malformed (no zlib stream, bytes after its end), `beyond` (more than `most`
/// decompressed bytes). Untrusted input: safe; takes at most twice the decompressed bytes, whatever `most` is.
Result<std::vector<std::byte>> inflate_bytes(std::span<const std::byte> bytes, std::uint64_t most,
                                             ErrorCode beyond = ErrorCode::malformed);

}  // namespace lacedring::detail
