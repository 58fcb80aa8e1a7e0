#pragma once
// The meshes that a glTF's scene places. Internal to lrio.

#include <cstddef>
#include <vector>

#include "lacedring/base.hpp"
#include "lrio/gltf/gltf_file.h"
#include "lrio/gltf/gltf_transform.h"

namespace lacedring::detail {

struct MeshInstance {
    std::size_t mesh = 0;  ///< < model.meshes.size()
    Transform transform;
};

/// The meshes of the default scene (else the first; without scenes all root nodes; without nodes each mesh once), depth
/// first, a node before its children. A skinned mesh stays where its file has it; a node with EXT_mesh_gpu_instancing
/// places its mesh once for each instance, in order.
/// Errors: malformed (references out of range, cycles, nodes with two parents), memory_limit (instances),
/// view_accessor's.
Result<std::vector<MeshInstance>> place_meshes(GltfFile& file, Reading& reading, std::size_t file_bytes);

}  // namespace lacedring::detail
