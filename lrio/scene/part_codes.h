#pragma once
// Which part of a scene each triangle of a stream belongs to, in the stream's order. Internal to lrio;
// docs/gltf/LACEDRING_mesh_compression has the format.
//
// Triangles come in runs of one part. A run says how far back its part was used last, among parts: a ring that crosses
// back and forth between two parts says 2 each time.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/base.hpp"

namespace lacedring::detail {

/// The parts of triangles: all numbers below the largest one occur. Cost: O(triangles). Errors: deflate_bytes'.
Result<std::vector<std::byte>> encode_part_codes(std::span<const std::uint32_t> parts);

/// The part of each of so many triangles: all parts below `parts` occur. Errors: malformed. Untrusted input: safe.
Result<std::vector<std::uint32_t>> decode_part_codes(std::span<const std::byte> codes, std::size_t triangles,
                                                     std::size_t parts);

}  // namespace lacedring::detail
