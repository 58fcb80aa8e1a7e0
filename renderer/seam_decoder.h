#pragma once
// The compute passes that decode a seam section into an index buffer over the copies of the surface's vertices.

#include "lacedring/seams.hpp"
#include "renderer/decoder.h"

namespace lacedring::gpu {

/// Vertex blocks, then triangle blocks.
struct SeamPlan {
    PassPlan<SeamConstants> homes, copies;
};

/// Writes mesh.homes and mesh.copies from mesh.seams and mesh.indices.
class SeamDecoder : ComputePass<SeamConstants> {
  public:
    static Result<SeamDecoder> create(Context& context);

    /// Splits the buffers so that no descriptor covers more than mesh.max_range bytes, or than a block of triangles.
    /// The section, which `view` is of, and the homes are read through their addresses.
    Result<SeamPlan> plan(Descriptors& descriptors, const GpuMesh& mesh, const SeamView& view) const;

    /// Records the dispatches and a barrier between the two passes, which makes writes to mesh.indices visible, too.
    void record(VkCommandBuffer commands, const SeamPlan& plan) const;
};

}  // namespace lacedring::gpu
