#pragma once
// Images of materials as texels, with their mip maps.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lacedring/materials.hpp"

namespace lacedring::gpu {

struct TextureImage {
    std::uint32_t width = 0, height = 0;  ///< 0: there is no such image
    std::uint32_t levels = 0;             ///< mip maps, the image itself included: down to 1 x 1
    std::uint32_t first = 0;              ///< where its texels begin
};

struct Textures {
    std::vector<TextureImage> images;   ///< one for each of the materials'
    std::vector<std::uint32_t> texels;  ///< row by row, the upper one first; red in the lowest byte. Colors are sRGB's
    std::vector<std::string> notes;     ///< a line for each image that a material needs and that is not one
};

/// Decodes PNG, JPEG and what else stb_image reads. An image of more than 2^26 texels, or past 2^28 of all, is left
/// out. Untrusted input: as safe as stb_image is. Cost: O(texels).
Textures decode_textures(const Materials& materials);

/// The mip maps of an image, which lies at the end of `texels`, are appended; the number of all levels. `is_color`:
/// texels are averaged as light.
std::uint32_t append_mip_maps(std::vector<std::uint32_t>& texels, std::uint32_t width, std::uint32_t height,
                              bool is_color);

}  // namespace lacedring::gpu
