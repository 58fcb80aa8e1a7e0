#include "renderer/draw/surface.h"

#include <algorithm>
#include <cstddef>

#include "renderer/draw/target.h"
#include "renderer/vk/context.h"
#include "renderer/vk/try.h"
#include "spirv/claim_frag.h"
#include "spirv/material_alpha_frag.h"
#include "spirv/material_claim_frag.h"
#include "spirv/material_frag.h"
#include "spirv/surface_frag.h"
#include "spirv/surface_geom.h"
#include "spirv/surface_geometry_vert.h"
#include "spirv/surface_mesh.h"
#include "spirv/surface_pull_vert.h"
#include "spirv/surface_vert.h"

namespace lacedring::gpu {
namespace {

constexpr std::array<const char*, Surface::kPasses> kNames{"depth", "claim", "resolve", "single pass"};

GraphicsInfo vertex_stages(Path path) {
    GraphicsInfo info;
    switch (path) {
        case Path::compute:
            info.vertex = spirv_surface_vert;
            info.vertex_binding = {0, sizeof(Vertex), VK_VERTEX_INPUT_RATE_VERTEX};
            info.vertex_attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)},
                                      {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, normal)},
                                      {2, 0, VK_FORMAT_R32_SFLOAT, offsetof(Vertex, ring)}};
            break;
        case Path::pull:
            info.vertex = spirv_surface_pull_vert;
            break;
        case Path::geometry:
            info.vertex = spirv_surface_geometry_vert;
            info.geometry = spirv_surface_geom;
            info.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
            break;
        case Path::mesh:
            info.mesh = spirv_surface_mesh;
    }
    return info;
}

}  // namespace

VkShaderStageFlags surface_stages(const Context& context) {
    const VkShaderStageFlags mesh = context.info().max_mesh_groups != 0 ? VK_SHADER_STAGE_MESH_BIT_EXT : 0;
    return VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_GEOMETRY_BIT | VK_SHADER_STAGE_FRAGMENT_BIT | mesh;
}

Result<Surface> Surface::create(Context& context, const Layout& layout, View view, Source source, Path path, bool seams,
                                bool outlined) {
    Surface out;
    out.context_ = &context;
    out.layout_ = layout.pipeline();
    for (const Pass pass : {depth, claim, resolve, single}) {
        GraphicsInfo info = vertex_stages(path);
        info.name = kNames[pass];
        info.push_back = has_lines(view) || outlined;
        // The passes of exact pictures rotate triangles to begin with their smallest vertex. With Path::compute, the
        // Rotator has done so in the index buffer.
        info.constants = {static_cast<std::uint32_t>(view),
                          pass == resolve ? VK_TRUE : VK_FALSE,
                          is_packed(source) ? VK_TRUE : VK_FALSE,
                          pass != single ? VK_TRUE : VK_FALSE,
                          source == Source::packed_vertices ? VK_TRUE : VK_FALSE,
                          seams ? VK_TRUE : VK_FALSE};
        if (pass == claim || pass == resolve) {
            info.depth_compare = VK_COMPARE_OP_EQUAL;
            info.depth_write = false;
        }
        const bool materials = view == View::material;
        if (pass == depth && materials) info.fragment = spirv_material_alpha_frag;
        if (pass == claim) info.fragment = materials ? spirv_material_claim_frag : spirv_claim_frag;
        if (pass == resolve || pass == single) {
            info.fragment = materials ? spirv_material_frag : spirv_surface_frag;
            info.colors = {Target::kColor, Target::kTriangles};
        }
        LR_ASSIGN(out.pipelines_[pass], create_graphics(context, layout, info));
    }
    return out;
}

void Surface::draw(VkCommandBuffer commands, Pass pass, const GpuMesh& mesh, const DrawPlan& plan) const {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines_[pass].get());
    if (mesh.path == Path::compute) {
        const VkBuffer vertices = mesh.vertices.handle();
        const VkDeviceSize zero = 0;
        vkCmdBindVertexBuffers(commands, 0, 1, &vertices, &zero);
        vkCmdBindIndexBuffer(commands, mesh.drawn_indices().handle(), 0, VK_INDEX_TYPE_UINT32);
    }
    for (std::uint32_t draw = 0; draw < mesh.draws; ++draw) {
        const std::uint32_t first = draw * mesh.draw_slots;
        const std::uint32_t slots = std::min(mesh.draw_slots, mesh.slots - first);
        const DrawConstants constants = draw_constants(mesh, first, slots);
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1, &plan.sets[draw], 0, nullptr);
        vkCmdPushConstants(commands, layout_, surface_stages(*context_), 0, sizeof(constants), &constants);
        switch (mesh.path) {
            case Path::compute:
                if (mesh.commands) {
                    constexpr std::uint32_t kStride = sizeof(VkDrawIndexedIndirectCommand);
                    vkCmdDrawIndexedIndirect(commands, mesh.commands.handle(), std::uint64_t{draw} * kStride, 1,
                                             kStride);
                } else {
                    vkCmdDrawIndexed(commands, 3 * slots, 1, 3 * first, 0, 0);
                }
                break;
            case Path::pull:
                vkCmdDraw(commands, 3 * slots, 1, 0, 0);
                break;
            case Path::geometry:
                vkCmdDraw(commands, (slots + LR_GEOMETRY_SLOTS - 1) / LR_GEOMETRY_SLOTS, 1, 0, 0);
                break;
            case Path::mesh:
                context_->draw_mesh_tasks()(commands, (slots + LR_MESH_TRIANGLES - 1) / LR_MESH_TRIANGLES, 1, 1);
        }
    }
}

GraphicsInfo line_pipeline(const char* name, const Shader& vertex, const Shader& fragment) {
    GraphicsInfo info;
    info.name = name;
    info.vertex = vertex;
    info.fragment = fragment;
    info.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
    info.depth_compare = VK_COMPARE_OP_LESS_OR_EQUAL;
    info.depth_write = false;
    info.blend = true;
    info.colors = {Target::kColor};
    return info;
}

DrawConstants draw_constants(const GpuMesh& mesh, std::uint32_t first, std::uint32_t slots) {
    DrawConstants constants{};
    constants.first_slot = first;
    constants.ordered = mesh.source == Source::plain ? 0 : 1;
    constants.slots = slots;
    constants.stream = mesh.stream.address_words();
    constants.vertices = mesh.vertices.address_words();
    constants.vertex_order = mesh.vertex_order.address_words();
    constants.vertex_stream = mesh.vertex_stream.address_words();
    constants.copies = mesh.copies.address_words();
    constants.copy_vertices = mesh.copy_vertices.address_words();
    constants.shading = mesh.shading.address_words();
    constants.materials = mesh.materials;
    constants.stream_layout = mesh.stream_layout;
    constants.unit = mesh.unit;
    return constants;
}

}  // namespace lacedring::gpu
