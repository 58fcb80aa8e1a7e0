#include "lrcore/base/crc32.h"

#include <zlib.h>

namespace lr {

std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t before) {
    if (bytes.empty()) return before;  // zlib takes a null pointer for "begin anew"
    return static_cast<std::uint32_t>(
        ::crc32_z(before, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

}  // namespace lr
