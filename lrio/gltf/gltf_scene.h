#pragma once
// The mesh instances of a glTF's scene. Internal to lrio.

#include <cstddef>
#include <vector>

#include "lacedring/base.hpp"
#include "lrio/gltf/gltf_file.h"
#include "lrio/gltf/gltf_transform.h"

namespace lacedring::detail {

struct MeshInstance {
    std::size_t mesh = 0;  ///< index into model.meshes
    Transform transform;
};

/// The mesh instances of the default scene, depth first, a node before its children. Without a default scene, takes the
/// first scene; without scenes, all root nodes; without nodes, each mesh once. A skinned mesh is not transformed. A
/// node with EXT_mesh_gpu_instancing places its mesh once for each of the extension's instances, in order.
/// Errors: malformed (references out of range, cycles, nodes with two parents), memory_limit (instances),
/// those of view_accessor.
Result<std::vector<MeshInstance>> place_meshes(GltfFile& file, Reading& reading, std::size_t file_bytes);

}  // namespace lacedring::detail
