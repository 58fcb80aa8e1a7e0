#pragma once
// The materials of a glTF: metallic-roughness parameters, and the images of the textures.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lacedring {

/// How a texture coordinate outside [0, 1] is mapped into it.
enum class TextureWrap : std::uint8_t { repeat, mirror, clamp };

/// A texture as a material uses it.
struct TextureUse {
    static constexpr std::uint32_t kNone = UINT32_MAX;

    std::uint32_t image = kNone;  ///< index into Materials::images; kNone: there is no texture
    std::uint32_t set = 0;        ///< texture coordinates: 0 for TEXCOORD_0, 1 for TEXCOORD_1
    TextureWrap wrap_u = TextureWrap::repeat, wrap_v = TextureWrap::repeat;
    bool nearest = false;  ///< nearest-texel filtering
    /// The first two rows of a 3 x 3 matrix from the set's coordinates to the image's.
    std::array<float, 6> transform{1, 0, 0, 0, 1, 0};
};

/// Meaning of alpha, the product of the base color's and the vertex color's.
enum class AlphaMode : std::uint8_t {
    opaque,  ///< ignored
    mask,    ///< fragments with alpha below `cutoff` are discarded
    blend,   ///< transparency
};

/// Colors are linear. Each texture's values are multiplied by the factors of the same quantity.
struct Material {
    std::array<float, 4> base_color{1, 1, 1, 1};
    std::array<float, 3> emissive{0, 0, 0};
    float metallic = 1, roughness = 1;  ///< factors of the blue and green channels of `metallic_roughness`
    float normal_scale = 1;             ///< factor of a normal map's x and y
    float occlusion = 1;                ///< strength of the red channel of `occluding`
    float cutoff = 0.5F;
    AlphaMode alpha = AlphaMode::opaque;
    bool double_sided = false;  ///< triangles are visible from behind, too
    bool unlit = false;         ///< draws the base color without lighting
    bool flat = false;          ///< each triangle has its own normal, because the primitive has no normals
    TextureUse base, metallic_roughness, normal, occluding, emitting;
};

struct Materials {
    std::vector<Material> materials;
    std::vector<std::vector<std::byte>> images;  ///< PNG, JPEG, ... as in the file; empty: could not be read
    std::vector<std::uint32_t> of_triangle;      ///< material of each triangle; empty: the file has no materials
};

}  // namespace lacedring
