#include "renderer/mesh/gpu_materials.h"

#include <algorithm>
#include <cstring>
#include <span>

#include "renderer/mesh/textures.h"
#include "renderer/vk/context.h"
#include "renderer/vk/try.h"
#include "shaders/shared.h"

namespace lacedring::gpu {
namespace {

TextureConstants constants_of(const TextureUse& use, const Textures& textures) {
    TextureConstants out{};
    if (use.image >= textures.images.size()) return out;
    const TextureImage& image = textures.images[use.image];
    out.first = image.first;
    out.size = image.width | image.height << 16;
    out.levels = image.levels;
    out.sampling = (use.set != 0 ? LR_TEXTURE_SET : 0U) | (use.nearest ? LR_TEXTURE_NEAREST : 0U) |
                   static_cast<std::uint32_t>(use.wrap_u) << LR_TEXTURE_WRAP_U |
                   static_cast<std::uint32_t>(use.wrap_v) << LR_TEXTURE_WRAP_V;
    const std::array<float, 6>& t = use.transform;
    out.u = {t[0], t[1], t[2], 0};
    out.v = {t[3], t[4], t[5], 0};
    return out;
}

MaterialConstants constants_of(const Material& m, const Textures& textures) {
    MaterialConstants out{};
    out.base_color = m.base_color;
    out.emissive = {m.emissive[0], m.emissive[1], m.emissive[2], m.cutoff};
    out.surface = {m.metallic, m.roughness, m.normal_scale, m.occlusion};
    out.flags[0] = (m.double_sided ? LR_MATERIAL_DOUBLE_SIDED : 0U) | (m.unlit ? LR_MATERIAL_UNLIT : 0U) |
                   (m.alpha == AlphaMode::mask ? LR_MATERIAL_MASK : 0U) |
                   (m.alpha == AlphaMode::blend ? LR_MATERIAL_BLEND : 0U) | (m.flat ? LR_MATERIAL_FLAT : 0U);
    out.base = constants_of(m.base, textures);
    out.metallic_roughness = constants_of(m.metallic_roughness, textures);
    out.normal = constants_of(m.normal, textures);
    out.occluding = constants_of(m.occluding, textures);
    out.emitting = constants_of(m.emitting, textures);
    return out;
}

/// One gray material, for a mesh that has no materials.
Materials gray_material(std::uint32_t triangles) {
    Materials out;
    Material& m = out.materials.emplace_back();
    m.base_color = {0.62F, 0.60F, 0.565F, 1};
    m.metallic = 0;
    m.roughness = 0.55F;
    m.double_sided = true;
    out.of_triangle.assign(triangles, 0);
    return out;
}

}  // namespace

Result<GpuMaterials> upload_materials(Context& context, Transfer& transfer, const Materials* materials,
                                      std::uint32_t triangles) {
    if (materials == nullptr || materials->of_triangle.empty()) {
        const Materials made = gray_material(triangles);
        return upload_materials(context, transfer, &made, triangles);
    }
    const std::vector<std::uint32_t>& of = materials->of_triangle;
    if (of.size() != triangles || std::ranges::max(of) >= materials->materials.size())
        return Error{ErrorCode::invalid_argument, "the materials are not of this mesh"};
    constexpr VkBufferUsageFlags kUsage =
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
    GpuMaterials out;
    Textures textures = decode_textures(*materials);
    out.notes = std::move(textures.notes);
    const std::span<const std::uint32_t> texels = textures.texels, numbers = of;
    LR_ASSIGN(out.texels, Buffer::create(context, "texels", texels.size_bytes(), kUsage));
    if (!texels.empty()) LR_TRY(transfer.upload(out.texels, texels));
    LR_ASSIGN(out.of_triangle, Buffer::create(context, "materials of triangles", numbers.size_bytes(), kUsage));
    LR_TRY(transfer.upload(out.of_triangle, numbers));

    std::vector<std::byte> table(sizeof(MaterialHead) + materials->materials.size() * sizeof(MaterialConstants));
    const MaterialHead head{out.of_triangle.address_words(), out.texels.address_words()};
    std::memcpy(table.data(), &head, sizeof head);
    for (std::size_t i = 0; i < materials->materials.size(); ++i) {
        const MaterialConstants constants = constants_of(materials->materials[i], textures);
        std::memcpy(table.data() + sizeof head + i * sizeof constants, &constants, sizeof constants);
    }
    LR_ASSIGN(out.table, Buffer::create(context, "materials", table.size(), kUsage));
    LR_TRY(transfer.upload(out.table, std::span<const std::byte>(table)));
    return out;
}

}  // namespace lacedring::gpu
