#pragma once
// Checks that recompiled SPIR-V has the interface of the built-in shader it replaces. A driver need not check this, and
// lavapipe does not.

#include "lacedring/base.hpp"
#include "shaders/shader.h"

namespace lacedring::gpu {

/// `words` must be valid SPIR-V of the same stage as `built_in`, with the same interface: bindings and push constants
/// (with the offsets of all members), inputs, outputs, workgroup size, and size of the emitted primitives. Bindings and
/// inputs may be left out; further device capabilities may not be needed. Buffers read through addresses are not part
/// of a pipeline's interface and are not compared. Cost: O(words). Errors: malformed, unsupported ("binding 3 is new:
/// ...").
Result<void> check_interface(const Shader& built_in, std::span<const std::uint32_t> words);

}  // namespace lacedring::gpu
