#include "renderer/seam_decoder.h"

#include <algorithm>
#include <array>

#include "renderer/context.h"
#include "renderer/try.h"
#include "spirv/seam_decode_comp.h"

namespace lacedring::gpu {

Result<SeamDecoder> SeamDecoder::create(Context& context) {
    SeamDecoder out;
    out.context_ = &context;
    const std::array<Binding, 2> bindings{{{0}, {1}}};
    LR_ASSIGN(out.layout_,
              Layout::create(context, "seam decode", bindings, VK_SHADER_STAGE_COMPUTE_BIT, sizeof(SeamConstants)));
    out.pipelines_.resize(2);
    for (const std::uint32_t corners : {VK_FALSE, VK_TRUE}) {
        LR_ASSIGN(out.pipelines_[corners],
                  create_compute(context, "seam decode", out.layout_, spirv_seam_decode_comp, std::span(&corners, 1)));
    }
    return out;
}

Result<SeamPlan> SeamDecoder::plan(Descriptors& descriptors, const GpuMesh& mesh, const SeamView& view) const {
    constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const std::uint64_t by_groups =
        std::uint64_t{context_->limits().maxComputeWorkGroupCount[0]} * LR_VERTEX_GROUP_SIZE;
    SeamPlan plan;
    for (const std::uint32_t corners : {VK_FALSE, VK_TRUE}) {
        const Buffer& out = corners ? mesh.copies : mesh.homes;
        const std::uint64_t elements = corners ? view.triangles : view.vertices;
        const std::uint64_t all = (elements + kSeamBlock - 1) / kSeamBlock,
                            block_bytes = kSeamBlock * (corners ? 12 : 4);
        // The last block of vertices writes one entry more.
        const std::uint64_t step = std::clamp<std::uint64_t>((mesh.max_range - 4) / block_bytes, 1, by_groups);
        for (std::uint64_t first = 0; first < all; first += step) {
            const std::uint64_t blocks = std::min(step, all - first), begin = first * block_bytes;
            const VkDeviceSize bytes = first + blocks == all ? VK_WHOLE_SIZE : blocks * block_bytes;
            PassPlan<SeamConstants>::Dispatch dispatch;
            LR_ASSIGN(dispatch.set, descriptors.allocate(layout_));
            descriptors.write(dispatch.set, 0, kStorage, {&out, begin, bytes});
            // Vertex blocks read no triangles.
            descriptors.write(dispatch.set, 1, kStorage, {&(corners ? mesh.indices : mesh.homes), begin, bytes});
            dispatch.pipeline = corners;
            dispatch.constants.first_block = static_cast<std::uint32_t>(first);
            dispatch.constants.blocks = static_cast<std::uint32_t>(blocks);
            dispatch.constants.vertices = view.vertices;
            dispatch.constants.slots = view.triangles;
            dispatch.constants.section = mesh.seams.address_words();
            dispatch.constants.home = mesh.homes.address_words();
            dispatch.constants.words = static_cast<std::uint32_t>(view.words.size());
            dispatch.groups = static_cast<std::uint32_t>((blocks + LR_VERTEX_GROUP_SIZE - 1) / LR_VERTEX_GROUP_SIZE);
            (corners ? plan.copies : plan.homes).dispatches.push_back(dispatch);
        }
    }
    return plan;
}

void SeamDecoder::record(VkCommandBuffer commands, const SeamPlan& plan) const {
    if (plan.copies.dispatches.empty()) return;
    ComputePass::record(commands, plan.homes);
    decode_barrier(commands);
    ComputePass::record(commands, plan.copies);
}

}  // namespace lacedring::gpu
