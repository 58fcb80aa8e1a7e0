#include "renderer/decode/rotator.h"

#include <algorithm>

#include "renderer/vk/context.h"
#include "renderer/vk/try.h"
#include "spirv/rotate_comp.h"

namespace lacedring::gpu {

Result<Rotator> Rotator::create(Context& context) {
    Rotator out;
    out.context_ = &context;
    const Binding indices{0};
    LR_ASSIGN(out.layout_, Layout::create(context, "rotate", std::span(&indices, 1), VK_SHADER_STAGE_COMPUTE_BIT,
                                          sizeof(RotateConstants)));
    out.pipelines_.resize(1);
    LR_ASSIGN(out.pipelines_[0], create_compute(context, "rotate", out.layout_, spirv_rotate_comp));
    return out;
}

Result<RotatePlan> Rotator::plan(Descriptors& descriptors, const GpuMesh& mesh) const {
    const std::uint64_t by_groups =
        std::uint64_t{context_->limits().maxComputeWorkGroupCount[0]} * LR_COMPUTE_GROUP * LR_TRIANGLES_PER_INVOCATION;
    // 64 triangles are 768 bytes of indices: a multiple of kDescriptorAlignment.
    const std::uint64_t step = std::min(mesh.max_range / 12, by_groups) / 64 * 64;
    RotatePlan plan;
    for (std::uint64_t first = 0; first < mesh.slots; first += step) {
        const std::uint64_t triangles = std::min(step, mesh.slots - first);
        const VkDeviceSize bytes = std::min(12 * ((triangles + 3) / 4 * 4), mesh.drawn_indices().size() - 12 * first);
        RotatePlan::Dispatch dispatch;
        LR_ASSIGN(dispatch.set, descriptors.allocate(layout_));
        descriptors.write(dispatch.set, 0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                          {&mesh.drawn_indices(), 12 * first, bytes});
        dispatch.constants = {static_cast<std::uint32_t>(triangles), mesh.source == Source::plain ? 0U : 1U,
                              mesh.vertex_order.address_words()};
        constexpr std::uint64_t kPerGroup = std::uint64_t{LR_COMPUTE_GROUP} * LR_TRIANGLES_PER_INVOCATION;
        dispatch.groups = static_cast<std::uint32_t>((triangles + kPerGroup - 1) / kPerGroup);
        plan.dispatches.push_back(dispatch);
    }
    return plan;
}

}  // namespace lacedring::gpu
