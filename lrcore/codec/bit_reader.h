#pragma once
// Bits of a valid stream, the first one lowest, as BitWriter writes them. Decoders that have to be fast, or read bytes
// that nobody vouches for, are in C (include/lacedring); this is for encoders that read a stream again.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lacedring {

class BitReader {
  public:
    /// Bits [at, end) of the words; behind them come ones.
    BitReader(std::span<const std::uint32_t> words, std::uint64_t at, std::uint64_t end)
        : words_(words), at_(at), end_(end) {}

    /// A number of `count` bits, at most 32.
    std::uint32_t take(std::uint32_t count) {
        std::uint32_t out = 0;
        for (std::uint32_t done = 0; done < count;) {
            if (at_ >= end_) return out | (UINT32_MAX >> (32 - count) & UINT32_MAX << done);
            const auto in_word = static_cast<std::uint32_t>(at_ % 32);
            const auto some =
                static_cast<std::uint32_t>(std::min<std::uint64_t>({count - done, 32 - in_word, end_ - at_}));
            const std::uint64_t bits = words_[static_cast<std::size_t>(at_ / 32)] >> in_word;
            out |= static_cast<std::uint32_t>(bits & ((std::uint64_t{1} << some) - 1)) << done;
            done += some;
            at_ += some;
        }
        return out;
    }
    /// How many ones come before a zero, at most `limit`: where there are as many, no zero is read.
    std::uint32_t unary(std::uint32_t limit) {
        std::uint32_t ones = 0;
        while (ones < limit && take(1) != 0) ++ones;
        return ones;
    }
    std::uint32_t golomb(std::uint32_t order) {
        const std::uint32_t low = unary(31 - order) + order;
        return (take(low) | 1U << low) - (1U << order);
    }
    /// UINT32_MAX: more ones than a number has.
    std::uint32_t rice(std::uint32_t low) {
        const std::uint32_t ones = unary(32);
        return ones == 32 ? UINT32_MAX : (ones << low) + take(low);
    }
    void skip(std::uint64_t bits) { at_ += bits; }
    void align_to_word() { at_ = (at_ + 31) / 32 * 32; }

    std::uint64_t at() const { return at_; }
    bool is_at_end() const { return at_ >= end_; }

  private:
    std::span<const std::uint32_t> words_;
    std::uint64_t at_, end_;
};

}  // namespace lacedring
