#pragma once
// Writes bit fields into bytes, lowest bit first.

#include <bit>
#include <cstdint>
#include <vector>

namespace lacedring {

class BitWriter {
  public:
    /// Writes the lowest `count` (at most 32) bits of `value`.
    void put(std::uint32_t value, std::uint32_t count) {
        if (count == 0) return;
        window_ |= static_cast<std::uint64_t>(value & (UINT32_MAX >> (32 - count))) << fill_;
        fill_ += count;
        bits_ += count;
        for (; fill_ >= 8; fill_ -= 8, window_ >>= 8) bytes_.push_back(static_cast<std::uint8_t>(window_));
    }
    /// Unary code of `ones`: that many ones and a zero.
    void put_unary(std::uint32_t ones) {
        for (; ones >= 16; ones -= 16) put(0xffff, 16);
        put((1U << ones) - 1, ones + 1);
    }
    /// Golomb-Rice code: value >> low in unary, then the low bits.
    void put_rice(std::uint32_t value, std::uint32_t low) {
        put_unary(value >> low);
        put(value, low);
    }
    /// Exponential Golomb code.
    void put_golomb(std::uint32_t value, std::uint32_t order) {
        const std::uint32_t x = value + (1U << order);
        const auto width = static_cast<std::uint32_t>(std::bit_width(x));
        put_unary(width - 1 - order);
        put(x, width - 1);
    }
    static std::uint32_t golomb_bits(std::uint32_t value, std::uint32_t order) {
        return 2 * static_cast<std::uint32_t>(std::bit_width(value + (1U << order))) - 1 - order;
    }

    std::size_t bits() const { return bits_; }
    /// All bytes; pads the last byte with ones.
    std::vector<std::uint8_t>& finish() {
        if (fill_ > 0) put(0xff, 8 - fill_);
        return bytes_;
    }
    void clear() {
        bytes_.clear();
        window_ = 0;
        fill_ = 0;
        bits_ = 0;
    }

  private:
    std::vector<std::uint8_t> bytes_;
    std::uint64_t window_ = 0;
    std::uint32_t fill_ = 0;
    std::size_t bits_ = 0;
};

}  // namespace lacedring
