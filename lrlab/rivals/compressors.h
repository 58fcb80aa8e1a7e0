#pragma once
// Sizes of data compressed by general-purpose compressors at their best levels. std::nullopt: the build lacks the
// compressor.

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
