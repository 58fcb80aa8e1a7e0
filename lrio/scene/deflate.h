#pragma once
// zlib streams, which every browser and language can read. Internal to lrio.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/base.hpp"

namespace lacedring::detail {

/// Errors: too_large (4 GiB).
Result<std::vector<std::byte>> deflate_bytes(std::span<const std::byte> bytes);

/// Errors: malformed (no zlib stream, bytes behind its end), `beyond` (more than `most` bytes come out). Untrusted
/// input: safe; takes twice the bytes that come out, whatever `most` is.
Result<std::vector<std::byte>> inflate_bytes(std::span<const std::byte> bytes, std::uint64_t most,
                                             ErrorCode beyond = ErrorCode::malformed);

}  // namespace lacedring::detail
