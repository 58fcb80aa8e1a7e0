#include "lrcore/base/crc32.h"

#include <array>

namespace lacedring {
namespace {

constexpr std::size_t kStep = 16;  // bytes at a time

/// [k][b]: the contribution to the remainder of byte b followed by k more bytes.
constexpr auto kTables = [] {
    std::array<std::array<std::uint32_t, 256>, kStep> out{};
    for (std::uint32_t b = 0; b < 256; ++b) {
        std::uint32_t r = b;
        for (int bit = 0; bit < 8; ++bit) r = (r >> 1) ^ ((r & 1) != 0 ? 0xedb88320U : 0U);
        out[0][b] = r;
    }
    for (std::size_t k = 1; k < kStep; ++k) {
        for (std::size_t b = 0; b < 256; ++b) out[k][b] = (out[k - 1][b] >> 8) ^ out[0][out[k - 1][b] & 255];
    }
    return out;
}();

}  // namespace

std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t before) {
    std::uint32_t r = ~before;
    for (; bytes.size() >= kStep; bytes = bytes.subspan(kStep)) {
        std::uint32_t next = 0;
        for (std::size_t i = 0; i < kStep; ++i) {
            std::uint32_t byte = std::to_integer<std::uint32_t>(bytes[i]);
            if (i < 4) byte ^= (r >> (8 * i)) & 255;
            next ^= kTables[kStep - 1 - i][byte];
        }
        r = next;
    }
    for (const std::byte byte : bytes) r = (r >> 8) ^ kTables[0][(r ^ std::to_integer<std::uint32_t>(byte)) & 255];
    return ~r;
}

}  // namespace lacedring
