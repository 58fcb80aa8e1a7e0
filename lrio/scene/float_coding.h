#pragma once
// Rows of floats, those of animations above all, without loss. Internal to lrio; docs/gltf/LACEDRING_mesh_compression
// has the format.
//
// Each float is stored as its distance, in steps from float to float, from the line through the two rows before. Of a
// unit quaternion the largest component is what the three others leave of 1, but for a step or two.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/base.hpp"

namespace lacedring::detail {

/// `bytes` are rows of `width` floats, 1 to 16. `quaternions`: of unit length, 4 wide. Cost: O(bytes). Errors:
/// too_large.
Result<std::vector<std::byte>> encode_floats(std::span<const std::byte> bytes, std::uint32_t width, bool quaternions);

/// So many bytes. Errors: malformed. Untrusted input: safe.
Result<std::vector<std::byte>> decode_floats(std::span<const std::byte> coded, std::uint64_t size);

}  // namespace lacedring::detail
