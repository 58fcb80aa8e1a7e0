#include "renderer/slot_reader.h"

#include <algorithm>

#include "renderer/context.h"
#include "renderer/surface.h"
#include "renderer/try.h"
#include "spirv/slot_indices_comp.h"

namespace lr::gpu {

Result<SlotReader> SlotReader::create(Context& context) {
    SlotReader out;
    out.context_ = &context;
    const Binding binding{0};
    LR_ASSIGN(out.layout_, Layout::create(context, "slot indices", std::span(&binding, 1), VK_SHADER_STAGE_COMPUTE_BIT,
                                          sizeof(DrawConstants)));
    return out;
}

Result<std::vector<std::uint32_t>> SlotReader::read(Commands& commands, Transfer& transfer, const GpuMesh& mesh) {
    if (mesh.source == Source::plain) return Error{ErrorCode::invalid_argument, "an index list has no stream"};
    const bool packed = mesh.source == Source::packed;
    PipelineHandle& pipeline = pipelines_[packed ? 1 : 0];
    if (!pipeline) {
        const std::array<std::uint32_t, 4> constants{0, 0, packed ? 1U : 0U, 0};  // the triangles as they are
        LR_ASSIGN(pipeline, create_compute(*context_, "slot indices", layout_, spirv_slot_indices_comp, constants));
    }
    constexpr std::uint32_t kSlots = 1U << 20;
    const std::uint32_t step = std::min({kSlots, mesh.slots, static_cast<std::uint32_t>(mesh.max_range / 12)});
    LR_ASSIGN(const Buffer indices, Buffer::create(*context_, "slot indices", std::uint64_t{12} * step,
                                                   VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
    Descriptors descriptors(*context_);
    LR_ASSIGN(const VkDescriptorSet set, descriptors.allocate(layout_));
    descriptors.write(set, 0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {&indices});
    std::vector<std::uint32_t> out(std::size_t{3} * mesh.slots);
    for (std::uint32_t first = 0; first < mesh.slots; first += step) {
        const std::uint32_t slots = std::min(step, mesh.slots - first);
        const DrawConstants constants = draw_constants(mesh, first, slots);
        LR_ASSIGN(const VkCommandBuffer buffer, commands.begin());
        vkCmdBindPipeline(buffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.get());
        vkCmdBindDescriptorSets(buffer, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.pipeline(), 0, 1, &set, 0, nullptr);
        vkCmdPushConstants(buffer, layout_.pipeline(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(constants), &constants);
        vkCmdDispatch(buffer, (slots + LR_COMPUTE_GROUP - 1) / LR_COMPUTE_GROUP, 1, 1);
        LR_TRY(commands.run());
        const auto part = std::span(out).subspan(std::size_t{3} * first, std::size_t{3} * slots);
        LR_TRY(transfer.read(indices, 0, std::as_writable_bytes(part)));
    }
    return out;
}

}  // namespace lr::gpu
