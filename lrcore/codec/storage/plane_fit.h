#pragma once
// Fits planes to the residuals of a run of vertices, in integers, to predict the planes that the encoder of a vertex
// stream has chosen.
// Internal to lrcore.

#include <array>
#include <bit>
#include <cstdint>

#include "lrcore/codec/storage/rans.h"
#include "lrcore/codec/storage/vertex_blocks.h"

namespace lacedring::storage {

/// The sums of products of three components' residuals.
class PlaneFit {
  public:
    /// `count` residuals per component, at most 32.
    PlaneFit(const std::array<const std::uint32_t*, 3>& residuals, std::uint32_t count) {
        std::uint32_t all = 0;
        for (const std::uint32_t* of : residuals) {
            for (std::uint32_t i = 0; i < count; ++i) all |= fold(of[i]);
        }
        const auto width = static_cast<std::uint32_t>(std::bit_width(all));
        const std::uint32_t shift = width > 13 ? width - 13 : 0;  // numbers of 12 bits and a sign
        std::int32_t sums[6] = {0, 0, 0, 0, 0, 0};
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::int32_t x = static_cast<std::int32_t>(residuals[0][i]) >> shift;
            const std::int32_t y = static_cast<std::int32_t>(residuals[1][i]) >> shift;
            const std::int32_t z = static_cast<std::int32_t>(residuals[2][i]) >> shift;
            sums[0] += x * x;
            sums[1] += y * y;
            sums[2] += z * z;
            sums[3] += y * z;
            sums[4] += z * x;
            sums[5] += x * y;
        }
        for (std::uint32_t k = 0; k < 3; ++k) {
            square_[k] = sums[k];
            cross_[k] = sums[3 + k];
        }
    }

    /// The component whose residuals a plane is likely to reduce most. Set by find_axis().
    std::uint32_t axis() const { return axis_; }
    /// Twice the base-2 logarithm of the factor by which a plane reduces that component's sum of squared residuals.
    std::uint32_t gain() const { return gain_; }

    void find_axis() {
        std::int64_t s[3], x[3];
        std::uint64_t largest = 0;
        for (std::uint32_t k = 0; k < 3; ++k) largest |= static_cast<std::uint64_t>(square_[k]);
        const auto width = static_cast<std::uint32_t>(std::bit_width(largest));
        const std::uint32_t shift = width > 19 ? width - 19 : 0;
        for (std::uint32_t k = 0; k < 3; ++k) {
            s[k] = square_[k] >> shift;
            x[k] = cross_[k] >> shift;
        }
        std::int64_t best = 0;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t u = k == 2 ? 0 : k + 1, v = k == 0 ? 2 : k - 1;
            const std::int64_t now = s[k] * (s[u] * s[v] - x[k] * x[k]);
            if (now <= best) continue;
            best = now;
            axis_ = k;
        }
        const std::int64_t rest = s[0] * (s[1] * s[2] - x[0] * x[0]) - x[2] * (x[2] * s[2] - x[0] * x[1]) +
                                  x[1] * (x[2] * x[0] - x[1] * s[1]);
        gain_ = ratio(best, rest);
    }

    /// 2 log2 of the factor by which a plane of these slopes reduces the sum of squared residuals of component `axis`.
    std::uint32_t gain_of(std::uint32_t axis, const std::array<std::int8_t, 2>& slope) const {
        const std::uint32_t u = axis == 2 ? 0 : axis + 1, v = axis == 0 ? 2 : axis - 1;
        const std::int64_t a = slope[0], b = slope[1];
        // The sum of (4 r - a r_u - b r_v)^2.
        const std::int64_t rest = 16 * square_[axis] - 8 * (a * cross_[v] + b * cross_[u]) + a * a * square_[u] +
                                  b * b * square_[v] + 2 * a * b * cross_[axis];
        return ratio(16 * square_[axis], rest);
    }

    /// The slopes, along an axis, of the plane nearest to the residuals.
    std::array<std::int8_t, 2> slopes(std::uint32_t axis) const {
        const std::uint32_t u = axis == 2 ? 0 : axis + 1, v = axis == 0 ? 2 : axis - 1;
        const std::int64_t uu = square_[u], vv = square_[v], uv = cross_[axis], um = cross_[v], vm = cross_[u];
        const std::int64_t determinant = uu * vv - uv * uv;
        if (determinant > (uu * vv) >> 20) {
            return {quarters(um * vv - vm * uv, determinant), quarters(vm * uu - um * uv, determinant)};
        }
        if (uu == 0 && vv == 0) return {0, 0};
        if (uu >= vv) return {quarters(um, uu), 0};
        return {0, quarters(vm, vv)};
    }

  private:
    /// 2 log2(a / b), approximately, as an integer; 0 if a <= b.
    static std::uint32_t ratio(std::int64_t a, std::int64_t b) {
        const std::uint32_t la = logarithm(a), lb = logarithm(b);
        return la > lb ? la - lb : 0;
    }
    static std::uint32_t logarithm(std::int64_t x) {
        if (x <= 1) return 0;
        const auto width = static_cast<std::uint32_t>(std::bit_width(static_cast<std::uint64_t>(x)));
        return 2 * (width - 1) + static_cast<std::uint32_t>(x >> (width - 2) & 1);
    }
    /// x / y in quarters, clamped to -4 to 3.
    static std::int8_t quarters(std::int64_t x, std::int64_t y) {
        if (x <= -y) return -4;
        if (4 * x >= 3 * y) return 3;
        return static_cast<std::int8_t>((8 * x + 9 * y) / (2 * y) - 4);
    }

    // Sums of products: of a component with itself; of the two others.
    std::array<std::int64_t, 3> square_{}, cross_{};
    std::uint32_t axis_ = 0, gain_ = 0;
};

}  // namespace lacedring::storage
