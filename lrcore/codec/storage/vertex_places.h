#pragma once
// The positions of an attribute's vertices, from which normals and texture coordinates are predicted. Internal to
// lrcore.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

#include "lrcore/base/compiler.h"

namespace lacedring::storage {

struct VertexPlaces {
    /// Three integers per vertex with a common scale; empty if unknown.
    std::span<const std::uint32_t> positions;
    std::span<const std::uint32_t> vertex_of;  ///< vertex of each copy; empty if the attribute has no copies

    LACEDRING_INLINE std::uint32_t vertex(std::uint32_t copy) const {
        return vertex_of.empty() ? copy : vertex_of[copy];
    }
};

/// Does each of `copies` have a position? Cost: O(copies).
inline bool has_places(const VertexPlaces& places, std::uint32_t copies) {
    if (places.vertex_of.empty()) return places.positions.size() == std::size_t{3} * copies;
    return places.vertex_of.size() == copies &&
           std::ranges::all_of(places.vertex_of, [&](std::uint32_t v) { return v < places.positions.size() / 3; });
}

using Place = std::array<std::int32_t, 3>;

/// Positions relative to their minimum, in 20 bits. Sums of three products of them are exact as doubles.
class ScaledPlaces {
  public:
    explicit ScaledPlaces(std::span<const std::uint32_t> positions) : positions_(positions) {
        Place low, high;
        low.fill(INT32_MAX);
        high.fill(INT32_MIN);
        for (std::size_t i = 0; i + 3 <= positions.size(); i += 3) {
            for (std::size_t c = 0; c < 3; ++c) {
                const auto x = static_cast<std::int32_t>(positions[i + c]);
                low[c] = std::min(low[c], x);
                high[c] = std::max(high[c], x);
            }
        }
        std::uint32_t extent = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            low_[c] = static_cast<std::uint32_t>(low[c]);
            extent |= static_cast<std::uint32_t>(high[c]) - low_[c];
        }
        const auto width = static_cast<std::uint32_t>(std::bit_width(extent));
        shift_ = width > kPlaceBits ? width - kPlaceBits : 0;
    }

    LACEDRING_INLINE Place operator[](std::uint32_t v) const {
        const std::uint32_t* p = positions_.data() + std::size_t{3} * v;
        Place out;
        for (std::size_t c = 0; c < 3; ++c) out[c] = static_cast<std::int32_t>((p[c] - low_[c]) >> shift_);
        return out;
    }

  private:
    static constexpr std::uint32_t kPlaceBits = 20;

    std::span<const std::uint32_t> positions_;
    std::array<std::uint32_t, 3> low_;
    std::uint32_t shift_;
};

/// The squared length of a vector of integers below 2^53. Each is first rounded to a float, whose square is exact, so
/// fused operations do not change the result.
LACEDRING_INLINE double rounded_square(double x, double y, double z) {
    x = static_cast<float>(x);
    y = static_cast<float>(y);
    z = static_cast<float>(z);
    return x * x + y * y + z * z;
}

}  // namespace lacedring::storage
