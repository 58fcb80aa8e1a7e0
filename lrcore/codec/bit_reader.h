#pragma once
// Reads bit fields of a valid stream, lowest bit first, as BitWriter writes them. Only for encoders that read a stream
// back: decoders that must be fast or safe with untrusted bytes are in C (include/lacedring).

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lacedring {

class BitReader {
  public:
    /// Reads bits [at, end) of the words; bits beyond `end` read as ones.
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
    /// Number of ones before a zero, at most `limit`. After `limit` ones, no zero is read.
    std::uint32_t unary(std::uint32_t limit) {
        std::uint32_t ones = 0;
        while (ones < limit && take(1) != 0) ++ones;
        return ones;
    }
    std::uint32_t golomb(std::uint32_t order) {
        const std::uint32_t low = unary(31 - order) + order;
        return (take(low) | 1U << low) - (1U << order);
    }
    /// Returns UINT32_MAX if there are 32 ones or more.
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
