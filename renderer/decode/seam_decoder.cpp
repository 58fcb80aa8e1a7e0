#include "renderer/decode/seam_decoder.h"

#include <algorithm>
#include <array>

#include "renderer/vk/context.h"
#include "renderer/vk/try.h"
#include "spirv/seam_decode_comp.h"

namespace lacedring::gpu {

Result<SeamDecoder> SeamDecoder::create(Context& context) {
    SeamDecoder out;
    out.context_ = &context;
    const std::array<Binding, 2> bindings{{{0}, {1}}};
    LR_ASSIGN(out.layout_,
              Layout::create(context, "seam decode", bindings, VK_SHADER_STAGE_COMPUTE_BIT, sizeof(SeamConstants)));
    out.pipelines_.resize(3);
    for (const std::uint32_t pass : {LR_SEAM_PASS_VERTICES, LR_SEAM_PASS_TRIANGLES, LR_SEAM_PASS_POSITIONS}) {
        LR_ASSIGN(out.pipelines_[pass],
                  create_compute(context, "seam decode", out.layout_, spirv_seam_decode_comp, std::span(&pass, 1)));
    }
    return out;
}

Result<SeamPlan> SeamDecoder::plan(Descriptors& descriptors, const GpuMesh& mesh, const SeamView& view) const {
    const std::uint64_t by_groups =
        std::uint64_t{context_->limits().maxComputeWorkGroupCount[0]} * LR_VERTEX_GROUP_SIZE;
    SeamConstants constants{};
    constants.vertices = view.vertices;
    constants.slots = view.triangles;
    constants.copies = view.copies;
    constants.words = static_cast<std::uint32_t>(view.words.size());
    constants.section = mesh.seams.address_words();
    constants.homes = mesh.homes.address_words();
    constants.copy_vertices = mesh.copy_vertices.address_words();
    constants.positions = mesh.positions.address_words();
    // Adds dispatches over `all` units of `bytes` bytes in both buffers, each over a multiple of `least` units.
    const auto pass = [&](PassPlan<SeamConstants>& out, std::uint32_t pipeline, const Buffer& written,
                          const Buffer& read, std::uint64_t all, std::uint64_t bytes,
                          std::uint64_t least) -> Result<void> {
        constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        const std::uint64_t fit = std::min((mesh.max_range - sizeof(std::uint32_t)) / bytes, by_groups);
        const std::uint64_t step = std::max(fit / least, std::uint64_t{1}) * least;
        for (std::uint64_t first = 0; first < all; first += step) {
            const std::uint64_t units = std::min(step, all - first), begin = first * bytes;
            const VkDeviceSize size = first + units == all ? VK_WHOLE_SIZE : units * bytes;
            PassPlan<SeamConstants>::Dispatch dispatch;
            LR_ASSIGN(dispatch.set, descriptors.allocate(layout_));
            descriptors.write(dispatch.set, 0, kStorage, {&written, begin, size});
            descriptors.write(dispatch.set, 1, kStorage, {&read, begin, size});
            dispatch.pipeline = pipeline;
            dispatch.constants = constants;
            dispatch.constants.first_block = static_cast<std::uint32_t>(first);
            dispatch.constants.blocks = static_cast<std::uint32_t>(units);
            dispatch.groups = static_cast<std::uint32_t>((units + LR_VERTEX_GROUP_SIZE - 1) / LR_VERTEX_GROUP_SIZE);
            out.dispatches.push_back(dispatch);
        }
        return {};
    };
    SeamPlan plan;
    const std::uint64_t vertex_blocks = (std::uint64_t{view.vertices} + kSeamBlock - 1) / kSeamBlock;
    LR_TRY(pass(plan.vertices, LR_SEAM_PASS_VERTICES, mesh.homes, mesh.homes, vertex_blocks, 4 * kSeamBlock, 1));
    LR_TRY(pass(plan.triangles, LR_SEAM_PASS_TRIANGLES, mesh.copies, mesh.indices, view.blocks(), 12 * kSeamBlock, 1));
    if (mesh.positions) {
        LR_TRY(pass(plan.positions, LR_SEAM_PASS_POSITIONS, mesh.vertices, mesh.vertices, view.copies, sizeof(Vertex),
                    kDescriptorAlignment / sizeof(float)));
    }
    return plan;
}

void SeamDecoder::record(VkCommandBuffer commands, const SeamPlan& plan) const {
    if (plan.triangles.dispatches.empty()) return;
    ComputePass::record(commands, plan.vertices);
    decode_barrier(commands);
    ComputePass::record(commands, plan.triangles);
}

void SeamDecoder::record_positions(VkCommandBuffer commands, const SeamPlan& plan) const {
    if (plan.positions.dispatches.empty()) return;
    decode_barrier(commands);
    ComputePass::record(commands, plan.positions);
}

}  // namespace lacedring::gpu
