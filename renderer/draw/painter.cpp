#include "renderer/draw/painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>

#include "renderer/vk/context.h"
#include "renderer/vk/try.h"
#include "spirv/line_frag.h"
#include "spirv/line_pull_vert.h"
#include "spirv/line_vert.h"

namespace lacedring::gpu {

Result<Painter> Painter::create(Context& context, View view, std::uint32_t samples, bool outlined) {
    Painter out;
    out.context_ = &context;
    out.view_ = view;
    out.samples_ = samples;
    out.outlined_ = outlined;
    constexpr VkShaderStageFlags kFragment = VK_SHADER_STAGE_FRAGMENT_BIT;
    const VkShaderStageFlags stages = surface_stages(context);
    const std::array<Binding, 4> bindings{{{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, stages},
                                           {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kFragment},
                                           {2, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kFragment},
                                           {3, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kFragment}}};
    LR_ASSIGN(out.layout_, Layout::create(context, "draw", bindings, stages, sizeof(DrawConstants)));
    LR_ASSIGN(out.frame_, Buffer::create(context, "frame", sizeof(FrameConstants), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                                         Memory::upload));
    LR_ASSIGN(out.nothing_, Buffer::create(context, "nothing", 16, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
    return out;
}

Result<Painter> Painter::again() const {
    LR_ASSIGN(Painter out, create(*context_, view_, samples_, outlined_));
    for (const auto& [key, surface] : surfaces_) LR_TRY(out.make_surface(key));
    for (const auto& [key, lines] : lines_) LR_TRY(out.make_lines(key));
    return out;
}

Result<void> Painter::make_lines(const LineKey& key) {
    const auto [pulled, seams] = key;
    if (upload_options(view_).lines == UploadOptions::Lines::none || lines_.contains(key)) return {};
    GraphicsInfo lines = line_pipeline("lines", pulled ? spirv_line_pull_vert : spirv_line_vert, spirv_line_frag);
    if (pulled) {
        lines.constants = {0, 0, 0, 0, 0, seams ? VK_TRUE : VK_FALSE};
    } else {
        lines.vertex_binding = {0, sizeof(Vertex), VK_VERTEX_INPUT_RATE_VERTEX};
        lines.vertex_attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)}};
    }
    LR_ASSIGN(PipelineHandle pipeline, create_graphics(*context_, layout_, lines));
    lines_.emplace(key, std::move(pipeline));
    return {};
}

Result<void> Painter::make_surface(const SurfaceKey& key) {
    if (surfaces_.contains(key)) return {};
    const auto [source, path, seams] = key;
    LR_ASSIGN(Surface surface, Surface::create(*context_, layout_, view_, source, path, seams, outlined_));
    surfaces_.emplace(key, std::move(surface));
    return {};
}

Result<DrawPlan> Painter::plan(Descriptors& descriptors, const GpuMesh& mesh, const Target& target) {
    LR_TRY(make_surface(key_of(mesh)));
    LR_TRY(make_lines(line_key_of(mesh)));
    DrawPlan plan;
    for (std::uint32_t draw = 0; draw < mesh.draws; ++draw) {
        const std::uint64_t first = std::uint64_t{draw} * mesh.draw_slots;
        const std::uint64_t slots = std::min<std::uint64_t>(mesh.draw_slots, mesh.slots - first);
        LR_ASSIGN(const VkDescriptorSet set, descriptors.allocate(layout_));
        descriptors.write(set, 0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, {&frame_});
        BufferRange triangles{&nothing_}, classes{&nothing_};
        if (mesh.slot_triangle) triangles = {&mesh.slot_triangle, 4 * first, 4 * slots};
        if (mesh.classes) classes = {&mesh.classes, first, (slots + 3) / 4 * 4};
        descriptors.write(set, 1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, triangles);
        descriptors.write(set, 2, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, classes);
        descriptors.write_image(set, 3, target.winner().view());
        plan.sets.push_back(set);
    }
    return plan;
}

void Painter::set_frame(const Model& model, const Camera& camera, const Target& target) {
    FrameConstants frame{};
    frame.view_from_world = camera.view_from_world;
    frame.clip_from_view = target.clip_from_view(camera);
    // Lines fade as edges get only a few pixels long: opaque lines would paint the mesh black.
    const double pixels = model.mean_edge * camera.pixels_per_unit / samples_;
    const double strength = std::clamp((pixels - 1.0) / 9.0, 0.0, 1.0);
    if (view_ == View::wire) {
        frame.line_color = {0.07F, 0.08F, 0.10F, static_cast<float>(0.13 + 0.57 * strength)};
        line_width_ = static_cast<float>(0.6 + 0.6 * strength) * static_cast<float>(samples_);
    } else if (view_ == View::seams) {
        frame.line_color = {0.80F, 0.06F, 0.03F, static_cast<float>(0.55 + 0.40 * strength)};
        line_width_ = static_cast<float>(1.2 + 1.2 * strength) * static_cast<float>(samples_);
    } else {
        // In the views of ring order and offsets the colors matter more than the line.
        const double opacity = view_ == View::triangle_class ? 0.22 + 0.76 * strength : 0.10 + 0.80 * strength;
        const double closer = std::clamp((pixels - 10.0) / 40.0, 0.0, 1.0);
        frame.line_color = {0.03F, 0.03F, 0.03F, static_cast<float>(opacity)};
        line_width_ = static_cast<float>(0.7 + 1.5 * strength + 1.3 * closer) * static_cast<float>(samples_);
    }
    line_width_ = std::clamp(line_width_, 1.0F, context_->info().max_line_width);
    std::memcpy(frame_.mapped(), &frame, sizeof(frame));
}

void Painter::draw_lines(VkCommandBuffer commands, const GpuMesh& mesh, const DrawPlan& plan) const {
    if (mesh.line_indices == 0) return;
    const VkBuffer vertices = mesh.vertices.handle();
    const VkDeviceSize zero = 0;
    const DrawConstants constants = draw_constants(mesh, 0, mesh.slots);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, lines_.at(line_key_of(mesh)).get());
    vkCmdPushConstants(commands, layout_.pipeline(), surface_stages(*context_), 0, sizeof(constants), &constants);
    vkCmdSetLineWidth(commands, line_width_);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.pipeline(), 0, 1, &plan.sets[0], 0,
                            nullptr);
    if (!mesh.pulls_positions()) vkCmdBindVertexBuffers(commands, 0, 1, &vertices, &zero);
    vkCmdBindIndexBuffer(commands, mesh.lines.handle(), 0, VK_INDEX_TYPE_UINT32);
    vkCmdDrawIndexed(commands, mesh.line_indices, 1, 0, 0, 0);
}

void Painter::record(VkCommandBuffer commands, const GpuMesh& mesh, const DrawPlan& plan, const Target& target,
                     Ties ties) const {
    const Surface& triangles = surfaces_.at(key_of(mesh));
    target.prepare(commands);
    Target::Use surface{.color = true, .triangles = true, .clear_color = true, .clear_depth = true};
    if (ties == Ties::by_number) {
        target.begin(commands, {.clear_depth = true});
        triangles.draw(commands, Surface::depth, mesh, plan);
        triangles.draw(commands, Surface::claim, mesh, plan);
        Target::end(commands);
        Target::between(commands);
        surface.clear_depth = false;
    }
    target.begin(commands, surface);
    triangles.draw(commands, ties == Ties::by_number ? Surface::resolve : Surface::single, mesh, plan);
    Target::end(commands);
    if (!lines_.empty()) {
        Target::between(commands);
        target.begin(commands, {.color = true});
        draw_lines(commands, mesh, plan);
        Target::end(commands);
    }
}

}  // namespace lacedring::gpu
