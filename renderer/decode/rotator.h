#pragma once
// The compute pass that rotates every triangle so that its smallest original vertex comes first
// (shaders/decode/rotate.comp).

#include "renderer/decode/decoder.h"

namespace lacedring::gpu {

using RotatePlan = PassPlan<RotateConstants>;

/// Reads and writes mesh.drawn_indices().
class Rotator : public ComputePass<RotateConstants> {
  public:
    static Result<Rotator> create(Context& context);

    Result<RotatePlan> plan(Descriptors& descriptors, const GpuMesh& mesh) const;
};

}  // namespace lacedring::gpu
