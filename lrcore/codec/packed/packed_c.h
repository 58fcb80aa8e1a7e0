#pragma once
// A packed stream as lacedring_decode.h has it.

#include "lacedring/lacedring_decode.h"
#include "lacedring/streams.hpp"

namespace lacedring {

namespace detail {
lacedring_packed as_c(const PackedView& view);
}

/// Bits of a vertex number in a stream of so many vertices.
std::uint32_t packed_vertex_bits(std::uint32_t vertices);

}  // namespace lacedring
