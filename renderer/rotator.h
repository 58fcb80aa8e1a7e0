#pragma once
// The compute pass that turns every triangle so that its smallest original vertex comes first (shaders/rotate.comp).

#include <vector>

#include "renderer/gpu_mesh.h"
#include "renderer/pipeline.h"
#include "shaders/shared.h"

namespace lacedring::gpu {

struct RotatePlan {
    struct Dispatch {
        VkDescriptorSet set = VK_NULL_HANDLE;
        RotateConstants constants{};
        std::uint32_t groups = 0;
    };
    std::vector<Dispatch> dispatches;
};

class Rotator {
  public:
    static Result<Rotator> create(Context& context);

    Result<RotatePlan> plan(Descriptors& descriptors, const GpuMesh& mesh) const;
    /// Records the dispatches, without barriers: they read and write mesh.indices in the compute stage.
    void record(VkCommandBuffer commands, const RotatePlan& plan) const;

  private:
    Context* context_ = nullptr;
    Layout layout_;
    PipelineHandle pipeline_;
};

}  // namespace lacedring::gpu
