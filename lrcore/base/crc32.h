#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace lacedring {

/// CRC-32 (zlib's) of `bytes`, continuing from `before`.
std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t before = 0);

}  // namespace lacedring
