#pragma once
// A mesh put on the device, and its index buffer made ready: whatever the source, whoever draws it.

#include <optional>

#include "renderer/decode/lean_decoder.h"
#include "renderer/decode/packed_decoder.h"
#include "renderer/decode/rotator.h"
#include "renderer/decode/seam_decoder.h"
#include "renderer/decode/vertex_decoder.h"

namespace lacedring::gpu {

/// A mesh on the device, with the passes that make its index buffer. Goes before its context.
struct ExpandedMesh {
    GpuMesh mesh;
    Descriptors descriptors;
    DecodePlan decode;    ///< empty for Source::plain; where the surface has no seams, of Path::compute only
    VertexPlan vertices;  ///< Source::packed_vertices by compute
    SeamPlan seams;       ///< of a surface with seams, by every path
    RotatePlan rotate;    ///< Path::compute
};

/// The pipelines of a stream's decoder are made by the first upload that needs them: a driver may take half a second
/// for all. One thread uploads while another records what was uploaded.
class Expander {
  public:
    static Result<Expander> create(Context& context);
    /// Another one with the same pipelines, of the shaders as they are now.
    Result<Expander> again() const;

    /// Uploads a source of the model and plans the passes over its index buffer.
    Result<ExpandedMesh> upload(Transfer& transfer, const Model& model, Source source, const UploadOptions& options);

    /// Records the decoding of its streams, if that has not been done, and what makes it visible.
    void decode(VkCommandBuffer commands, ExpandedMesh& expanded) const;
    /// Records the decoding of the vertex stream alone, done or not, and what makes it visible.
    void decode_vertices(VkCommandBuffer commands, const ExpandedMesh& expanded) const;
    /// Records the turning of its triangles, if that has not been done, and what makes it visible.
    void rotate(VkCommandBuffer commands, ExpandedMesh& expanded) const;

  private:
    /// Records the decoding of vertices; of the seams' copies as well, or of their positions alone.
    void record_vertices(VkCommandBuffer commands, const ExpandedMesh& expanded, bool seams) const;

    Context* context_ = nullptr;
    /// A mesh with a plan for one of these has it; a thread that records may not ask whether the others are there.
    std::optional<LeanDecoder> lean_;
    std::optional<PackedDecoder> packed_;
    std::optional<VertexDecoder> vertices_;
    std::optional<SeamDecoder> seams_;
    Rotator rotator_;
};

}  // namespace lacedring::gpu
