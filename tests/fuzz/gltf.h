#pragma once
#include "tests/fuzz/targets.h"

namespace lacedring::fuzz {

/// Mutates the JSON or the buffer of a glTF file: a GLB's chunks keep right lengths, an embedded buffer is mutated
/// behind its base64.
void mutate_gltf(Bytes& bytes, std::size_t max_size, Random& random);

}  // namespace lacedring::fuzz
