#include "tests/fuzz/targets.h"

namespace lacedring::fuzz {

extern const Target lean_target, packed_target, lr_target, lr_compact_target, vertices_target, seams_target,
    stored_target, lr_file_target;
extern const Target gltf_target, obj_target, off_target, ply_target, stl_target, scene_target;
extern const Target chain_indices_target, chain_mesh_target;

std::span<const Target> targets() {
    static const Target all[] = {
        lean_target,      packed_target, lr_target,      lr_compact_target, vertices_target,
        seams_target,     stored_target, lr_file_target, gltf_target,       obj_target,
        off_target,       ply_target,    stl_target,     scene_target,      chain_indices_target,
        chain_mesh_target};
    return all;
}

}  // namespace lacedring::fuzz
