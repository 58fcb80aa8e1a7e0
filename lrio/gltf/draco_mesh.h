#pragma once
// Decodes Draco data within the memory limit of a glTF. Internal to lrio.

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

/// Decodes a mesh of bitstream version 2.2, which KHR_draco_mesh_compression requires. Its memory is checked against
/// the file's limit, but not counted after the call. Untrusted input: safe. Errors: malformed, unsupported (another
/// version), memory_limit.
Result<std::unique_ptr<draco::Mesh>> decode_draco_mesh(GltfFile& file, std::span<const std::byte> data);

/// Writes the triangles' point indices, 3 a triangle, as u8, u16 or u32. Errors: malformed.
Result<void> copy_draco_indices(const draco::Mesh& mesh, ComponentType type, std::span<std::byte> out);

/// Writes the values of an attribute, `components` for each point, converted to `type`. Integers that Draco marks
/// normalized are divided by their maximum if `type` is f32; floats are never converted to integers. Errors: malformed.
Result<void> copy_draco_attribute(const draco::Mesh& mesh, std::uint32_t unique_id, ComponentType type, int components,
                                  std::span<std::byte> out);

#endif

}  // namespace lacedring::detail
