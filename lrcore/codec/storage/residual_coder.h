#pragma once
// Codes the residuals of vertices, vertex by vertex. It does not depend on predictions, so a reader can decode all
// residuals before it knows the triangles. Internal to lrcore. Specified in docs/storage-format.md.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lrcore/codec/storage/rans.h"

namespace lacedring::storage {

/// `N` is the number of integers per vertex, or 0 for any number.
template <class Coder, std::uint32_t N>
class ResidualCoder {
  public:
    /// `fine`: VertexParameters::fine.
    ResidualCoder(Coder& coder, std::uint32_t integers, std::uint32_t fine)
        : coder_(coder), integers_(integers), fine_(fine), roles_(integers) {}

    /// Codes the folded residuals of whole vertices; a Decoder sets them.
    void code(std::span<std::uint32_t> residuals) {
        const std::uint32_t n = N != 0 ? N : integers_;
        Coder coder = std::move(coder_);  // local, to keep it in registers
        for (std::size_t i = 0; i < residuals.size(); i += n) {
            std::uint32_t* at = residuals.data() + i;
            std::uint32_t before = 0, second = 0;  // levels of the previous integers of the vertex
            for (std::uint32_t c = 0; c < n; ++c) {
                Role& role = roles_[c];
                const std::uint32_t level = c == 0             ? role.level
                                            : c == 2 && n == 3 ? (10 * role.level + 3 * (before + second)) / 16
                                                               : (role.level + before) / 2;
                second = before;
                at[c] = code(coder, role, level / 64, at[c], before);
            }
        }
        coder_ = std::move(coder);
    }

  private:
    static constexpr std::uint32_t kSteps = 32, kEscape = 15;
    static constexpr std::array<std::uint16_t, 16> kBegin{0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 64, 128, 256, 512, 1024};
    static constexpr std::array<std::uint8_t, 16> kBits{0, 0, 0, 0, 1, 1, 2, 2, 3, 3, 5, 6, 7, 8, 9, 0};
    /// Mean size of a symbol's numbers, in 128ths of a bit, plus 128.
    static constexpr std::array<std::uint16_t, 16> kLevel{0,   256, 352, 400, 464,  512,  576,  640,
                                                          704, 768, 864, 992, 1120, 1248, 1376, 0};

    /// The models of one component: one per expected size, in steps of half a bit.
    struct Role {
        std::uint32_t level = 0;  ///< mean size of recent residuals, in 128ths of a bit
        std::array<SymbolModel, kSteps> models;
        NumberModel others;  ///< numbers beyond the ranges of symbols
    };

    /// Codes one residual. Its lowest bits are raw. A symbol codes the rest: a number up to 3, or a range of numbers;
    /// the offset in the range is raw. Sets `level` to the residual's size.
    LACEDRING_INLINE std::uint32_t code(Coder& coder, Role& role, std::uint32_t step, std::uint32_t value,
                                        std::uint32_t& level) {
        step = std::min(step, kSteps - 1);
        const std::uint32_t low = step > fine_ ? (step - fine_ + 1) / 2 : 0;
        const std::uint32_t symbol = coder.symbol(role.models[step], symbol_of(value >> low));
        if (symbol == kEscape) {
            level = role.level;
            coder_ = std::move(coder);
            const std::uint32_t escaped = role.others.code(coder_, value);
            coder = std::move(coder_);
            return escaped;
        }
        const std::uint32_t from = static_cast<std::uint32_t>(kBegin[symbol]) << low;
        level = std::max(kLevel[symbol] + 128 * low, 128U) - 128;
        role.level += static_cast<std::uint32_t>(static_cast<std::int32_t>(level - role.level) * 3 >> 4);
        return from + coder.raw(value - from, kBits[symbol] + low);
    }

    static std::uint32_t symbol_of(std::uint32_t value) {
        if constexpr (Coder::kDecodes) return 0;
        std::uint32_t symbol = kEscape;
        while (kBegin[symbol] > value) --symbol;
        return symbol;
    }

    Coder& coder_;
    std::uint32_t integers_, fine_;
    std::vector<Role> roles_;
};

/// Calls run.operator()<N>() with N = `count`, or 0 if `count` is above 3, so that loops over few components are
/// unrolled.
template <class Run>
void with_count(std::uint32_t count, const Run& run) {
    switch (count) {
        case 1:
            return run.template operator()<1>();
        case 2:
            return run.template operator()<2>();
        case 3:
            return run.template operator()<3>();
        default:
            return run.template operator()<0>();
    }
}

/// Codes the residuals of all vertices, `integers` per vertex.
template <class Coder>
void code_residuals(Coder& coder, std::uint32_t integers, std::uint32_t fine, std::span<std::uint32_t> residuals) {
    with_count(integers, [&]<std::uint32_t N>() { ResidualCoder<Coder, N>(coder, integers, fine).code(residuals); });
}

}  // namespace lacedring::storage
