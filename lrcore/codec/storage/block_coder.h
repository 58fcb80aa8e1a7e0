#pragma once
// Codes the choices of a vertex stream's blocks and writes the blocks; their integers are already known. Internal to
// lrcore. Specified in docs/storage-format.md.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lrcore/codec/storage/plane_fit.h"
#include "lrcore/codec/storage/rans.h"
#include "lrcore/codec/storage/vertex_blocks.h"

namespace lacedring::storage {

/// Writes bit fields, lowest bit first, into words for which make_room was called.
class BlockBits {
  public:
    void make_room(std::size_t words) {
        if (words_.size() < at_ + words) words_.resize(std::max(at_ + words, words_.size() + words_.size() / 2));
    }
    /// Writes `count` bits, at most 32. The other bits of `value` must be 0.
    void put(std::uint32_t value, std::uint32_t count) {
        window_ |= static_cast<std::uint64_t>(value) << fill_;
        fill_ += count;
        if (fill_ >= 32) {
            words_[at_++] = static_cast<std::uint32_t>(window_);
            window_ >>= 32;
            fill_ -= 32;
        }
    }
    void align() {
        if (fill_ > 0) put(0, 32 - fill_);
    }
    std::uint64_t bits() const { return std::uint64_t{32} * at_ + fill_; }
    std::size_t words() const { return at_; }
    std::span<const std::uint32_t> finished() const { return std::span(words_).first(at_); }

  private:
    std::vector<std::uint32_t> words_;
    std::size_t at_ = 0;
    std::uint64_t window_ = 0;
    std::uint32_t fill_ = 0;
};

template <class Coder>
class BlockCoder {
  public:
    BlockCoder(Coder& coder, std::span<const VertexComponent> components, BlockBits& out)
        : coder_(coder), components_(components), n_(static_cast<std::uint32_t>(components.size())), out_(out) {}

    /// Codes a block's choices (a Decoder sets `choices`) and writes the block. `values`: the integers of `count`
    /// vertices. Returns false if the choices are invalid.
    bool code(const std::uint32_t* values, std::uint32_t count, BlockChoices& choices) {
        // A vertex takes at most 57 bits per component; a run of four takes a plane and 9 bits per component.
        out_.make_room(2 + (std::size_t{count} * (57 + 3) * n_ + 10 * count + 40 * n_) / 32);
        if (!code_predictors(choices)) return false;
        write_begin(values, choices);
        find_residuals(values, count, choices);
        if (n_ == 3 && !code_planes(count, choices)) return false;
        return code_runs(count, choices);
    }

  private:
    using Residuals = std::array<std::uint32_t, kVertexBlock>;

    bool code_predictors(BlockChoices& choices) {
        bool usual = true;
        for (std::uint32_t c = 0; c < n_; ++c) {
            BlockChoices::Predictor& p = choices.predictors[c];
            p.own = coder_.bit(own_predictor_[c == 0 ? 0 : usual ? 1 : 2], p.own ? 1 : 0) != 0;
            usual = !p.own;
            if (usual) {
                p.value = static_cast<std::uint8_t>(components_[c].predictor);
                continue;
            }
            const std::uint32_t low = coder_.symbol(predictor_low_, p.value & 7U);
            const std::uint32_t high = coder_.symbol(predictor_high_, p.value >> 3U);
            if (low > 7 || high > 3) return false;
            p.value = static_cast<std::uint8_t>(low | high << 3);
        }
        const std::uint32_t one = coder_.bit(size_[0], choices.size & 1U);
        choices.size = static_cast<std::uint8_t>(one | coder_.bit(size_[1 + one], choices.size >> 1U) << 1);
        return true;
    }

    void write_begin(const std::uint32_t* values, const BlockChoices& choices) {
        for (std::uint32_t c = 0; c < n_; ++c) {
            const BlockChoices::Predictor& p = choices.predictors[c];
            if (p.own)
                out_.put(1U | static_cast<std::uint32_t>(p.value) << 1, 6);
            else
                out_.put(0, 1);
        }
        out_.put(choices.size, 2);
        for (std::uint32_t c = 0; c < n_; ++c) out_.put(values[c] - components_[c].low, components_[c].first_bits);
    }

    static std::uint32_t quarter(std::uint32_t x) {
        return static_cast<std::uint32_t>(static_cast<std::int32_t>(x + 2) >> 2);
    }

    void find_residuals(const std::uint32_t* values, std::uint32_t count, const BlockChoices& choices) {
        for (std::uint32_t c = 0; c < n_; ++c) {
            const std::uint32_t p = choices.predictors[c].value;
            const std::uint32_t alpha = p % 8 - 2, beta = p / 8 - 2;
            const std::uint32_t* at = values + c;
            std::uint32_t d1 = 0, d2 = 0;
            Residuals& out = residuals_[c];
            for (std::uint32_t i = 0; i + 1 < count; ++i, at += n_) {
                const std::uint32_t step = at[n_] - at[0];
                out[i] = step - quarter(alpha * d1 + beta * d2);
                d2 = d1;
                d1 = step;
            }
        }
    }

    /// Codes the planes and subtracts them from the residuals.
    bool code_planes(std::uint32_t count, BlockChoices& choices) {
        const std::uint32_t length = std::max(kPlaneRun, 4U << choices.size);
        PlaneChoice last;
        for (std::uint32_t begin = 0; begin + 1 < count; begin += length) {
            const std::uint32_t end = std::min(count - 1, begin + length);
            PlaneFit fit({residuals_[0].data() + begin, residuals_[1].data() + begin, residuals_[2].data() + begin},
                         end - begin);
            fit.find_axis();
            const std::uint32_t gain = std::min(fit.gain(), 15U);
            const std::uint32_t last_gain = std::min(fit.gain_of(last.axis, last.slope), 15U);
            PlaneChoice& plane = choices.planes[begin / kPlaneRun];
            if (coder_.bit(has_plane_[gain][last_gain / 2], plane.kind != PlaneChoice::none ? 1 : 0) == 0) {
                plane.kind = PlaneChoice::none;
                continue;
            }
            if (coder_.bit(given_[gain][last_gain], plane.kind == PlaneChoice::given ? 1 : 0) == 0) {
                plane = last;
                plane.kind = PlaneChoice::last;
            } else {
                plane.kind = PlaneChoice::given;
                if (!code_plane(fit, plane)) return false;
                last = plane;
            }
            const std::uint32_t axis = plane.axis, u = axis == 2 ? 0 : axis + 1, v = axis == 0 ? 2 : axis - 1;
            const auto a = static_cast<std::uint32_t>(plane.slope[0]), b = static_cast<std::uint32_t>(plane.slope[1]);
            for (std::uint32_t i = begin; i < end; ++i) {
                residuals_[axis][i] -= quarter(a * residuals_[u][i] + b * residuals_[v][i]);
            }
        }
        return true;
    }

    bool code_plane(const PlaneFit& fit, PlaneChoice& plane) {
        const std::uint32_t likely = fit.axis();
        std::uint32_t turn = (plane.axis + 3U - likely) % 3U;  // axis relative to the likely axis
        turn = coder_.bit(axis_[0], turn != 0 ? 1 : 0) == 0 ? 0 : 1 + coder_.bit(axis_[1], turn / 2);
        plane.axis = static_cast<std::uint8_t>((likely + turn) % 3);
        const std::array<std::int8_t, 2> nearest = fit.slopes(plane.axis);
        for (std::uint32_t k = 0; k < 2; ++k) {
            const std::uint32_t at = static_cast<std::uint32_t>(plane.slope[k] - nearest[k]) & 7;
            const std::uint32_t difference = coder_.bit(exact_slope_[k], at != 0 ? 1 : 0) == 0 ? 0 : coder_.raw(at, 3);
            plane.slope[k] = static_cast<std::int8_t>(
                static_cast<std::int32_t>((static_cast<std::uint32_t>(nearest[k] + 4) + difference) & 7) - 4);
        }
        return true;
    }

    /// The context of a run's width: the sizes of its residuals and of the next run's, relative to the previous width.
    static std::uint32_t context(std::uint64_t sum, std::uint64_t next, std::uint32_t width, std::uint32_t size) {
        if (sum == 0) return 0;
        // The mean residual divided by 2^width, in eighths.
        const auto rest = [&](std::uint64_t of) {
            return static_cast<std::uint32_t>(std::min<std::uint64_t>((of >> width) * 2 >> size, 32));
        };
        const std::uint32_t then = rest(next);
        return 1 + kLevels[rest(sum)] * 3U + (then > 15 ? 2 : then > 5 ? 1 : 0);
    }
    static constexpr std::array<std::uint8_t, 33> kLevels{0,  0,  0,  1,  1,  2,  3,  4,  5,  5,  6,
                                                          6,  7,  7,  8,  8,  9,  9,  10, 10, 11, 11,
                                                          11, 11, 12, 12, 12, 12, 12, 12, 12, 12, 13};

    /// Computes the sum of each component's folded residuals per run; a 0 follows the last run.
    void find_sums(std::uint32_t count, std::uint32_t length) {
        for (std::uint32_t c = 0; c < n_; ++c) {
            std::uint32_t run = 0;
            for (std::uint32_t begin = 0; begin + 1 < count; begin += length, ++run) {
                const std::uint32_t end = std::min(count - 1, begin + length);
                std::uint64_t sum = 0;
                for (std::uint32_t i = begin; i < end; ++i) sum += fold(residuals_[c][i]);
                sums_[c][run] = sum;
            }
            sums_[c][run] = 0;
        }
    }

    bool code_runs(std::uint32_t count, BlockChoices& choices) {
        const std::uint32_t length = 4U << choices.size;
        std::array<std::uint32_t, kMostComponents> width;
        for (std::uint32_t c = 0; c < n_; ++c) width[c] = components_[c].width;
        find_sums(count, length);
        for (std::uint32_t begin = 0, run = 0; begin + 1 < count; begin += length, ++run) {
            const std::uint32_t end = std::min(count - 1, begin + length);
            if (n_ == 3 && begin % kPlaneRun == 0) write_plane(choices.planes[begin / kPlaneRun]);
            std::uint32_t present = 0;  // bit c: component c is not all zero
            for (std::uint32_t c = 0; c < n_; ++c) {
                const std::uint64_t sum = sums_[c][run];
                BlockChoices::Width& w = choices.widths[c][run];
                if (!code_width(models_[choices.size][context(sum, sums_[c][run + 1], width[c], choices.size)], w,
                                width[c]))
                    return false;
                if (w.code == kAllZero && sum != 0) return false;
                if (w.code != kAllZero) present |= 1U << c;
                constexpr std::uint8_t kCodes[][2] = {{0, 1}, {1, 2}, {3, 3}, {7, 4}, {15, 4}};  // code, number of bits
                out_.put(kCodes[w.code][0], kCodes[w.code][1]);
                if (w.code == kGiven) out_.put(w.value, 5);
            }
            if (!write_residuals(begin, end, present, width)) return false;
        }
        return true;
    }

    using WidthModels = std::array<BitModel, 4>;

    /// Codes the choice of a run's width, and sets `width` to that width. Returns false if the choice is invalid.
    bool code_width(WidthModels& models, BlockChoices::Width& w, std::uint32_t& width) {
        std::uint32_t code = 0;
        if (coder_.bit(models[0], w.code != kUnchanged ? 1 : 0) != 0) {
            code = 1;
            while (code < kGiven && coder_.bit(models[code], w.code != code ? 1 : 0) != 0) ++code;
        }
        w.code = static_cast<std::uint8_t>(code);
        if (code == kGiven) {
            w.value = static_cast<std::uint8_t>(coder_.raw(w.value, 5));
            width = w.value;
        }
        if (code == kOneMore && ++width > 31) return false;
        if (code == kOneLess && width-- == 0) return false;
        return true;
    }

    void write_plane(const PlaneChoice& plane) {
        if (plane.kind == PlaneChoice::none) {
            out_.put(0, 1);
        } else if (plane.kind == PlaneChoice::last) {
            out_.put(1, 2);
        } else {
            const auto a = static_cast<std::uint32_t>(plane.slope[0] + 4),
                       b = static_cast<std::uint32_t>(plane.slope[1] + 4);
            out_.put(3U | static_cast<std::uint32_t>(plane.axis) << 2 | a << 4 | b << 7, 10);
        }
    }

    bool write_residuals(std::uint32_t begin, std::uint32_t end, std::uint32_t present,
                         const std::array<std::uint32_t, kMostComponents>& width) {
        for (std::uint32_t i = begin; i < end; ++i) {
            for (std::uint32_t c = 0; c < n_; ++c) {
                if ((present >> c & 1) != 0) out_.put(fold(residuals_[c][i]) & ((1U << width[c]) - 1), width[c]);
            }
        }
        for (std::uint32_t i = begin; i < end; ++i) {
            for (std::uint32_t c = 0; c < n_; ++c) {
                if ((present >> c & 1) == 0) continue;
                const std::uint32_t zeros = fold(residuals_[c][i]) >> width[c];
                if (zeros > kMostZeros) return false;
                out_.put(1U << zeros, zeros + 1);
            }
        }
        return true;
    }

    Coder& coder_;
    std::span<const VertexComponent> components_;
    std::uint32_t n_;
    BlockBits& out_;
    std::array<Residuals, kMostComponents> residuals_;
    std::array<std::array<std::uint64_t, kVertexBlock / 4 + 1>, kMostComponents> sums_;
    std::array<BitModel, 3> own_predictor_, size_;
    SymbolModel predictor_low_, predictor_high_;
    std::array<std::array<BitModel, 8>, 16> has_plane_;
    std::array<std::array<BitModel, 16>, 16> given_;
    std::array<BitModel, 2> axis_, exact_slope_;
    std::array<std::array<WidthModels, 43>, 4> models_;  // per size of runs and context
};

}  // namespace lacedring::storage
