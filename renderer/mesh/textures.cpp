#include "renderer/mesh/textures.h"

#include <stb_image.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>

namespace lacedring::gpu {
namespace {

constexpr std::uint64_t kMostOfOne = std::uint64_t{1} << 26, kMostOfAll = std::uint64_t{1} << 28;

/// How materials use an image.
struct ImageUse {
    bool is_used = false, is_color = false;
};

std::vector<ImageUse> uses_of(const Materials& materials) {
    std::vector<ImageUse> out(materials.images.size());
    const auto use = [&](const TextureUse& texture, bool is_color) {
        if (texture.image >= out.size()) return;
        out[texture.image].is_used = true;
        out[texture.image].is_color |= is_color;
    };
    for (const Material& m : materials.materials) {
        use(m.base, true);
        use(m.emitting, true);
        use(m.metallic_roughness, false);
        use(m.normal, false);
        use(m.occluding, false);
    }
    return out;
}

float linear(float c) {
    return c <= 0.04045F ? c / 12.92F : std::pow((c + 0.055F) / 1.055F, 2.4F);
}

/// Conversions between sRGB bytes and linear light in 16 bits.
struct ColorTables {
    std::array<std::uint16_t, 256> light;
    std::vector<std::uint8_t> byte;  ///< indexed by light / 16

    ColorTables() : byte(4096) {
        for (std::size_t i = 0; i < light.size(); ++i)
            light[i] = static_cast<std::uint16_t>(65535 * linear(static_cast<float>(i) / 255) + 0.5F);
        std::size_t b = 0;
        for (std::size_t i = 0; i < byte.size(); ++i) {
            while (b < 255 && 16 * i + 8 > (std::size_t{light[b]} + light[b + 1]) / 2) ++b;
            byte[i] = static_cast<std::uint8_t>(b);
        }
    }
};

/// The mean of four texels.
std::uint32_t mean(const std::array<std::uint32_t, 4>& of, bool is_color, const ColorTables& tables) {
    std::uint32_t out = 0;
    for (std::uint32_t shift = 0; shift < 32; shift += 8) {
        std::uint32_t sum = 0;
        const bool as_light = is_color && shift != 24;
        for (const std::uint32_t texel : of) {
            const std::uint32_t byte = texel >> shift & 255;
            sum += as_light ? tables.light[byte] : byte;
        }
        out |= static_cast<std::uint32_t>(as_light ? tables.byte[sum / 64] : (sum + 2) / 4) << shift;
    }
    return out;
}

}  // namespace

std::uint32_t append_mip_maps(std::vector<std::uint32_t>& texels, std::uint32_t width, std::uint32_t height,
                              bool is_color) {
    static const ColorTables kTables;
    std::uint32_t levels = 1;
    while (width > 1 || height > 1) {
        const std::size_t from = texels.size() - std::size_t{width} * height;
        const std::uint32_t half_width = std::max(width / 2, 1U), half_height = std::max(height / 2, 1U);
        texels.reserve(texels.size() + std::size_t{half_width} * half_height);
        for (std::uint32_t y = 0; y < half_height; ++y) {
            for (std::uint32_t x = 0; x < half_width; ++x) {
                const auto at = [&](std::uint32_t dx, std::uint32_t dy) {
                    const std::uint32_t sx = std::min(2 * x + dx, width - 1), sy = std::min(2 * y + dy, height - 1);
                    return texels[from + std::size_t{sy} * width + sx];
                };
                texels.push_back(mean({at(0, 0), at(1, 0), at(0, 1), at(1, 1)}, is_color, kTables));
            }
        }
        width = half_width;
        height = half_height;
        ++levels;
    }
    return levels;
}

Textures decode_textures(const Materials& materials) {
    Textures out;
    out.images.resize(materials.images.size());
    const std::vector<ImageUse> uses = uses_of(materials);
    for (std::size_t i = 0; i < uses.size(); ++i) {
        const std::vector<std::byte>& bytes = materials.images[i];
        if (!uses[i].is_used || bytes.empty()) continue;  // the file reader has reported empty images
        const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
        const auto size = static_cast<int>(std::min<std::size_t>(bytes.size(), INT32_MAX));
        int width = 0, height = 0, channels = 0;
        const auto leave_out = [&](const std::string& why) {
            out.notes.push_back("not drawn: image " + std::to_string(i) + ": " + why);
        };
        if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0) {
            leave_out("neither PNG nor JPEG");
            continue;
        }
        const std::uint64_t texels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
        if (texels == 0 || texels > kMostOfOne || width > UINT16_MAX || height > UINT16_MAX ||
            out.texels.size() + texels / 3 * 4 > kMostOfAll) {
            leave_out(std::to_string(width) + " x " + std::to_string(height) + " texels are too many");
            continue;
        }
        const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
            stbi_load_from_memory(data, size, &width, &height, &channels, 4), stbi_image_free);
        if (!pixels) {
            leave_out(stbi_failure_reason());
            continue;
        }
        TextureImage& image = out.images[i];
        image.width = static_cast<std::uint32_t>(width);
        image.height = static_cast<std::uint32_t>(height);
        image.first = static_cast<std::uint32_t>(out.texels.size());
        out.texels.resize(out.texels.size() + texels);
        std::memcpy(out.texels.data() + image.first, pixels.get(), 4 * texels);
        image.levels = append_mip_maps(out.texels, image.width, image.height, uses[i].is_color);
    }
    return out;
}

}  // namespace lacedring::gpu
