#include "renderer/decode/vertex_decoder.h"

#include <algorithm>
#include <array>

#include "renderer/vk/context.h"
#include "renderer/vk/try.h"
#include "spirv/vertex_decode_comp.h"

namespace lacedring::gpu {
namespace {

/// The mappings that positions may have. Each has its own pipeline, compiled without the code of the others.
constexpr std::array kMappings{VertexMapping::lattice, VertexMapping::floats, VertexMapping::decimals};

}  // namespace

Result<VertexDecoder> VertexDecoder::create(Context& context) {
    VertexDecoder out;
    out.context_ = &context;
    const Binding vertices{0};
    LR_ASSIGN(out.layout_, Layout::create(context, "vertex decode", std::span(&vertices, 1),
                                          VK_SHADER_STAGE_COMPUTE_BIT, sizeof(VertexConstants)));
    for (const VertexMapping mapping : kMappings) {
        const std::array<std::uint32_t, 3> constants{3, 0, static_cast<std::uint32_t>(mapping)};
        LR_ASSIGN(out.pipelines_.emplace_back(),
                  create_compute(context, "vertex decode", out.layout_, spirv_vertex_decode_comp, constants));
    }
    return out;
}

Result<VertexPlan> VertexDecoder::plan(Descriptors& descriptors, const GpuMesh& mesh, const VertexView& view) const {
    const Buffer& out = mesh.positions ? mesh.positions : mesh.vertices;
    const std::uint32_t stride = mesh.positions ? LR_POSITION_FLOATS : LR_VERTEX_FLOATS;
    const std::uint64_t block_bytes = sizeof(float) * std::uint64_t{stride} * kVertexBlock;
    static_assert(sizeof(float) * kVertexBlock % kDescriptorAlignment == 0);
    const std::uint64_t by_groups =
        std::uint64_t{context_->limits().maxComputeWorkGroupCount[0]} * LR_VERTEX_GROUP_SIZE;
    const std::uint64_t step = std::min(mesh.max_range / block_bytes, by_groups);
    const std::uint64_t all = (std::uint64_t{view.vertices} + kVertexBlock - 1) / kVertexBlock;
    const auto pipeline = std::find(kMappings.begin(), kMappings.end(), view.mapping) - kMappings.begin();
    VertexPlan plan;
    for (std::uint64_t first = 0; first < all; first += step) {
        const std::uint64_t blocks = std::min(step, all - first);
        const VkDeviceSize bytes = std::min(blocks * block_bytes, out.size() - first * block_bytes);
        VertexPlan::Dispatch dispatch;
        LR_ASSIGN(dispatch.set, descriptors.allocate(layout_));
        descriptors.write(dispatch.set, 0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {&out, first * block_bytes, bytes});
        dispatch.pipeline = static_cast<std::uint32_t>(pipeline);
        dispatch.constants.first_block = static_cast<std::uint32_t>(first);
        dispatch.constants.blocks = static_cast<std::uint32_t>(blocks);
        dispatch.constants.stride = stride;
        dispatch.constants.stream = mesh.vertex_stream.address_words();
        dispatch.groups = static_cast<std::uint32_t>((blocks + LR_VERTEX_GROUP_SIZE - 1) / LR_VERTEX_GROUP_SIZE);
        plan.dispatches.push_back(dispatch);
    }
    return plan;
}

}  // namespace lacedring::gpu
