#pragma once
// Uploads a mesh from any source and records the passes that fill its index buffer.

#include <optional>

#include "renderer/decode/lean_decoder.h"
#include "renderer/decode/packed_decoder.h"
#include "renderer/decode/rotator.h"
#include "renderer/decode/seam_decoder.h"
#include "renderer/decode/vertex_decoder.h"

namespace lacedring::gpu {

/// A mesh on the device, with the passes that fill its index buffer. Must be destroyed before its context.
struct ExpandedMesh {
    GpuMesh mesh;
    Descriptors descriptors;
    DecodePlan decode;    ///< streams only: with Path::compute, or on any path if the surface has seams
    VertexPlan vertices;  ///< Source::packed_vertices with Path::compute
    SeamPlan seams;       ///< if the surface has seams, on any path
    RotatePlan rotate;    ///< Path::compute
};

/// The first upload that needs a decoder creates its pipelines: creating all of them may take a driver half a second.
/// One thread may upload while another records passes of meshes uploaded before.
class Expander {
  public:
    static Result<Expander> create(Context& context);
    /// Returns a new Expander whose pipelines are recreated from the current shaders.
    Result<Expander> again() const;

    /// Uploads a source of the model and plans the passes over its index buffer.
    Result<ExpandedMesh> upload(Transfer& transfer, const Model& model, Source source, const UploadOptions& options);

    /// Records the decoding of the mesh's streams, unless already recorded, and a barrier that makes it visible.
    void decode(VkCommandBuffer commands, ExpandedMesh& expanded) const;
    /// Records the decoding of the vertex stream alone, even if already done, and a barrier that makes it visible.
    void decode_vertices(VkCommandBuffer commands, const ExpandedMesh& expanded) const;
    /// Records the rotation of the mesh's triangles, unless already recorded, and a barrier that makes it visible.
    void rotate(VkCommandBuffer commands, ExpandedMesh& expanded) const;

  private:
    /// Records the decoding of vertices, then of the seam section (if `seams`) and of the copies' positions.
    void record_vertices(VkCommandBuffer commands, const ExpandedMesh& expanded, bool seams) const;

    Context* context_ = nullptr;
    /// The uploading thread may be creating one of these: a recording thread only touches those its mesh has plans for.
    std::optional<LeanDecoder> lean_;
    std::optional<PackedDecoder> packed_;
    std::optional<VertexDecoder> vertices_;
    std::optional<SeamDecoder> seams_;
    Rotator rotator_;
};

}  // namespace lacedring::gpu
