#pragma once
// The compute passes that decode a seam section into an index buffer over the copies of the surface's vertices, and the
// one that gives copies the positions of their vertices.

#include "lacedring/seams.hpp"
#include "renderer/decode/decoder.h"

namespace lacedring::gpu {

struct SeamPlan {
    PassPlan<SeamConstants> vertices, triangles, positions;  ///< LR_SEAM_PASS_*; no positions where mesh has none
};

/// Writes mesh.homes, mesh.copies and mesh.copy_vertices from mesh.seams and mesh.indices; the positions of
/// mesh.vertices from mesh.positions.
class SeamDecoder : ComputePass<SeamConstants> {
  public:
    static Result<SeamDecoder> create(Context& context);

    /// Splits the buffers so that no descriptor covers more than mesh.max_range bytes, or than a block of triangles.
    /// `view` is of the section. Shaders take addresses for it, and for all that they read or write out of order.
    Result<SeamPlan> plan(Descriptors& descriptors, const GpuMesh& mesh, const SeamView& view) const;

    /// Records the decoding, and a barrier in it that makes writes to mesh.indices visible, too.
    void record(VkCommandBuffer commands, const SeamPlan& plan) const;
    /// Records the moving of positions, and before it a barrier.
    void record_positions(VkCommandBuffer commands, const SeamPlan& plan) const;
};

}  // namespace lacedring::gpu
