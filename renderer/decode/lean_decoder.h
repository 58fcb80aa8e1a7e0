#pragma once
// The compute pass that expands a lean stream into an index buffer and draw commands. Paper: LR 2011, section 7.

#include "lacedring/streams.hpp"
#include "renderer/decode/decoder.h"

namespace lacedring::gpu {

class LeanDecoder : public Decoder {
  public:
    static Result<LeanDecoder> create(Context& context);

    /// Splits the stream (`view` views it) and the index buffer so that no descriptor covers more than mesh.max_range
    /// bytes.
    Result<DecodePlan> plan(Descriptors& descriptors, const GpuMesh& mesh, const LeanView& view) const;
};

}  // namespace lacedring::gpu
