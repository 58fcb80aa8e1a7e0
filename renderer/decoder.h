#pragma once
// What the compute passes that expand streams have in common.

#include <vector>

#include "renderer/gpu_mesh.h"
#include "renderer/pipeline.h"
#include "shaders/shared.h"

namespace lacedring::gpu {

/// The dispatches that expand one mesh. Its descriptor sets live as long as the Descriptors that they came from.
struct DecodePlan {
    struct Dispatch {
        VkDescriptorSet set = VK_NULL_HANDLE;
        DecodeConstants constants{};
        std::uint32_t groups = 0;
        std::uint32_t pipeline = 0;
    };
    std::vector<Dispatch> dispatches;
};

class Decoder {
  public:
    /// Records the dispatches, without barriers: they write mesh.indices and mesh.commands in the compute stage.
    void record(VkCommandBuffer commands, const DecodePlan& plan) const;

  protected:
    Context* context_ = nullptr;
    Layout layout_;
    std::vector<PipelineHandle> pipelines_;
};

/// What a decoder's writes are for: indices, commands, the rotating pass, reading back.
void decode_barrier(VkCommandBuffer commands);

/// No device wants more of a descriptor's offset.
constexpr VkDeviceSize kDescriptorAlignment = 256;

}  // namespace lacedring::gpu
