#include "renderer/rotator.h"

#include <algorithm>
#include <array>

#include "renderer/context.h"
#include "renderer/try.h"
#include "spirv/rotate_comp.h"

namespace lr::gpu {

Result<Rotator> Rotator::create(Context& context) {
    Rotator out;
    out.context_ = &context;
    const std::array<Binding, 2> bindings{
        {{0}, {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT, LR_ORDER_WINDOWS}}};
    LR_ASSIGN(out.layout_,
              Layout::create(context, "rotate", bindings, VK_SHADER_STAGE_COMPUTE_BIT, sizeof(RotateConstants)));
    LR_ASSIGN(out.pipeline_, create_compute(context, "rotate", out.layout_, spirv_rotate_comp));
    LR_ASSIGN(out.nothing_, Buffer::create(context, "nothing", 16, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
    return out;
}

Result<RotatePlan> Rotator::plan(Descriptors& descriptors, const GpuMesh& mesh) const {
    constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const bool ordered = mesh.source != Source::plain;
    // Windows start at multiples of 256 bytes.
    const std::uint64_t window = std::min<std::uint64_t>(mesh.max_range, std::uint64_t{1} << 32) / 256 * 64;
    if (ordered && mesh.vertex_count > LR_ORDER_WINDOWS * window) {
        return Error{ErrorCode::too_large, std::to_string(mesh.vertex_count) + " vertices; " +
                                               std::to_string(LR_ORDER_WINDOWS * window) +
                                               " is the most that this device's descriptors cover here"};
    }
    std::array<BufferRange, LR_ORDER_WINDOWS> order;
    for (std::uint64_t w = 0; w < LR_ORDER_WINDOWS; ++w) {
        const bool used = ordered && w * window < mesh.vertex_count;
        order[w] = {&nothing_};
        if (used) order[w] = {&mesh.vertex_order, 4 * w * window, 4 * std::min(window, mesh.vertex_count - w * window)};
    }
    const std::uint64_t by_groups =
        std::uint64_t{context_->limits().maxComputeWorkGroupCount[0]} * LR_COMPUTE_GROUP * LR_TRIANGLES_PER_INVOCATION;
    const std::uint64_t step = std::min(mesh.max_range / 12, by_groups) / 64 * 64;  // 768 bytes: aligned
    RotatePlan plan;
    for (std::uint64_t first = 0; first < mesh.slots; first += step) {
        const std::uint64_t triangles = std::min(step, mesh.slots - first);
        const VkDeviceSize bytes = std::min(12 * ((triangles + 3) / 4 * 4), mesh.indices.size() - 12 * first);
        RotatePlan::Dispatch dispatch;
        LR_ASSIGN(dispatch.set, descriptors.allocate(layout_));
        descriptors.write(dispatch.set, 0, kStorage, {&mesh.indices, 12 * first, bytes});
        descriptors.write(dispatch.set, 1, kStorage, order);
        dispatch.constants = {static_cast<std::uint32_t>(triangles), ordered ? 1U : 0U,
                              static_cast<std::uint32_t>(std::min<std::uint64_t>(window, UINT32_MAX))};
        constexpr std::uint64_t kPerGroup = std::uint64_t{LR_COMPUTE_GROUP} * LR_TRIANGLES_PER_INVOCATION;
        dispatch.groups = static_cast<std::uint32_t>((triangles + kPerGroup - 1) / kPerGroup);
        plan.dispatches.push_back(dispatch);
    }
    return plan;
}

void Rotator::record(VkCommandBuffer commands, const RotatePlan& plan) const {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
    for (const RotatePlan::Dispatch& dispatch : plan.dispatches) {
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.pipeline(), 0, 1, &dispatch.set, 0,
                                nullptr);
        vkCmdPushConstants(commands, layout_.pipeline(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(RotateConstants),
                           &dispatch.constants);
        vkCmdDispatch(commands, dispatch.groups, 1, 1);
    }
}

}  // namespace lr::gpu
