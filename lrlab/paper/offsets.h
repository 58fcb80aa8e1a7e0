#pragma once
// How far tips lie from their ring edges, along the ring. Paper: LR 2011, section 6.1 and Figure 8.

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "lacedring/streams.hpp"

namespace lacedring {

/// Significant bits of the offset from ring vertex v to `tip` modulo m_r, the shorter way round, without its sign: 1
/// for a neighbour, 0 for v itself. v and tip are below ring_vertices.
constexpr std::uint32_t offset_bits(std::uint32_t v, std::uint32_t tip, std::uint32_t ring_vertices) {
    const std::uint32_t forward = tip >= v ? tip - v : tip + ring_vertices - v;
    return static_cast<std::uint32_t>(std::bit_width(std::min(forward, ring_vertices - forward)));
}

/// Triangles by where their tip is: each is counted once, T2 with the second of their edges.
struct OffsetCounts {
    std::array<std::uint32_t, 29> bits{};  ///< bits[b]: triangles with a slot whose offset has b significant bits
    std::uint32_t off_ring = 0;            ///< with a slot (T0w), but an isolated tip: no offset
    std::uint32_t t0 = 0;                  ///< without a slot
};
/// Cost: O(m_r). The tables are valid.
OffsetCounts count_offsets(const LrView& lr);

/// n_l of section 8: slots of long words without opposites in VO*. Cost: O(m_r). The tables are valid.
std::uint32_t count_long_tips(const CompactLrView& lr);

}  // namespace lacedring
