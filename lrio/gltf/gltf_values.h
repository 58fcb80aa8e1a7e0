#pragma once
// Attribute values transformed by a node. Internal to lrio.

#include <cstddef>
#include <span>

#include "lacedring/base.hpp"
#include "lacedring/mesh.hpp"
#include "lrio/gltf/gltf_accessor.h"
#include "lrio/gltf/gltf_transform.h"

namespace lacedring::detail {

/// Is it a direction, which transforms rotate: NORMAL of 3 components, or TANGENT of 4?
bool is_direction(const Attribute& attribute);

/// Appends the accessor's elements to the attribute. Elements that `transform` changes, or whose type is not the
/// attribute's, are converted to floats: `to` must be of floats then. Errors: those of copy_elements.
Result<void> append_values(const AccessorView& view, const Transform& transform, Attribute& to);

/// Reverses the orientation of each triangle by swapping its last two corners.
void reverse_orientation(std::span<std::uint32_t> indices);

}  // namespace lacedring::detail
