#pragma once
// What the triangles of a glTF look like: metallic-roughness materials, and the images of their textures.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lacedring {

/// How a coordinate outside [0, 1] finds its texel.
enum class TextureWrap : std::uint8_t { repeat, mirror, clamp };

/// A texture as a material uses it.
struct TextureUse {
    static constexpr std::uint32_t kNone = UINT32_MAX;

    std::uint32_t image = kNone;  ///< in Materials::images; kNone: there is no texture
    std::uint32_t set = 0;        ///< of texture coordinates: TEXCOORD_0 or TEXCOORD_1
    TextureWrap wrap_u = TextureWrap::repeat, wrap_v = TextureWrap::repeat;
    bool nearest = false;                              ///< the nearest texel, without blending
    std::array<float, 6> transform{1, 0, 0, 0, 1, 0};  ///< two rows: from the coordinates of the set to the image's
};

/// Of the coverage (alpha) of base color and vertex color.
enum class AlphaMode : std::uint8_t {
    opaque,  ///< ignored
    mask,    ///< nothing is seen where it is below `cutoff`
    blend,   ///< as transparent as it says
};

/// Colors are linear. Each texture's values are multiplied by the numbers beside it.
struct Material {
    std::array<float, 4> base_color{1, 1, 1, 1};
    std::array<float, 3> emissive{0, 0, 0};
    float metallic = 1, roughness = 1;  ///< by the blue and the green of `metallic_roughness`
    float normal_scale = 1;             ///< of a normal map's x and y
    float occlusion = 1;                ///< how much of `occluding`'s red counts
    float cutoff = 0.5F;
    AlphaMode alpha = AlphaMode::opaque;
    bool double_sided = false;  ///< triangles are seen from behind, too
    bool unlit = false;         ///< base color alone, without light
    bool flat = false;          ///< each triangle has its own normal: of primitives without normals
    TextureUse base, metallic_roughness, normal, occluding, emitting;
};

struct Materials {
    std::vector<Material> materials;
    std::vector<std::vector<std::byte>> images;  ///< as the file has them: PNG, JPEG, ...; empty: not to be had
    std::vector<std::uint32_t> of_triangle;      ///< of each triangle of the mesh; empty: the file has no materials
};

}  // namespace lacedring
