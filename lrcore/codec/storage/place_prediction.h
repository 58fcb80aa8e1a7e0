#pragma once
// Predicts texture coordinates (two integers per vertex) from the positions of vertices: extrapolates the affine map
// from surface to texture of a neighboring triangle. Internal to lrcore. Specified in docs/storage-format.md.

#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "lrcore/base/compiler.h"
#include "lrcore/codec/storage/vertex_places.h"
#include "lrcore/codec/storage/vertex_walk.h"

namespace lacedring::storage {

class PlacePrediction {
  public:
    using Pair = std::array<std::uint32_t, 2>;

    explicit PlacePrediction(const VertexPlaces& places) : places_(places), scaled_(places.positions) {}

    /// Predicts v from the values at its parallelograms.
    LACEDRING_INLINE Pair predict(std::uint32_t v, const Parallelograms& by,
                                  std::span<const std::uint32_t> values) const {
        const Place at = place(v);
        Pair out = extend(at, by[0], values);
        if (by[0] == by[1]) return out;
        const Pair other = extend(at, by[1], values);
        for (std::size_t c = 0; c < 2; ++c) {
            const auto difference = static_cast<std::int32_t>(other[c] - out[c]);
            out[c] += static_cast<std::uint32_t>((std::int64_t{difference} + 1) >> 1);
        }
        return out;
    }

  private:
    LACEDRING_INLINE Place place(std::uint32_t v) const { return scaled_[places_.vertex(v)]; }

    static LACEDRING_INLINE double square_of_product(const Place& a, const std::array<double, 3>& b) {
        return rounded_square(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
    }

    /// Rotates the triangle (x, y, v) into the plane of (x, y, z), where v = x + along (y - x) - across (z - x).
    LACEDRING_INLINE Pair extend(const Place& v, const Parallelogram& by, std::span<const std::uint32_t> values) const {
        const Place x = place(by.x), y = place(by.y), z = place(by.z);
        Place edge;
        std::array<double, 3> to_v, to_z;
        double square = 0, v_along = 0, z_along = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            edge[c] = y[c] - x[c];
            to_v[c] = v[c] - x[c];
            to_z[c] = z[c] - x[c];
            square += static_cast<double>(edge[c]) * edge[c];
            v_along += edge[c] * to_v[c];
            z_along += edge[c] * to_z[c];
        }
        const double z_height = square_of_product(edge, to_z);  // squared height of z
        std::int64_t along = kOne, across = kOne;               // default for degenerate triangles: a parallelogram
        if (z_height > 0) {
            const double heights = std::sqrt(square_of_product(edge, to_v) / z_height);
            across = static_cast<std::int64_t>(std::min(kOne * heights + 0.5, kMost));
            // Exact: an integer below 2^63, rounded only once.
            const std::int64_t sum =
                kOne * static_cast<std::int64_t>(v_along) + across * static_cast<std::int64_t>(z_along);
            along = static_cast<std::int64_t>(std::clamp(static_cast<double>(sum) / square, -kMost, kMost));
        }
        Pair out;
        for (std::size_t c = 0; c < 2; ++c) {
            const auto value = [&](std::uint32_t i) { return values[std::size_t{2} * i + c]; };
            const auto y_less = static_cast<std::int32_t>(value(by.y) - value(by.x));
            const auto z_less = static_cast<std::int32_t>(value(by.z) - value(by.x));
            out[c] = value(by.x) + static_cast<std::uint32_t>((along * y_less - across * z_less + kOne / 2) >> 16);
        }
        return out;
    }

    static constexpr std::int64_t kOne = 1 << 16;
    static constexpr double kMost = 1 << 20;

    VertexPlaces places_;
    ScaledPlaces scaled_;
};

/// A visitor of VertexWalk that converts between values and their differences from the prediction; `Coding`, another
/// visitor, codes the differences.
template <bool kDecodes, class Coding>
class PlaceVisitor {
  public:
    /// Two `values` and two `differences` per vertex. Computes values from differences if kDecodes, else the reverse.
    PlaceVisitor(const PlacePrediction& prediction, std::span<std::uint32_t> values,
                 std::span<std::uint32_t> differences, Coding& coding)
        : prediction_(prediction), values_(values), differences_(differences), coding_(coding) {}

    void start(std::uint32_t v, std::uint32_t from) {
        const std::uint32_t by = from == kNone ? last_ : from;
        PlacePrediction::Pair base{};
        for (std::size_t c = 0; c < 2 && by != kNone; ++c) {
            // `coding_` subtracts the difference of vertex `by`, so that it codes the difference of the two values.
            const std::size_t i = std::size_t{2} * by + c;
            base[c] = values_[i] - differences_[i];
        }
        code(v, base, [&] { coding_.start(v, from); });
    }
    LACEDRING_INLINE void predicted(std::uint32_t v, const Parallelograms& by) {
        code(v, prediction_.predict(v, by, values_), [&] { coding_.predicted(v, by); });
    }

  private:
    template <class Code>
    LACEDRING_INLINE void code(std::uint32_t v, const PlacePrediction::Pair& base, Code&& coded) {
        last_ = v;
        const std::size_t i = std::size_t{2} * v;
        for (std::size_t c = 0; c < 2 && !kDecodes; ++c) differences_[i + c] = values_[i + c] - base[c];
        coded();
        for (std::size_t c = 0; c < 2 && kDecodes; ++c) values_[i + c] = differences_[i + c] + base[c];
    }

    const PlacePrediction& prediction_;
    std::span<std::uint32_t> values_, differences_;
    Coding& coding_;
    std::uint32_t last_ = kNone;
};

}  // namespace lacedring::storage
