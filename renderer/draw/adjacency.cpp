#include "renderer/draw/adjacency.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "lacedring/lacedring.hpp"
#include "lacedring/streams.hpp"
#include "renderer/draw/surface.h"
#include "renderer/vk/context.h"
#include "renderer/vk/try.h"
#include "shaders/adjacency/adjacency_shared.h"
#include "spirv/silhouette_frag.h"
#include "spirv/silhouette_vert.h"
#include "spirv/vertex_normals_comp.h"

namespace lacedring::gpu {
namespace {

constexpr VkBufferUsageFlags kAddress = VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

}  // namespace

Result<Adjacency> upload_adjacency(Context& context, Transfer& transfer, const EncodedLr& tables,
                                   std::span<const float> positions) {
    LR_ASSIGN(const LrStreamView<LrView> stream, view_lr(tables.words));
    const std::uint64_t position_bytes = std::uint64_t{3} * sizeof(float) * tables.vertex_order.size();
    const std::uint64_t table_bytes = tables.words.size() * sizeof(std::uint32_t);
    LR_TRY(context.arena().check_room(table_bytes + position_bytes, std::max(table_bytes, position_bytes)));
    Adjacency out;
    out.vertices = stream.view.vertices;
    out.triangle_numbers = stream.view.triangle_numbers();
    out.vertex_order = tables.vertex_order;
    LR_ASSIGN(out.tables, Buffer::create(context, "LR tables", table_bytes, kAddress));
    LR_ASSIGN(out.positions, Buffer::create(context, "positions in LR order", position_bytes, kAddress));
    LR_TRY(transfer.upload(out.tables, std::span<const std::uint32_t>(tables.words)));
    constexpr std::size_t kUnit = 3 * sizeof(float);
    LR_TRY(transfer.upload(out.positions, 0, position_bytes, kUnit,
                           [&](std::byte* to, std::size_t from, std::size_t size) {
                               for (std::size_t v = from / kUnit; v < (from + size) / kUnit; ++v, to += kUnit) {
                                   std::memcpy(to, &positions[3 * std::size_t{out.vertex_order[v]}], kUnit);
                               }
                           }));
    return out;
}

Result<Adjacency> upload_adjacency(Context& context, Transfer& transfer, const Model& model,
                                   const AdjacencyOptions& options) {
    LR_ASSIGN(CornerTable table, build_corner_table(surface_triangles(model), model.surface.vertex_count));
    LR_ASSIGN(EncodedLr tables, encode_lr(std::move(table), options.ring, {.passes = 0}, options.wart_skipping));
    const std::vector<std::uint32_t> of_surface = first_vertices(model.surface);
    for (std::uint32_t& v : tables.vertex_order) v = of_surface[v];
    return upload_adjacency(context, transfer, tables, model.positions);
}

Result<VertexNormals> VertexNormals::create(Context& context) {
    VertexNormals out;
    out.context_ = &context;
    LR_ASSIGN(out.layout_,
              Layout::create(context, "vertex normals", {}, VK_SHADER_STAGE_COMPUTE_BIT, sizeof(NormalConstants)));
    LR_ASSIGN(out.pipeline_, create_compute(context, "vertex normals", out.layout_, spirv_vertex_normals_comp));
    return out;
}

Result<Buffer> VertexNormals::compute(Commands& commands, const Adjacency& adjacency) const {
    LR_ASSIGN(Buffer normals, Buffer::create(*context_, "normals", adjacency.positions.size(), kAddress));
    LR_ASSIGN(const VkCommandBuffer buffer, commands.begin());
    vkCmdBindPipeline(buffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
    const std::uint64_t step = std::uint64_t{context_->limits().maxComputeWorkGroupCount[0]} * LR_COMPUTE_GROUP;
    for (std::uint64_t first = 0; first < adjacency.vertices; first += step) {
        const std::uint64_t end = std::min<std::uint64_t>(first + step, adjacency.vertices);
        const NormalConstants constants{adjacency.tables.address_words(), adjacency.positions.address_words(),
                                        normals.address_words(), static_cast<std::uint32_t>(first),
                                        static_cast<std::uint32_t>(end)};
        vkCmdPushConstants(buffer, layout_.pipeline(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(constants), &constants);
        vkCmdDispatch(buffer, static_cast<std::uint32_t>((end - first + LR_COMPUTE_GROUP - 1) / LR_COMPUTE_GROUP), 1,
                      1);
    }
    memory_barrier(buffer, {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT},
                   {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT});
    LR_TRY(commands.run());
    return normals;
}

Result<Silhouettes> Silhouettes::create(Context& context, std::uint32_t lines_per_draw) {
    Silhouettes out;
    out.context_ = &context;
    out.lines_per_draw_ = std::clamp(lines_per_draw, 1U, 1U << 29);  // gl_VertexIndex is signed
    constexpr VkShaderStageFlags kVertex = VK_SHADER_STAGE_VERTEX_BIT;
    const Binding frame{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kVertex | VK_SHADER_STAGE_FRAGMENT_BIT};
    LR_ASSIGN(out.layout_,
              Layout::create(context, "silhouettes", std::span(&frame, 1), kVertex, sizeof(SilhouetteConstants)));
    LR_ASSIGN(out.pipeline_,
              create_graphics(context, out.layout_,
                              line_pipeline("silhouettes", spirv_silhouette_vert, spirv_silhouette_frag)));
    LR_ASSIGN(out.frame_, Buffer::create(context, "silhouette frame", sizeof(SilhouetteFrame),
                                         VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, Memory::upload));
    out.descriptors_ = Descriptors(context);
    LR_ASSIGN(out.set_, out.descriptors_.allocate(out.layout_));
    out.descriptors_.write(out.set_, 0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, {&out.frame_});
    return out;
}

std::array<float, 3> eye_of(const Camera& camera) {
    const mat4& m = camera.view_from_world;  // a rotation R and a translation t: the eye is at -R^T t
    std::array<float, 3> eye{};
    for (std::size_t i = 0; i < 3; ++i) {
        double sum = 0;
        for (std::size_t row = 0; row < 3; ++row) sum -= double{m[4 * i + row]} * double{m[12 + row]};
        eye[i] = static_cast<float>(sum);
    }
    return eye;
}

void Silhouettes::set_frame(const Camera& camera, const Target& target, const SilhouetteStyle& style) {
    SilhouetteFrame frame{};
    frame.view_from_world = camera.view_from_world;
    frame.clip_from_view = target.clip_from_view(camera);
    const std::array<float, 3> eye = eye_of(camera);
    frame.eye = {eye[0], eye[1], eye[2], 1};
    frame.color = style.color;
    std::memcpy(frame_.mapped(), &frame, sizeof(frame));
    line_width_ = std::clamp(style.width, 1.0F, context_->info().max_line_width);
    // No cosine is below -2, even with rounding errors: no edge is a crease.
    crease_cos_ = style.crease >= 180 ? -2.0F : static_cast<float>(std::cos(style.crease * std::numbers::pi / 180));
}

void Silhouettes::record(VkCommandBuffer commands, const Adjacency& adjacency, const Target& target) const {
    Target::between(commands);
    target.begin(commands, {.color = true});
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.get());
    vkCmdSetLineWidth(commands, line_width_);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.pipeline(), 0, 1, &set_, 0, nullptr);
    // Three lines per triangle number: each edge comes twice, once from each side; some numbers have no triangle. The
    // shader drops the superfluous lines.
    const std::uint64_t all = std::uint64_t{3} * adjacency.triangle_numbers;
    for (std::uint64_t first = 0; first < all; first += lines_per_draw_) {
        const SilhouetteConstants constants{adjacency.tables.address_words(), adjacency.positions.address_words(),
                                            static_cast<std::uint32_t>(first), crease_cos_};
        vkCmdPushConstants(commands, layout_.pipeline(), VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(constants), &constants);
        const std::uint64_t lines = std::min<std::uint64_t>(lines_per_draw_, all - first);
        vkCmdDraw(commands, static_cast<std::uint32_t>(2 * lines), 1, 0, 0);
    }
    Target::end(commands);
}

}  // namespace lacedring::gpu
