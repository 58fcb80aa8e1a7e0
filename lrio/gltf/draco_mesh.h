#pragma once
// Draco's data as a mesh, within the memory that a glTF may take. Internal to lrio.

#ifdef LACEDRING_DRACO
#include <draco/mesh/mesh.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "lacedring/base.hpp"
#include "lacedring/mesh.hpp"
#include "lrio/gltf/gltf_file.h"
#endif

namespace lacedring::detail {

/// Was lrio built with libdraco?
bool has_draco();

#ifdef LACEDRING_DRACO

/// Decodes a mesh of bitstream version 2.2, the one of KHR_draco_mesh_compression. Any bytes are safe. Its memory is
/// taken from the file's, to be given back. Errors: malformed, unsupported (another version), memory_limit.
Result<std::unique_ptr<draco::Mesh>> decode_draco_mesh(GltfFile& file, std::span<const std::byte> data);

/// Writes the corners' points as u8, u16 or u32, 3 for each triangle. Errors: malformed.
Result<void> copy_draco_indices(const draco::Mesh& mesh, ComponentType type, std::span<std::byte> out);

/// Writes the values of an attribute, `components` for each point. Integers become floats, divided by their maximum if
/// Draco calls them normalized; floats do not become integers. Errors: malformed.
Result<void> copy_draco_attribute(const draco::Mesh& mesh, std::uint32_t unique_id, ComponentType type, int components,
                                  std::span<std::byte> out);

#endif

}  // namespace lacedring::detail
