#pragma once
// Attribute values where a node puts them. Internal to lrio.

#include <cstddef>
#include <span>

#include "lacedring/base.hpp"
#include "lacedring/mesh.hpp"
#include "lrio/gltf/gltf_accessor.h"
#include "lrio/gltf/gltf_transform.h"

namespace lacedring::detail {

/// Is it a direction that a transform turns: NORMAL of 3 components, or TANGENT of 4?
bool is_direction(const Attribute& attribute);

/// Appends the accessor's elements to the attribute's. What `transform` changes, and what has another type than the
/// attribute, becomes floats, which `to` then has. Errors: copy_elements's.
Result<void> append_values(const AccessorView& view, const Transform& transform, Attribute& to);

/// Swaps the last two corners of each triangle.
void turn_round(std::span<std::uint32_t> indices);

}  // namespace lacedring::detail
