#pragma once
// Codes the part of each triangle of a stream, in the stream's order. Internal to lrio;
// docs/gltf/LACEDRING_mesh_compression specifies the format.
//
// The triangles form runs of equal parts. A run's code is the position of its part in a list of recently used parts: a
// ring that alternates between two parts has the code 2 each time.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/base.hpp"

namespace lacedring::detail {

/// Encodes the part of each triangle. All numbers up to the largest part must occur. Cost: O(triangles). Errors:
/// deflate_bytes'.
Result<std::vector<std::byte>> encode_part_codes(std::span<const std::uint32_t> parts);

/// Decodes the part of each of `triangles` triangles, and checks that all numbers below `parts` occur. Errors:
/// malformed. Untrusted input: safe.
Result<std::vector<std::uint32_t>> decode_part_codes(std::span<const std::byte> codes, std::size_t triangles,
                                                     std::size_t parts);

}  // namespace lacedring::detail
