#pragma once
// Codes the integers of an attribute in the order of a walk, as differences from a prediction. Internal to lrcore;
// docs/storage-format.md has it to the bit.

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "lrcore/codec/storage/rans.h"
#include "lrcore/codec/storage/vertex_walk.h"

namespace lacedring::storage {

/// The rule that predicts the integers of a vertex with known parallelograms.
enum class VertexRule : std::uint8_t {
    parallelograms,  ///< their mean, moved by `error` and `smooth`
    mean,            ///< the mean of their base vertices
    neighbor,        ///< the first base vertex
    none,            ///< no prediction: 0
};

struct VertexParameters {
    std::array<VertexRule, 16> rules{};  ///< of each component
    bool has_normal = false;             ///< 3 components by parallelograms, the steepest one by the surface's normal
    std::uint32_t error = 0;             ///< sixteenths of the base vertices' mean error that are added
    std::uint32_t fine = 7;              ///< halves of a bit of a residual's expected size that a symbol has
    std::uint32_t smooth = 0;            ///< sixteenths of the way from there to the base vertices' mean
};

/// x / 2^count, rounded to the nearest integer, halves up.
constexpr std::int64_t rounded(std::int64_t x, std::uint32_t count) {
    return (x + (std::int64_t{1} << (count - 1))) >> count;
}
constexpr std::int32_t as_signed(std::uint32_t x) {
    return static_cast<std::int32_t>(x);
}
constexpr std::int64_t magnitude(std::int64_t x) {
    return x < 0 ? -x : x;
}
constexpr std::uint8_t size_of_residual(std::uint32_t residual) {
    return static_cast<std::uint8_t>(std::bit_width(fold(residual)));
}

/// Vectors of the surface that the normal is made of are cut to 21 bits.
constexpr std::int32_t kLongest = (1 << 20) - 1;

/// The models of one component: of the kinds of vertices, and of steps of the size that the residual may be expected to
/// have, in halves of a bit.
class SizedModels {
  public:
    enum Kind : std::uint32_t { one, two, begin, beside };  // parallelograms; those of a walk's start

    /// A residual, folded. What is left of it without its lowest bits is a symbol: up to 3 itself, then a range of
    /// numbers. Those bits and the place in the range follow as they are.
    template <class Coder>
    LACEDRING_INLINE std::uint32_t code(Coder& coder, Kind kind, std::uint32_t step, std::uint32_t fine,
                                        std::uint32_t value) {
        if (kind >= begin) return others_[kind - begin].code(coder, value);
        step = std::min(step, kSteps - 1);
        const std::uint32_t low = step > fine ? (step - fine + 1) / 2 : 0;
        const std::uint32_t symbol = coder.symbol(models_[kind * kSteps + step], symbol_of(value >> low));
        if (symbol == kEscape) return others_[2].code(coder, value);
        const std::uint32_t from = static_cast<std::uint32_t>(kBegin[symbol]) << low;
        return from + coder.raw(value - from, kBits[symbol] + low);
    }

  private:
    static constexpr std::uint32_t kSteps = 32, kEscape = 15;
    static constexpr std::array<std::uint16_t, 16> kBegin{0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 64, 128, 256, 512, 1024};
    static constexpr std::array<std::uint8_t, 16> kBits{0, 0, 0, 0, 1, 1, 2, 2, 3, 3, 5, 6, 7, 8, 9, 0};

    static std::uint32_t symbol_of(std::uint32_t value) {
        std::uint32_t symbol = kEscape;
        while (kBegin[symbol] > value) --symbol;
        return symbol;
    }

    std::array<SymbolModel, 2 * kSteps> models_;
    std::array<NumberModel, 3> others_;  // at starts, and of what no symbol has a range for
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
          is_plain_(parameters.error == 0 && parameters.smooth == 0 &&
                    std::all_of(parameters.rules.begin(), parameters.rules.begin() + components,
                                [](VertexRule rule) { return rule == VertexRule::parallelograms; })),
          known_(values.size() / components),
          models_(components) {}

    void start(std::uint32_t v, std::uint32_t from) {
        const std::uint32_t n = count();
        const auto kind = from == kNone ? SizedModels::begin : SizedModels::beside;
        const std::uint32_t by = from == kNone ? last_ : from;
        const Known before = by == kNone ? Known{} : known_[by];
        Known& now = known_[v];
        std::uint32_t* values = values_of(v);
        for (std::uint32_t c = 0; c < n; ++c) {
            const std::uint32_t residual = code(c, kind, 0, values[c] - before.value[c]);
            now.value[c] = values[c] = before.value[c] + residual;
            now.size[c] = size_of_residual(residual);
        }
        last_ = v;
    }

    LACEDRING_INLINE void predicted(std::uint32_t v, const Parallelograms& by, bool two) {
        const auto kind = two ? SizedModels::two : SizedModels::one;
        last_ = v;
        const Known& xa = known_[by[0].x];
        const Known& ya = known_[by[0].y];
        const Known& za = known_[by[0].z];
        const Known& xb = known_[by[1].x];
        const Known& yb = known_[by[1].y];
        const Known& zb = known_[by[1].z];
        const std::uint32_t n = count();
        std::array<std::uint32_t, kN> plain, moved;
        for (std::uint32_t c = 0; c < n; ++c) {
            const std::uint32_t first = xa.value[c] + ya.value[c] - za.value[c];
            const std::uint32_t difference = xb.value[c] + yb.value[c] - zb.value[c] - first;
            plain[c] = first + static_cast<std::uint32_t>(rounded(as_signed(difference), 1));
            moved[c] = plain[c];
            if (is_plain_) continue;
            if (parameters_.rules[c] == VertexRule::none) {
                moved[c] = 0;
                continue;
            }
            std::int64_t smooth = 0, error = 0;
            for (const Known* of : {&xa, &ya, &xb, &yb}) smooth += as_signed(of->value[c] - plain[c]);
            if (parameters_.error != 0) {
                for (const Known* of : {&xa, &ya, &xb, &yb}) error += of->error[c];
            }
            switch (parameters_.rules[c]) {
                case VertexRule::parallelograms:
                    error = error * parameters_.error + smooth * parameters_.smooth;
                    moved[c] += static_cast<std::uint32_t>(rounded(error, 6));
                    break;
                case VertexRule::mean:
                    moved[c] += static_cast<std::uint32_t>(rounded(smooth, 2));
                    break;
                case VertexRule::neighbor:
                    moved[c] = xa.value[c];
                    break;
                case VertexRule::none:
                    break;
            }
        }
        Known& now = known_[v];
        std::uint32_t* values = values_of(v);
        if constexpr (N == 3) {
            if (parameters_.has_normal) {
                std::uint32_t across = 0, along = 0;  // twelve and six times the mean sizes
                for (const Known* of : {&xa, &ya, &za, &xb, &yb, &zb}) {
                    across += of->size[0];
                    along += of->size[1];
                }
                std::array<std::int64_t, 3> normal{};
                add_normal(xa, ya, za, normal);
                add_normal(xb, yb, zb, normal);
                code_by_normal(kind, across, along, normal, moved, now, values);
                for (std::uint32_t c = 0; c < 3; ++c) now.error[c] = as_signed(now.value[c] - plain[c]);
                return;
            }
        }
        std::uint32_t before = 0;
        for (std::uint32_t c = 0; c < n; ++c) {
            std::uint32_t sum = 0;
            for (const Known* of : {&xa, &ya, &za, &xb, &yb, &zb}) sum += of->size[c];
            const std::uint32_t mean = sum / 3;  // in halves
            const std::uint32_t residual = code(c, kind, c == 0 ? mean : mean / 2 + before, values[c] - moved[c]);
            now.value[c] = values[c] = moved[c] + residual;
            now.error[c] = as_signed(now.value[c] - plain[c]);
            now.size[c] = static_cast<std::uint8_t>(before = size_of_residual(residual));
        }
    }

  private:
    static constexpr std::uint32_t kN = N == 0 ? 16 : N;

    /// What is known of a vertex: its value, how far that is from the mean of the parallelograms, and the size of its
    /// residuals in bits; by the normal, that of both others, and of the steepest one.
    struct Known {
        std::array<std::uint32_t, kN> value{};
        std::array<std::int32_t, kN> error{};
        std::array<std::uint8_t, N == 3 ? 8 : kN> size{};
    };

    std::uint32_t count() const { return N != 0 ? N : components_; }
    std::uint32_t* values_of(std::uint32_t v) { return values_.data() + std::size_t{v} * count(); }

    LACEDRING_INLINE std::uint32_t code(std::uint32_t role, SizedModels::Kind kind, std::uint32_t step,
                                        std::uint32_t residual) {
        return unfold(models_[role].code(coder_, kind, step, parameters_.fine, fold(residual)));
    }

    static void add_normal(const Known& x, const Known& y, const Known& z, std::array<std::int64_t, 3>& normal) {
        std::int64_t a[3], b[3];
        for (std::uint32_t c = 0; c < 3; ++c) {
            a[c] = std::clamp(as_signed(y.value[c] - x.value[c]), -kLongest, kLongest);
            b[c] = std::clamp(as_signed(z.value[c] - x.value[c]), -kLongest, kLongest);
        }
        normal[0] += a[1] * b[2] - a[2] * b[1];
        normal[1] += a[2] * b[0] - a[0] * b[2];
        normal[2] += a[0] * b[1] - a[1] * b[0];
    }

    LACEDRING_INLINE void code_by_normal(SizedModels::Kind kind, std::uint32_t across, std::uint32_t along,
                                         const std::array<std::int64_t, 3>& normal,
                                         const std::array<std::uint32_t, kN>& moved, Known& now,
                                         std::uint32_t* values) {
        std::uint32_t k = magnitude(normal[1]) > magnitude(normal[0]) ? 1 : 0;
        if (magnitude(normal[2]) > magnitude(normal[k])) k = 2;
        const std::uint32_t u = k == 2 ? 0 : k + 1, w = k == 0 ? 2 : k - 1;
        const std::uint32_t ru = code(0, kind, across / 6, values[u] - moved[u]);
        const std::uint32_t su = size_of_residual(ru);
        const std::uint32_t rw = code(1, kind, across / 12 + su, values[w] - moved[w]);
        const std::uint32_t sw = size_of_residual(rw);
        // The steepest component, where the plane through the prediction is.
        const auto width = static_cast<std::uint32_t>(std::bit_width(static_cast<std::uint64_t>(magnitude(normal[k]))));
        const std::uint32_t shift = width > 14 ? width - 14 : 0;
        const auto part = [&](std::uint32_t c, std::uint32_t r) {
            return static_cast<std::int32_t>(normal[c] >> shift) * std::clamp(as_signed(r), -32767, 32767);
        };
        const auto nk = static_cast<std::int32_t>(normal[k] >> shift);
        const std::int32_t up = (part(u, ru) + part(w, rw)) / (nk == 0 ? 1 : nk);  // all are 0 where nk is
        const std::uint32_t steepest = moved[k] - static_cast<std::uint32_t>(up);
        const std::uint32_t rk = code(2, kind, (along + 2 * (su + sw)) / 5, values[k] - steepest);
        now.value[u] = values[u] = moved[u] + ru;
        now.value[w] = values[w] = moved[w] + rw;
        now.value[k] = values[k] = steepest + rk;
        now.size[0] = static_cast<std::uint8_t>(su + sw);
        now.size[1] = size_of_residual(rk);
    }

    Coder& coder_;
    const VertexParameters parameters_;
    std::uint32_t components_;
    std::span<std::uint32_t> values_;
    bool is_plain_;  // predictions are the means of parallelograms
    std::vector<Known> known_;
    std::vector<SizedModels> models_;
    std::uint32_t last_ = kNone;
};

}  // namespace lacedring::storage
