#pragma once
#include "tests/fuzz/targets.h"

namespace lacedring::fuzz {

/// Mutates the JSON or the buffer of a glTF file. A GLB's chunks keep valid lengths; an embedded buffer is decoded from
/// base64, mutated and encoded again.
void mutate_gltf(Bytes& bytes, std::size_t max_size, Random& random);

/// Mutates a glTF file as mutate_gltf does. In a packed scene (docs/gltf), also mutates the contents of its document,
/// streams and coded views.
void mutate_scene(Bytes& bytes, std::size_t max_size, Random& random);

/// The contents of a GLB's two chunks. Both are empty if the bytes do not begin like a GLB.
struct GlbChunks {
    Bytes json, bin;
};
GlbChunks split_glb(const Bytes& glb);
Bytes join_glb(GlbChunks chunks);

}  // namespace lacedring::fuzz
