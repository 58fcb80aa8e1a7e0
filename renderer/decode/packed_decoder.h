#pragma once
// The compute pass that expands a packed stream into an index buffer and draw commands.

#include <array>

#include "lacedring/streams.hpp"
#include "renderer/decode/decoder.h"

namespace lacedring::gpu {

class PackedDecoder : public Decoder {
  public:
    static Result<PackedDecoder> create(Context& context);

    /// Splits the index buffer so that no descriptor covers more than mesh.max_range bytes. The shader reads the stream
    /// (`view` views it) through its address.
    Result<DecodePlan> plan(Descriptors& descriptors, const GpuMesh& mesh, const PackedView& view) const;

  private:
    std::array<std::uint32_t, 2> group_{};  // invocations and blocks per workgroup
};

}  // namespace lacedring::gpu
