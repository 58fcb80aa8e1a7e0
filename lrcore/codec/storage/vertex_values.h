#pragma once
// Codes the integers of an attribute in the order of a walk, as differences from a prediction. Internal to lrcore;
// docs/storage-format.md has it to the bit.

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "lrcore/codec/storage/rans.h"
#include "lrcore/codec/storage/vertex_walk.h"

namespace lacedring::storage {

/// How the integers of a vertex are predicted where parallelograms are known.
enum class VertexRule : std::uint8_t {
    parallelograms,  ///< their mean, moved by `error` and `smooth`
    mean,            ///< the mean of their base vertices
    neighbor,        ///< the first base vertex
};

struct VertexParameters {
    std::array<VertexRule, 16> rules{};  ///< of each component
    bool has_normal = false;             ///< 3 components by parallelograms, the steepest one by the surface's normal
    std::uint32_t error = 0;             ///< sixteenths of the base vertices' mean error that are added
    std::uint32_t smooth = 0;            ///< sixteenths of the way from there to the base vertices' mean
};

/// x / 2^count, rounded to the nearest integer, halves up.
constexpr std::int64_t rounded(std::int64_t x, std::uint32_t count) {
    return (x + (std::int64_t{1} << (count - 1))) >> count;
}
constexpr std::int32_t as_signed(std::uint32_t x) {
    return static_cast<std::int32_t>(x);
}
constexpr std::uint8_t size_of_residual(std::uint32_t residual) {
    return static_cast<std::uint8_t>(std::bit_width(fold(residual)));
}

/// Vectors of the surface that the normal is made of are cut to 21 bits.
constexpr std::int64_t kLongest = (1 << 20) - 1;

/// The models of one component: of the kinds of vertices, and of steps of the size that the residual may be expected to
/// have.
class SizedModels {
  public:
    static constexpr std::uint32_t kSteps = 24;
    enum Kind : std::uint32_t { one, more, begin, beside, kKinds };  // parallelograms; those of a walk's start

    NumberModel& at(Kind kind, std::uint32_t step) { return models_[kind * kSteps + std::min(step, kSteps - 1)]; }

  private:
    std::array<NumberModel, kKinds * kSteps> models_;
};

/// A visitor of VertexWalk. `N` is the number of components, or 0 for any number.
template <class Coder, std::uint32_t N>
class VertexValueCoder {
  public:
    /// `values`: `components` of each vertex; a Decoder fills them in.
    VertexValueCoder(Coder& coder, const VertexParameters& parameters, std::uint32_t components,
                     std::span<std::uint32_t> values)
        : coder_(coder),
          parameters_(parameters),
          components_(components),
          values_(values),
          errors_(values.size(), 0),
          sizes_(values.size(), 0),
          models_(components) {}

    void start(std::uint32_t v, std::uint32_t from) {
        const std::uint32_t n = count();
        const auto kind = from == kNone ? SizedModels::begin : SizedModels::beside;
        const std::uint32_t by = from == kNone ? last_ : from;
        for (std::uint32_t c = 0; c < n; ++c) {
            const std::uint32_t predicted = by == kNone ? 0 : value(by, c);
            const std::uint32_t residual = code(c, kind, 0, value(v, c) - predicted);
            value(v, c) = predicted + residual;
            sizes_[index(v, c)] = size_of_residual(residual);
        }
        last_ = v;
    }

    void predicted(std::uint32_t v, std::span<const Parallelogram> all) {
        if constexpr (N == 3) {
            if (parameters_.has_normal) return by_normal(v, all);
        }
        const std::uint32_t n = count();
        const auto kind = all.size() == 1 ? SizedModels::one : SizedModels::more;
        std::uint32_t before = 0;
        for (std::uint32_t c = 0; c < n; ++c) {
            const Prediction p = predict(all, c);
            std::uint32_t sum = 0;
            for (const auto& [x, y, z] : all) sum += sizes_[index(x, c)] + sizes_[index(y, c)] + sizes_[index(z, c)];
            const std::uint32_t mean = sum * kThirds[all.size()] >> 15;  // in halves
            const std::uint32_t step = c == 0 ? mean : (mean + 2 * before) / 2;
            const std::uint32_t residual = code(c, kind, step, value(v, c) - p.value);
            value(v, c) = p.value + residual;
            errors_[index(v, c)] = as_signed(value(v, c) - p.plain);
            sizes_[index(v, c)] = static_cast<std::uint8_t>(before = size_of_residual(residual));
        }
        last_ = v;
    }

  private:
    struct Prediction {
        std::uint32_t plain, value;  // the mean of the parallelograms, and that moved
    };

    // 65536 / n and 65536 / (3 n), rounded.
    static constexpr auto kParts = [] {
        std::array<std::uint32_t, kMostParallelograms + 1> out{};
        for (std::uint32_t n = 1; n <= kMostParallelograms; ++n) out[n] = (131072 + n) / (2 * n);
        return out;
    }();
    static constexpr auto kThirds = [] {
        std::array<std::uint32_t, kMostParallelograms + 1> out{};
        for (std::uint32_t n = 1; n <= kMostParallelograms; ++n) out[n] = (131072 + 3 * n) / (6 * n);
        return out;
    }();

    std::uint32_t count() const { return N != 0 ? N : components_; }
    std::size_t index(std::uint32_t v, std::uint32_t c) const { return std::size_t{v} * count() + c; }
    std::uint32_t& value(std::uint32_t v, std::uint32_t c) { return values_[index(v, c)]; }

    std::uint32_t code(std::uint32_t role, SizedModels::Kind kind, std::uint32_t step, std::uint32_t residual) {
        return unfold(models_[role].at(kind, step).code(coder_, fold(residual)));
    }

    Prediction predict(std::span<const Parallelogram> all, std::uint32_t c) {
        const Parallelogram& first = all.front();
        const std::uint32_t x = value(first.x, c), y = value(first.y, c), base = x + y - value(first.z, c);
        std::int64_t difference = 0;  // of the others from the first
        std::int64_t smooth = std::int64_t{as_signed(x - base)} + as_signed(y - base);
        std::int64_t error = std::int64_t{errors_[index(first.x, c)]} + errors_[index(first.y, c)];
        for (const Parallelogram& p : all.subspan(1)) {
            const std::uint32_t px = value(p.x, c), py = value(p.y, c);
            difference += as_signed(px + py - value(p.z, c) - base);
            smooth += std::int64_t{as_signed(px - base)} + as_signed(py - base);
            error += std::int64_t{errors_[index(p.x, c)]} + errors_[index(p.y, c)];
        }
        const std::int64_t part = kParts[all.size()];
        const std::int64_t mean = rounded(difference * part, 16);
        const std::uint32_t plain = base + static_cast<std::uint32_t>(mean);
        switch (parameters_.rules[c]) {
            case VertexRule::neighbor:
                return {plain, x};
            case VertexRule::mean:
                return {plain, base + static_cast<std::uint32_t>(rounded(smooth * part, 17))};
            default:
                break;
        }
        smooth -= 2 * static_cast<std::int64_t>(all.size()) * mean;
        const std::int64_t moved = error * parameters_.error + smooth * parameters_.smooth;
        return {plain, plain + static_cast<std::uint32_t>(rounded(moved * part, 21))};
    }

    void by_normal(std::uint32_t v, std::span<const Parallelogram> all) {
        const auto kind = all.size() == 1 ? SizedModels::one : SizedModels::more;
        std::array<Prediction, 3> p;
        for (std::uint32_t c = 0; c < 3; ++c) p[c] = predict(all, c);
        std::uint32_t sums[2] = {0, 0};
        std::array<std::int64_t, 3> normal{};
        for (const auto& [x, y, z] : all) {
            for (const std::uint32_t w : {x, y, z}) {
                sums[0] += sizes_[index(w, 0)];
                sums[1] += sizes_[index(w, 1)];
            }
            std::int64_t a[3], b[3];
            for (std::uint32_t c = 0; c < 3; ++c) {
                a[c] = std::clamp<std::int64_t>(as_signed(value(y, c) - value(x, c)), -kLongest, kLongest);
                b[c] = std::clamp<std::int64_t>(as_signed(value(z, c) - value(x, c)), -kLongest, kLongest);
            }
            for (std::uint32_t c = 0; c < 3; ++c) {
                const std::uint32_t u = c == 2 ? 0 : c + 1, w = c == 0 ? 2 : c - 1;
                normal[c] += a[u] * b[w] - a[w] * b[u];
            }
        }
        std::uint32_t k = 0;
        for (std::uint32_t c = 1; c < 3; ++c) {
            if (std::abs(normal[c]) > std::abs(normal[k])) k = c;
        }
        const std::uint32_t u = k == 2 ? 0 : k + 1, w = k == 0 ? 2 : k - 1;
        const std::uint32_t third = kThirds[all.size()];
        const std::uint32_t across = sums[0] * third;  // twice the mean size of both, in 2^-16
        const std::uint32_t ru = code(0, kind, across >> 16, value(v, u) - p[u].value);
        const std::uint32_t su = size_of_residual(ru);
        const std::uint32_t rw = code(1, kind, ((across >> 16) + 2 * su) / 2, value(v, w) - p[w].value);
        const std::uint32_t sw = size_of_residual(rw);
        // The steepest component, where the plane through the prediction is.
        const auto width = static_cast<std::uint32_t>(std::bit_width(static_cast<std::uint64_t>(std::abs(normal[k]))));
        const std::uint32_t shift = width > 14 ? width - 14 : 0;
        const auto nk = static_cast<std::int32_t>(normal[k] >> shift);
        if (nk != 0) {
            const auto part = [&](std::uint32_t c, std::uint32_t r) {
                return static_cast<std::int32_t>(normal[c] >> shift) * std::clamp(as_signed(r), -32767, 32767);
            };
            p[k].value -= static_cast<std::uint32_t>((part(u, ru) + part(w, rw)) / nk);
        }
        const std::uint32_t step = ((sums[1] * third >> 14) * 3 + 4 * (su + sw)) / 10;
        const std::uint32_t rk = code(2, kind, step, value(v, k) - p[k].value);
        value(v, u) = p[u].value + ru;
        value(v, w) = p[w].value + rw;
        value(v, k) = p[k].value + rk;
        for (std::uint32_t c = 0; c < 3; ++c) errors_[index(v, c)] = as_signed(value(v, c) - p[c].plain);
        sizes_[index(v, 0)] = static_cast<std::uint8_t>(su + sw);
        sizes_[index(v, 1)] = size_of_residual(rk);
        last_ = v;
    }

    Coder& coder_;
    const VertexParameters& parameters_;
    std::uint32_t components_;
    std::span<std::uint32_t> values_;
    std::vector<std::int32_t> errors_;  // from the mean of the parallelograms
    std::vector<std::uint8_t> sizes_;   // of residuals, in bits; by the normal: both others', the steepest one's
    std::vector<SizedModels> models_;
    std::uint32_t last_ = kNone;
};

}  // namespace lacedring::storage
