#pragma once
// A glTF or GLB file as tinygltf's model of its geometry, and its buffers. Internal to lrio.
//
// tinygltf reads nodes, meshes, accessors and buffer views. It never sees the rest of the file: it would open every
// buffer and image, and refuse a file for an animation or a sampler that it does not like.

#include <tiny_gltf.h>

#include <nlohmann/json.hpp>
#include <span>

#include "lacedring/base.hpp"
#include "lrio/gltf/gltf_buffers.h"
#include "lrio/mesh/read_formats.h"

namespace lacedring::detail {

struct GltfFile {
    nlohmann::json document;  ///< the whole file
    tinygltf::Model model;    ///< its geometry; no buffers, materials, images, animations, ...
    GltfBuffers buffers;      ///< refers to `document` and to the file's bytes
};

/// Parses JSON or GLB, and tells `reading` what is not read of it. No buffer is opened yet.
/// Errors: malformed, unsupported (a version or an extension without which the geometry cannot be read), too_large.
Result<GltfFile> load_gltf(std::span<const std::byte> bytes, Reading& reading);

}  // namespace lacedring::detail
