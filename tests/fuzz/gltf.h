#pragma once
#include "tests/fuzz/targets.h"

namespace lacedring::fuzz {

/// Mutates the JSON or the buffer of a glTF file: a GLB's chunks keep right lengths, an embedded buffer is mutated
/// behind its base64.
void mutate_gltf(Bytes& bytes, std::size_t max_size, Random& random);

/// The same, and of a packed scene (docs/gltf) what is inside its document, streams and coded views.
void mutate_scene(Bytes& bytes, std::size_t max_size, Random& random);

/// The contents of a GLB's two chunks. Both are empty if the bytes do not begin as a GLB does.
struct GlbChunks {
    Bytes json, bin;
};
GlbChunks split_glb(const Bytes& glb);
Bytes join_glb(GlbChunks chunks);

}  // namespace lacedring::fuzz
