#pragma once
// Base of the compute passes over a mesh: the passes that expand streams, and the pass that rotates triangles.

#include <vector>

#include "renderer/mesh/gpu_mesh.h"
#include "renderer/vk/pipeline.h"
#include "shaders/shared.h"

namespace lacedring::gpu {

/// The dispatches of one pass over one mesh. Their descriptor sets live as long as the Descriptors that allocated them.
template <class Constants>
struct PassPlan {
    struct Dispatch {
        VkDescriptorSet set = VK_NULL_HANDLE;
        Constants constants{};
        std::uint32_t groups = 0;
        std::uint32_t pipeline = 0;
    };
    std::vector<Dispatch> dispatches;
};

template <class Constants>
class ComputePass {
  public:
    /// Records the dispatches, without barriers. They write in the compute stage.
    void record(VkCommandBuffer commands, const PassPlan<Constants>& plan) const {
        for (const auto& dispatch : plan.dispatches) {
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipelines_[dispatch.pipeline].get());
            vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.pipeline(), 0, 1, &dispatch.set,
                                    0, nullptr);
            vkCmdPushConstants(commands, layout_.pipeline(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(Constants),
                               &dispatch.constants);
            vkCmdDispatch(commands, dispatch.groups, 1, 1);
        }
    }

  protected:
    Context* context_ = nullptr;
    Layout layout_;
    std::vector<PipelineHandle> pipelines_;
};

/// Expands a stream: writes mesh.indices and mesh.commands.
using Decoder = ComputePass<DecodeConstants>;
using DecodePlan = PassPlan<DecodeConstants>;

/// Makes a decoder's writes visible to index and vertex input, indirect draws, vertex, geometry, mesh and compute
/// shaders, and copies.
void decode_barrier(VkCommandBuffer commands);

/// The largest minStorageBufferOffsetAlignment that Vulkan allows a device.
constexpr VkDeviceSize kDescriptorAlignment = 256;

}  // namespace lacedring::gpu
