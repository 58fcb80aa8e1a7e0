#pragma once
// The compute pass that expands a lean stream into an index buffer and draw commands. Paper: LR 2011, section 7.

#include <vector>

#include "renderer/gpu_mesh.h"
#include "renderer/pipeline.h"
#include "shaders/shared.h"

namespace lr::gpu {

/// The dispatches that expand one mesh. Its descriptor sets live as long as the Descriptors that they came from.
struct DecodePlan {
    struct Dispatch {
        VkDescriptorSet set = VK_NULL_HANDLE;
        DecodeConstants constants{};
        std::uint32_t groups = 0;
    };
    std::vector<Dispatch> dispatches;
};

class LeanDecoder {
  public:
    static Result<LeanDecoder> create(Context& context);

    /// Splits the stream and the index buffer so that no descriptor covers more than mesh.max_range bytes.
    Result<DecodePlan> plan(Descriptors& descriptors, const GpuMesh& mesh) const;
    /// Records the dispatches, without barriers: they write mesh.indices and mesh.commands in the compute stage.
    void record(VkCommandBuffer commands, const DecodePlan& plan) const;

  private:
    Context* context_ = nullptr;
    Layout layout_;
    PipelineHandle pipeline_;
};

/// What the decoder's writes are for: indices, commands, the rotating pass, reading back.
void decode_barrier(VkCommandBuffer commands);

}  // namespace lr::gpu
