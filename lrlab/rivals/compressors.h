#pragma once
// General compressors: bytes that each makes of a format at its best. Those that a build lacks give nothing.

#include <cstddef>
#include <optional>
#include <span>

namespace lacedring {

/// zlib's deflate, level 9.
std::size_t deflated_size(std::span<const std::byte> bytes);

/// Zstandard, level 19.
std::optional<std::size_t> zstd_size(std::span<const std::byte> bytes);

/// Brotli, quality 11, window of 16 MiB.
std::optional<std::size_t> brotli_size(std::span<const std::byte> bytes);

}  // namespace lacedring
