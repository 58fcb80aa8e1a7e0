#pragma once
// Predicts the integers of an attribute in the order of a walk; converts values to residuals and back. Internal to
// lrcore. Specified in docs/storage-format.md.

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "lrcore/base/compiler.h"
#include "lrcore/codec/storage/rans.h"
#include "lrcore/codec/storage/vertex_walk.h"

namespace lacedring::storage {

/// The rule that predicts the integers of a vertex with known parallelograms.
enum class VertexRule : std::uint8_t {
    /// Mean of the parallelograms' predictions, adjusted by `error` and `smooth`.
    parallelograms,
    mean,      ///< the mean of their base vertices
    neighbor,  ///< the first base vertex
    none,      ///< no prediction: 0
};

struct VertexParameters {
    std::array<VertexRule, 16> rules{};  ///< per component
    /// 3 components by parallelograms, the steepest of them by the surface's normal.
    bool has_normal = false;
    std::uint32_t error = 0;  ///< sixteenths of the base vertices' mean error added
    /// Half bits of a residual's expected size that its symbol covers; lower bits are raw.
    std::uint32_t fine = 7;
    std::uint32_t smooth = 0;  ///< then, sixteenths of the way toward the base vertices' mean
};

/// x / 2^count, rounded to the nearest integer, halves up.
constexpr std::int64_t rounded(std::int64_t x, std::uint32_t count) {
    return (x + (std::int64_t{1} << (count - 1))) >> count;
}
constexpr std::int32_t as_signed(std::uint32_t x) {
    return static_cast<std::int32_t>(x);
}
/// Absolute value of a signed number modulo 2^64.
constexpr std::uint64_t magnitude(std::uint64_t x) {
    return x >> 63 != 0 ? 0 - x : x;
}
/// A visitor of VertexWalk. `N` is the number of components, or 0 for any number. Computes values from residuals if
/// kRestores, else residuals from values.
template <std::uint32_t N, bool kRestores>
class VertexPredictor {
  public:
    /// `values`: `components` per vertex. `residuals`: as many, folded, in the order of the walk.
    VertexPredictor(const VertexParameters& parameters, std::uint32_t components, std::span<std::uint32_t> values,
                    std::span<std::uint32_t> residuals)
        : parameters_(parameters),
          components_(components),
          values_(values.data()),
          residual_(residuals.data()),
          has_one_rule_(std::all_of(parameters.rules.begin(), parameters.rules.begin() + components,
                                    [](VertexRule rule) { return rule == VertexRule::parallelograms; })),
          errors_(parameters.error != 0 ? values.size() : 0) {}

    void start(std::uint32_t v, std::uint32_t from) {
        const std::uint32_t n = count(), by = from == kNone ? last_ : from;
        std::uint32_t* values = values_of(v);
        for (std::uint32_t c = 0; c < n; ++c) exchange(values[c], by == kNone ? 0 : values_of(by)[c], residual_[c]);
        residual_ += n;
        last_ = v;
    }

    LACEDRING_INLINE void predicted(std::uint32_t v, const Parallelograms& by) {
        const std::uint32_t *xa = values_of(by[0].x), *ya = values_of(by[0].y), *za = values_of(by[0].z);
        const std::uint32_t *xb = values_of(by[1].x), *yb = values_of(by[1].y), *zb = values_of(by[1].z);
        const std::uint32_t n = count();
        std::array<std::uint32_t, kN> plain, moved;
        for (std::uint32_t c = 0; c < n; ++c) {
            const std::uint32_t first = xa[c] + ya[c] - za[c];
            plain[c] = first + static_cast<std::uint32_t>(rounded(as_signed(xb[c] + yb[c] - zb[c] - first), 1));
            moved[c] = plain[c];
        }
        if (!has_one_rule_) {
            for (std::uint32_t c = 0; c < n; ++c) {
                const VertexRule rule = parameters_.rules[c];
                const std::int32_t to_mean = as_signed(xa[c] + ya[c] + xb[c] + yb[c] - 4 * plain[c]);
                if (rule == VertexRule::mean) moved[c] += static_cast<std::uint32_t>(rounded(to_mean, 2));
                if (rule == VertexRule::neighbor) moved[c] = xa[c];
                if (rule == VertexRule::none) moved[c] = 0;
            }
        } else if (parameters_.smooth != 0 || parameters_.error != 0) {
            for (std::uint32_t c = 0; c < n; ++c) {
                std::int64_t move = as_signed(xa[c] + ya[c] + xb[c] + yb[c] - 4 * plain[c]);
                move *= parameters_.smooth;
                if (parameters_.error != 0) {
                    for (const std::uint32_t* of : {xa, ya, xb, yb}) {
                        move += std::int64_t{errors_[place(of) + c]} * parameters_.error;
                    }
                }
                moved[c] += static_cast<std::uint32_t>(rounded(move, 6));
            }
        }
        std::uint32_t* values = values_of(v);
        bool done = false;
        if constexpr (N == 3) {
            if (parameters_.has_normal) {
                std::array<std::uint64_t, 3> normal{};
                add_normal(xa, ya, za, normal);
                add_normal(xb, yb, zb, normal);
                by_normal(normal, moved, values);
                done = true;
            }
        }
        for (std::uint32_t c = 0; c < n && !done; ++c) exchange(values[c], moved[c], residual_[c]);
        if (parameters_.error != 0) {
            for (std::uint32_t c = 0; c < n; ++c) errors_[place(values) + c] = as_signed(values[c] - plain[c]);
        }
        residual_ += n;
        last_ = v;
    }

  private:
    static constexpr std::uint32_t kN = N == 0 ? 16 : N;

    std::uint32_t count() const { return N != 0 ? N : components_; }
    std::uint32_t* values_of(std::uint32_t v) const { return values_ + std::size_t{v} * count(); }
    std::size_t place(const std::uint32_t* value) const { return static_cast<std::size_t>(value - values_); }

    static void exchange(std::uint32_t& value, std::uint32_t predicted, std::uint32_t& residual) {
        if constexpr (kRestores) {
            value = predicted + unfold(residual);
        } else {
            residual = fold(value - predicted);
        }
    }

    static std::uint64_t difference(std::uint32_t x, std::uint32_t y) {
        return static_cast<std::uint64_t>(std::int64_t{as_signed(x - y)});
    }
    /// Adds the cross product (y - x) x (z - x), modulo 2^64.
    static void add_normal(const std::uint32_t* x, const std::uint32_t* y, const std::uint32_t* z,
                           std::array<std::uint64_t, 3>& normal) {
        std::uint64_t a[3], b[3];
        for (std::uint32_t c = 0; c < 3; ++c) {
            a[c] = difference(y[c], x[c]);
            b[c] = difference(z[c], x[c]);
        }
        normal[0] += a[1] * b[2] - a[2] * b[1];
        normal[1] += a[2] * b[0] - a[0] * b[2];
        normal[2] += a[0] * b[1] - a[1] * b[0];
    }

    /// Codes the steepest component last: its prediction is on the plane through the prediction, evaluated at the two
    /// other components.
    LACEDRING_INLINE void by_normal(const std::array<std::uint64_t, 3>& normal,
                                    const std::array<std::uint32_t, kN>& moved, std::uint32_t* values) {
        const std::array<std::uint64_t, 3> size{magnitude(normal[0]), magnitude(normal[1]), magnitude(normal[2])};
        std::uint32_t k = size[1] > size[0] ? 1 : 0;
        k = size[2] > size[k] ? 2 : k;
        const std::uint32_t u = kNext[k], w = kNext[u];
        exchange(values[u], moved[u], residual_[0]);
        exchange(values[w], moved[w], residual_[1]);
        const auto width = static_cast<std::uint32_t>(std::bit_width(size[k]));
        const std::uint32_t shift = width > 14 ? width - 14 : 0;
        const auto cut = [&](std::uint32_t c) {
            return static_cast<std::int32_t>(static_cast<std::int64_t>(normal[c]) >> shift);
        };
        const auto part = [&](std::uint32_t c) {
            return cut(c) * std::clamp(as_signed(values[c] - moved[c]), -32767, 32767);
        };
        const std::int32_t nk = cut(k), up = (part(u) + part(w)) / (nk == 0 ? 1 : nk);  // if nk is 0, all parts are 0
        exchange(values[k], moved[k] - static_cast<std::uint32_t>(up), residual_[2]);
    }

    static constexpr std::array<std::uint8_t, 3> kNext{1, 2, 0};

    const VertexParameters parameters_;
    std::uint32_t components_;
    std::uint32_t *values_, *residual_;
    bool has_one_rule_;                 // all rules are parallelograms
    std::vector<std::int32_t> errors_;  // per value: difference from the mean of its parallelograms
    std::uint32_t last_ = kNone;
};

}  // namespace lacedring::storage
