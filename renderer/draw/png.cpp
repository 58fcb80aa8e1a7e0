// PNG through stb.

#include "renderer/draw/png.h"

#include <stb_image.h>
#include <stb_image_write.h>

#include <cstring>

#include "lacedring/file.hpp"
#include "renderer/vk/try.h"

namespace lacedring::gpu {

Result<std::vector<std::byte>> encode_png(const Picture& picture) {
    std::vector<std::uint8_t> rgb(3 * picture.pixels());
    for (std::size_t i = 0; i < picture.pixels(); ++i) std::memcpy(&rgb[3 * i], &picture.rgba[4 * i], 3);
    std::vector<std::byte> encoded;
    const auto append = [](void* to, void* data, int size) {
        const auto* bytes = static_cast<const std::byte*>(data);
        static_cast<std::vector<std::byte>*>(to)->insert(static_cast<std::vector<std::byte>*>(to)->end(), bytes,
                                                         bytes + size);
    };
    if (stbi_write_png_to_func(append, &encoded, static_cast<int>(picture.width), static_cast<int>(picture.height), 3,
                               rgb.data(), static_cast<int>(3 * picture.width)) == 0) {
        return Error{ErrorCode::cannot_write, "PNG encoder failed"};
    }
    return encoded;
}

Result<void> write_png(const std::filesystem::path& path, const Picture& picture) {
    LR_ASSIGN(const std::vector<std::byte> encoded, encode_png(picture));
    const std::span<const std::byte> part = encoded;
    return write_file(path, std::span(&part, 1));
}

Result<Picture> read_png(const std::filesystem::path& path) {
    LR_ASSIGN(const std::vector<std::byte> bytes, read_file(path));
    int width = 0, height = 0, channels = 0;
    stbi_uc* pixels = stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()),
                                            static_cast<int>(bytes.size()), &width, &height, &channels, 4);
    if (pixels == nullptr) return Error{ErrorCode::malformed, std::string("PNG: ") + stbi_failure_reason()};
    Picture out;
    out.width = static_cast<std::uint32_t>(width);
    out.height = static_cast<std::uint32_t>(height);
    out.rgba.assign(pixels, pixels + 4 * out.pixels());
    stbi_image_free(pixels);
    return out;
}

}  // namespace lacedring::gpu
