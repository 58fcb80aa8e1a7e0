#pragma once
// Lossless coding of rows of floats, mainly for animations. Internal to lrio; docs/gltf/LACEDRING_mesh_compression
// specifies the format.
//
// Each float is predicted by the line through the two previous rows, and the largest component of a unit quaternion by
// the three others. The code is the distance from the prediction, counted in representable floats.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/base.hpp"

namespace lacedring::detail {

/// Encodes rows of `width` floats, 1 to 16. `quaternions`: the rows are unit quaternions, and `width` is 4. Cost:
/// O(bytes). Errors: too_large.
Result<std::vector<std::byte>> encode_floats(std::span<const std::byte> bytes, std::uint32_t width, bool quaternions);

/// Decodes to `size` bytes. Errors: malformed. Untrusted input: safe.
Result<std::vector<std::byte>> decode_floats(std::span<const std::byte> coded, std::uint64_t size);

}  // namespace lacedring::detail
