#pragma once
// Decodes the images of materials to texels and adds mip maps.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lacedring/materials.hpp"

namespace lacedring::gpu {

struct TextureImage {
    std::uint32_t width = 0, height = 0;  ///< 0: unused, missing or not decoded
    std::uint32_t levels = 0;             ///< mip levels from the image itself down to 1 x 1
    std::uint32_t first = 0;              ///< index of its first texel in Textures::texels
};

struct Textures {
    std::vector<TextureImage> images;   ///< parallel to Materials::images
    std::vector<std::uint32_t> texels;  ///< row by row from the top, red in the lowest byte; colors are sRGB
    std::vector<std::string> notes;     ///< a line for each image that is used but could not be decoded
};

/// Decodes PNG, JPEG and the other formats of stb_image. Leaves out images of more than 2^26 texels, and images that
/// would bring the total above 2^28. Untrusted input: as safe as stb_image is. Cost: O(texels).
Textures decode_textures(const Materials& materials);

/// Appends the mip maps of the image at the end of `texels`; returns the number of levels, the image included.
/// `is_color`: averages texels in linear light.
std::uint32_t append_mip_maps(std::vector<std::uint32_t>& texels, std::uint32_t width, std::uint32_t height,
                              bool is_color);

}  // namespace lacedring::gpu
