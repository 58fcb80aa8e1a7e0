#pragma once
// A glTF file as tinygltf's model, and the meshes that its scene places. Internal to lrcore/mesh.

#include <tiny_gltf.h>

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "lrcore/base/result.h"
#include "lrcore/mesh/gltf_transform.h"

namespace lr::detail {

/// Parses JSON or GLB and loads the buffers, those in files beside it included; images are not looked at.
/// Errors: malformed, unsupported (an extension without which the geometry cannot be read).
Result<tinygltf::Model> load_gltf(std::span<const std::byte> bytes, const std::filesystem::path& folder);

struct MeshInstance {
    std::size_t mesh = 0;  ///< < model.meshes.size()
    Transform transform;
};

/// The meshes of the default scene (else the first; without scenes all root nodes; without nodes each mesh once), depth
/// first, a node before its children. Errors: malformed (references out of range, cycles, nodes with two parents).
Result<std::vector<MeshInstance>> place_meshes(const tinygltf::Model& model);

}  // namespace lr::detail
