#pragma once
// The compute passes that decode a seam section into an index buffer over the copies of the surface's vertices, and the
// pass that gives each copy its vertex's position.

#include "lacedring/seams.hpp"
#include "renderer/decode/decoder.h"

namespace lacedring::gpu {

struct SeamPlan {
    PassPlan<SeamConstants> vertices, triangles, positions;  ///< LR_SEAM_PASS_*; `positions` may be empty
};

/// Writes mesh.homes, mesh.copies and mesh.copy_vertices from mesh.seams and mesh.indices, and the positions in
/// mesh.vertices from mesh.positions if the mesh has these.
class SeamDecoder : ComputePass<SeamConstants> {
  public:
    static Result<SeamDecoder> create(Context& context);

    /// Splits the buffers so that no descriptor covers more than max(mesh.max_range, one block of triangles) bytes.
    /// `view` views the section. Shaders use addresses for it and for all that they read or write out of order.
    Result<SeamPlan> plan(Descriptors& descriptors, const GpuMesh& mesh, const SeamView& view) const;

    /// Records the decoding. A barrier between its two passes also makes earlier writes to mesh.indices visible.
    void record(VkCommandBuffer commands, const SeamPlan& plan) const;
    /// Records a barrier, then the pass that copies positions.
    void record_positions(VkCommandBuffer commands, const SeamPlan& plan) const;
};

}  // namespace lacedring::gpu
