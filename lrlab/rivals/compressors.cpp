#include "lrlab/rivals/compressors.h"

#include <zlib.h>
#ifdef LACEDRING_ZSTD
#include <zstd.h>
#endif
#ifdef LACEDRING_BROTLI
#include <brotli/encode.h>
#endif

#include <cstdint>
#include <vector>

namespace lacedring {

std::size_t deflated_size(std::span<const std::byte> bytes) {
    uLongf size = compressBound(static_cast<uLong>(bytes.size()));
    std::vector<Bytef> out(size);
    const int done = compress2(out.data(), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                               static_cast<uLong>(bytes.size()), Z_BEST_COMPRESSION);
    return done == Z_OK ? size : bytes.size();
}

std::optional<std::size_t> zstd_size([[maybe_unused]] std::span<const std::byte> bytes) {
#ifdef LACEDRING_ZSTD
    constexpr int kLevel = 19;
    std::vector<std::byte> out(ZSTD_compressBound(bytes.size()));
    const std::size_t size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), kLevel);
    if (ZSTD_isError(size) == 0) return size;
#endif
    return {};
}

std::optional<std::size_t> brotli_size([[maybe_unused]] std::span<const std::byte> bytes) {
#ifdef LACEDRING_BROTLI
    std::size_t size = BrotliEncoderMaxCompressedSize(bytes.size());
    std::vector<std::uint8_t> out(size);
    if (BrotliEncoderCompress(BROTLI_MAX_QUALITY, BROTLI_MAX_WINDOW_BITS, BROTLI_MODE_GENERIC, bytes.size(),
                              reinterpret_cast<const std::uint8_t*>(bytes.data()), &size, out.data()) == BROTLI_TRUE) {
        return size;
    }
#endif
    return {};
}

}  // namespace lacedring
