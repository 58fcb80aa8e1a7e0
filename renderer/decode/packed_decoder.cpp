#include "renderer/decode/packed_decoder.h"

#include <algorithm>
#include <array>

#include "lacedring/streams.hpp"
#include "lrcore/codec/packed/packed_format.h"
#include "renderer/vk/context.h"
#include "renderer/vk/try.h"
#include "spirv/packed_decode_comp.h"

namespace lacedring::gpu {

Result<PackedDecoder> PackedDecoder::create(Context& context) {
    PackedDecoder out;
    out.context_ = &context;
    const std::array<Binding, 2> bindings{{{0}, {1}}};
    LR_ASSIGN(out.layout_,
              Layout::create(context, "packed decode", bindings, VK_SHADER_STAGE_COMPUTE_BIT, sizeof(DecodeConstants)));
    // One invocation reads the events of a block, so eight blocks per workgroup fill a subgroup of lavapipe. On a GPU,
    // eight take so much shared memory that fewer workgroups run at once: an H200 decodes two million triangles in
    // 0.31 ms with eight, in 0.19 ms with four, two or one.
    constexpr std::uint32_t kSharedOfEight = 27 << 10;
    const std::uint32_t subgroup = context.info().subgroup_size;
    const bool eight = subgroup <= 8 && context.limits().maxComputeSharedMemorySize >= kSharedOfEight;
    out.group_ = {std::clamp(subgroup, 8U, 64U), eight ? 8U : 4U};
    out.pipelines_.resize(1);
    LR_ASSIGN(out.pipelines_[0],
              create_compute(context, "packed decode", out.layout_, spirv_packed_decode_comp, out.group_));
    return out;
}

Result<DecodePlan> PackedDecoder::plan(Descriptors& descriptors, const GpuMesh& mesh, const PackedView& view) const {
    constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const std::uint64_t most =
        std::max<std::uint64_t>(1, std::min(mesh.max_range / (12 * LR_PACKED_BLOCK),
                                            std::uint64_t{context_->limits().maxComputeWorkGroupCount[0]} * group_[1]));
    DecodePlan plan;
    for (std::uint64_t block = 0, blocks = 0; block < view.blocks(); block += blocks) {
        blocks = std::min(most, view.blocks() - block);
        const std::uint64_t first = block * LR_PACKED_BLOCK;
        const std::uint64_t triangles = std::min(blocks * LR_PACKED_BLOCK, view.triangles - first);
        DecodePlan::Dispatch dispatch;
        LR_ASSIGN(dispatch.set, descriptors.allocate(layout_));
        descriptors.write(dispatch.set, 0, kStorage, {&mesh.indices, 12 * first, 12 * ((triangles + 3) / 4 * 4)});
        descriptors.write(dispatch.set, 1, kStorage, {&mesh.commands});
        dispatch.constants.first_slot = static_cast<std::uint32_t>(first);
        dispatch.constants.slots = static_cast<std::uint32_t>(triangles);
        dispatch.constants.draws = block == 0 ? mesh.draws : 0;
        dispatch.constants.draw_slots = mesh.draw_slots;
        dispatch.constants.words = static_cast<std::uint32_t>(view.words.size());
        dispatch.constants.stream = mesh.stream.address_words();
        dispatch.groups = static_cast<std::uint32_t>((blocks + group_[1] - 1) / group_[1]);
        plan.dispatches.push_back(dispatch);
    }
    return plan;
}

}  // namespace lacedring::gpu
