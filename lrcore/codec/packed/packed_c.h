#pragma once
// Converts packed streams to the types of lacedring_decode.h.

#include "lacedring/lacedring_decode.h"
#include "lacedring/streams.hpp"

namespace lacedring {

namespace detail {
lacedring_packed as_c(const PackedView& view);
}

/// Bits of a vertex number in a stream of `vertices` vertices.
std::uint32_t packed_vertex_bits(std::uint32_t vertices);

}  // namespace lacedring
