#pragma once
// The compute pass that decodes a vertex stream of positions into a vertex buffer.

#include "lacedring/vertices.hpp"
#include "renderer/decode/decoder.h"

namespace lacedring::gpu {

using VertexPlan = PassPlan<VertexConstants>;

/// Writes mesh.positions; if the surface has no seams, the positions in mesh.vertices instead.
class VertexDecoder : public ComputePass<VertexConstants> {
  public:
    static Result<VertexDecoder> create(Context& context);

    /// Splits the buffer so that no descriptor covers more than mesh.max_range bytes. The shader reads the stream
    /// through its address.
    Result<VertexPlan> plan(Descriptors& descriptors, const GpuMesh& mesh, const VertexView& view) const;
};

}  // namespace lacedring::gpu
