// Builds the bit-efficient LR tables: LR 2011, section 6.

#include "lacedring/lacedring.hpp"

namespace lacedring {
namespace {

class Packer {
  public:
    explicit Packer(const LrView& lr) : lr_(lr) {}

    Result<CompactLrTable> pack() {
        for (out_.unit = 2;; out_.unit *= 2) {  // almost always once
            if (pack_all()) return std::move(out_);
            if (out_.unit >= 8) return Error{ErrorCode::too_large, "VO* outgrows its index"};
        }
    }

  private:
    bool pack_all() {
        out_.vertices = lr_.vertices;
        out_.ring_vertices = lr_.ring_vertices;
        out_.lr.clear();
        out_.star.clear();
        out_.irregular = out_.long_tips = 0;
        out_.lr.reserve(lr_.ring_vertices);
        for (std::uint32_t v = 0; v < lr_.ring_vertices; ++v) {
            const std::uint32_t left = lr_.lr[2 * v], right = lr_.lr[2 * v + 1];
            std::uint32_t a = 0, b = 0;
            // Two warts at one edge would make the T2 beside each the same triangle; only triangle soups may have this.
            if (short_form(v, 0, a) && short_form(v, 1, b) && (a & b & 0x8000) == 0) {
                out_.lr.push_back(a << 16 | b);
                continue;
            }
            while (out_.star.size() % out_.unit != 0) out_.star.push_back(0);
            const std::size_t index = out_.star.size() / out_.unit;
            if (index >> compact::kIndexBits != 0) return false;
            const auto low = static_cast<std::uint32_t>(index);
            std::uint32_t w = compact::kLong | (low >> 15) << 16 | (low & 0x7fff);
            out_.star.push_back(entry(v, 0));
            out_.star.push_back(entry(v, 1));
            for (std::uint32_t side = 0; side < 2; ++side) {
                const std::uint32_t from = side == 0 ? left : right;
                const std::uint32_t kind = from & word::kKind;
                if ((kind & (word::kSpecial | word::kWart)) == word::kWart) {
                    w |= side == 0 ? compact::kLongLeftWart : compact::kLongRightWart;
                }
                if ((kind & (word::kSpecial | word::kIrregular)) != word::kIrregular) {
                    ++out_.long_tips;
                    continue;
                }
                w |= side == 0 ? compact::kLongLeftIrregular : compact::kLongRightIrregular;
                ++out_.irregular;
                for (std::uint32_t end = 0; end < 2; ++end) out_.star.push_back(lr_.star_opposite(v, side, end));
            }
            out_.lr.push_back(w);
        }
        out_.vo.assign(lr_.vo.begin(), lr_.vo.end());
        out_.c.assign(lr_.c.begin(), lr_.c.end());
        return true;
    }

    /// Sets `half` to the slot in 16 bits; returns false if it does not fit.
    bool short_form(std::uint32_t v, std::uint32_t side, std::uint32_t& half) const {
        const std::uint32_t w = lr_.lr[2 * v + side], kind = w & word::kKind;
        if (kind == word::kBorder) {
            half = 0;
            return true;
        }
        if (kind == word::kClosing || ((w & word::kSpecial) == 0 && (w & (word::kFlip | word::kIrregular)) != 0))
            return false;
        const std::uint32_t tip = w & word::kTip;
        if (tip >= lr_.ring_vertices) return false;
        const std::int64_t ring = lr_.ring_vertices;
        std::int64_t offset = std::int64_t{tip} - v;
        if (offset > ring / 2) offset -= ring;
        if (offset < -(ring / 2)) offset += ring;
        if (offset < -(1 << 14) || offset >= 1 << 14) return false;
        if (kind == word::kRedundant ? offset != 2 : kind == 0 && (offset == 0 || offset == 2)) return false;
        half = static_cast<std::uint32_t>(offset) & 0x7fff;
        if (kind == word::kWart) half |= 0x8000;
        return true;
    }

    /// The slot as a word of the standard representation, always with its tip.
    std::uint32_t entry(std::uint32_t v, std::uint32_t side) const {
        const std::uint32_t w = lr_.lr[2 * v + side];
        if ((w & (word::kSpecial | word::kIrregular)) != word::kIrregular) return w;
        return (w & ~word::kTip) | lr_.tip(v, side);
    }

    const LrView& lr_;
    CompactLrTable out_;
};

}  // namespace

Result<CompactLrTable> build_compact_lr(const LrView& lr) {
    return Packer(lr).pack();
}

}  // namespace lacedring
