#pragma once
// Whether words can take the place of a built-in shader's in the pipelines that it is in. A driver need not check that,
// and lavapipe does not.

#include "lacedring/base.hpp"
#include "shaders/shader.h"

namespace lacedring::gpu {

/// The words must be valid SPIR-V, and of the shader's stage. What the layouts and the other stages of its pipelines
/// know of it must be as it was: bindings and push constants with all their members' places, inputs, outputs, sizes of
/// workgroups and of what is emitted; a binding or an input may be left out. Nor may it need more of the device.
/// Buffers that are read through addresses are not known by the pipeline, and not compared. Cost: O(words).
/// Errors: malformed, unsupported ("binding 3 is new: ...").
Result<void> check_interface(const Shader& built_in, std::span<const std::uint32_t> words);

}  // namespace lacedring::gpu
