#pragma once
// Statistics of the distances, along the ring, from ring edges to the tips of their triangles. Paper: LR 2011, section
// 6.1 and Figure 8.

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "lacedring/streams.hpp"

namespace lacedring {

/// Significant bits of the distance from ring vertex v to `tip` along the ring, the shorter way: 1 for a neighbor, 0
/// for v itself. v and tip are below ring_vertices (m_r).
constexpr std::uint32_t offset_bits(std::uint32_t v, std::uint32_t tip, std::uint32_t ring_vertices) {
    const std::uint32_t forward = tip >= v ? tip - v : tip + ring_vertices - v;
    return static_cast<std::uint32_t>(std::bit_width(std::min(forward, ring_vertices - forward)));
}

/// Numbers of triangles by the ring offset of their tip. Each triangle is counted once, a T2 with its second edge.
struct OffsetCounts {
    std::array<std::uint32_t, 29> bits{};  ///< bits[b]: triangles with a slot, whose offset has b significant bits
    std::uint32_t off_ring = 0;            ///< triangles with a slot (T0w) and an isolated tip: no offset
    std::uint32_t t0 = 0;                  ///< triangles without a slot
};
/// Counts the triangles of valid tables. Cost: O(m_r).
OffsetCounts count_offsets(const LrView& lr);

/// n_l of section 8: the number of slots of long words that have no opposites in VO*, in valid tables. Cost: O(m_r).
std::uint32_t count_long_tips(const CompactLrView& lr);

}  // namespace lacedring
