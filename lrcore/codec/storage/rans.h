#pragma once
// The entropy coder of the storage form: range asymmetric numeral systems (rANS) with adaptive models and two
// alternating states, plus raw bits. Internal to lrcore.
//
// Encoder and Decoder have the same functions, so that each format is one template over the coder. The Encoder's
// functions code and return their argument; the Decoder's ignore it and return the decoded value.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "lrcore/base/compiler.h"

namespace lacedring::storage {

constexpr std::uint32_t kScaleBits = 15, kScale = 1U << kScaleBits;
constexpr std::uint64_t kLeast = std::uint64_t{1} << 31;  ///< lower bound of a state between symbols

/// Adaptive model of a bit: adapts fast at first, then averages over about 50 bits.
struct BitModel {
    std::uint16_t zero = kScale / 2;  ///< probability of 0, times kScale
    std::uint16_t seen = 0;

    void update(std::uint32_t bit) {
        constexpr std::int32_t kSlowest = 48;
        seen = static_cast<std::uint16_t>(std::min<std::int32_t>(seen + 1, kSlowest));
        const std::int32_t target = bit != 0 ? 32 : static_cast<std::int32_t>(kScale) - 32;
        const std::int32_t step = kReciprocals[seen];
        zero = static_cast<std::uint16_t>(zero + (((target - zero) * step) >> 16));
    }

  private:
    /// 65536 / (n + 1.5).
    static constexpr std::array<std::int32_t, 64> kReciprocals = [] {
        std::array<std::int32_t, 64> out{};
        for (std::int32_t n = 0; n < 64; ++n) out[static_cast<std::size_t>(n)] = 131072 / (2 * n + 3);
        return out;
    }();
};

/// Adaptive model of 16 symbols. Updates its frequencies often at first, then every 64 symbols.
struct SymbolModel {
    static constexpr std::uint32_t kSymbols = 16;

    std::array<std::uint16_t, kSymbols + 1> begin;  ///< begin of each symbol's range; kScale at the end
    std::array<std::uint16_t, kSymbols> count;
    std::uint16_t total = kSymbols, left = kFirst, cycle = kFirst;

    SymbolModel() {
        count.fill(1);
        rebuild();
    }

    /// The symbol whose range contains `at`.
    LACEDRING_INLINE std::uint32_t find(std::uint32_t at) const { return detail::count_up_to(begin.data(), at) - 1; }

    void update(std::uint32_t symbol) {
        count[symbol] = static_cast<std::uint16_t>(count[symbol] + kStep);
        total = static_cast<std::uint16_t>(total + kStep);
        if (--left == 0) renew();
    }

  private:
    static constexpr std::uint16_t kFirst = 6, kLongest = 64, kStep = 4, kMost = 2048;

    LACEDRING_NOINLINE void renew() {
        if (total > kMost) {
            total = 0;
            for (std::uint16_t& n : count) {
                n = static_cast<std::uint16_t>((n + 1) / 2);
                total = static_cast<std::uint16_t>(total + n);
            }
        }
        rebuild();
        cycle = static_cast<std::uint16_t>(std::min<std::uint32_t>(cycle + cycle / 2U, kLongest));
        left = cycle;
    }
    void rebuild() {
        const std::uint32_t scale = ((kScale - kSymbols) << 16) / total;
        std::uint32_t sum = 0;
        for (std::uint32_t i = 0; i < kSymbols; ++i) {
            begin[i] = static_cast<std::uint16_t>(i + ((sum * static_cast<std::uint64_t>(scale)) >> 16));
            sum += count[i];
        }
        begin[kSymbols] = kScale;
    }
};

/// Records symbols; finish() writes them, since rANS encodes from the last symbol to the first.
class Encoder {
  public:
    static constexpr bool kDecodes = false;

    std::uint32_t bit(BitModel& model, std::uint32_t value) {
        put(value != 0 ? model.zero : 0U, value != 0 ? kScale - model.zero : model.zero);
        model.update(value);
        return value;
    }
    std::uint32_t symbol(SymbolModel& model, std::uint32_t value) {
        put(model.begin[value], model.begin[value + 1] - model.begin[value]);
        model.update(value);
        return value;
    }
    /// Writes the lowest `count` bits (at most 32) of `value` as raw bits.
    std::uint32_t raw(std::uint32_t value, std::uint32_t count) {
        if (count == 0) return 0;
        value &= UINT32_MAX >> (32 - count);
        window_ |= static_cast<std::uint64_t>(value) << fill_;
        fill_ += count;
        if (fill_ >= 32) {
            raw_.push_back(static_cast<std::uint32_t>(window_));
            window_ >>= 32;
            fill_ -= 32;
        }
        return value;
    }
    bool bad() const { return false; }

    /// Returns the number of words of symbols, these words, and the words of raw bits.
    std::vector<std::uint32_t> finish() {
        if (fill_ > 0) raw_.push_back(static_cast<std::uint32_t>(window_));
        std::array<std::uint64_t, 2> states{kLeast, kLeast};
        std::vector<std::uint32_t> words;  // in reverse order
        for (std::size_t i = symbols_.size(); i-- > 0;) {
            std::uint64_t& x = states[i % 2];
            const std::uint32_t begin = symbols_[i] & 0xffff, size = symbols_[i] >> 16;
            if (x >= (kLeast >> kScaleBits << 32) * size) {
                words.push_back(static_cast<std::uint32_t>(x));
                x >>= 32;
            }
            x = ((x / size) << kScaleBits) + x % size + begin;
        }
        for (std::size_t i = 2; i-- > 0;) {
            words.push_back(static_cast<std::uint32_t>(states[i] >> 32));
            words.push_back(static_cast<std::uint32_t>(states[i]));
        }
        std::vector<std::uint32_t> out{static_cast<std::uint32_t>(words.size())};
        out.insert(out.end(), words.rbegin(), words.rend());
        out.insert(out.end(), raw_.begin(), raw_.end());
        return out;
    }

  private:
    void put(std::uint32_t begin, std::uint32_t size) { symbols_.push_back(begin | size << 16); }

    std::vector<std::uint32_t> symbols_, raw_;
    std::uint64_t window_ = 0;
    std::uint32_t fill_ = 0;
};

/// Safe with any words. Values read beyond the end are meaningless; bad() reports this.
class Decoder {
  public:
    static constexpr bool kDecodes = true;

    explicit Decoder(std::span<const std::uint32_t> words) {
        if (words.empty() || words[0] > words.size() - 1 || words[0] < 4) {
            bad_ = true;
            return;
        }
        at_ = words.data() + 1;
        last_ = words[0] - 1;
        bytes_ = reinterpret_cast<const unsigned char*>(words.data());
        last_byte_ = 4 * words.size() - 8;
        raw_bit_ = 32 * (1 + std::uint64_t{words[0]});
        raw_end_ = 32 * std::uint64_t{words.size()};
        for (std::uint64_t* x : {&now_, &next_}) {
            *x = at_[used_] | static_cast<std::uint64_t>(at_[used_ + 1]) << 32;
            used_ += 2;
        }
    }

    LACEDRING_INLINE std::uint32_t bit(BitModel& model, std::uint32_t /*value*/ = 0) {
        const std::uint32_t at = now_ & (kScale - 1), zero = model.zero;
        const std::uint32_t value = at >= zero ? 1 : 0;
        std::uint64_t x = after(at, value != 0 ? zero : 0, value != 0 ? kScale - zero : zero);
        if (x < kLeast) {  // rare, since a bit model has little information
            x = x << 32 | next_word();
            ++used_;
        }
        go_on(x);
        model.update(value);
        return value;
    }
    LACEDRING_INLINE std::uint32_t symbol(SymbolModel& model, std::uint32_t /*value*/ = 0) {
        const std::uint32_t at = now_ & (kScale - 1), value = model.find(at);
        std::uint64_t x = after(at, model.begin[value], model.begin[value + 1] - model.begin[value]);
        const std::uint64_t takes = x < kLeast ? 1 : 0;  // branchless: hard to predict
        x = x << (32 * takes) | (next_word() & (0 - takes));
        used_ += takes;
        go_on(x);
        model.update(value);
        return value;
    }
    LACEDRING_INLINE std::uint32_t raw(std::uint32_t /*value*/, std::uint32_t count) {
        // Branchless; beyond the end it returns some of the last bits.
        const std::uint64_t byte = std::min(raw_bit_ >> 3, last_byte_);
        std::uint64_t window;
        std::memcpy(&window, bytes_ + byte, sizeof window);
        window >>= std::min<std::uint64_t>(raw_bit_ - 8 * byte, 63);
        raw_bit_ += count;
        return static_cast<std::uint32_t>(window & ((std::uint64_t{1} << count) - 1));
    }

    bool bad() const { return bad_ || raw_bit_ > raw_end_ || used_ > last_ + 1; }
    /// Were all words used, and do both states end at their initial value?
    bool is_at_end() const {
        const auto left = static_cast<std::uint32_t>(raw_end_ - raw_bit_);  // unused bits of the last word
        if (bad() || left >= 32) return false;
        std::uint32_t last = 0;
        if (left > 0) std::memcpy(&last, bytes_ + (raw_end_ / 8 - sizeof last), sizeof last);
        const bool is_clear = left == 0 || last >> (32 - left) == 0;
        return is_clear && used_ == last_ + 1 && now_ == kLeast && next_ == kLeast;
    }

  private:
    LACEDRING_INLINE std::uint64_t after(std::uint32_t at, std::uint32_t begin, std::uint32_t size) const {
        return size * (now_ >> kScaleBits) + at - begin;
    }
    /// Beyond the end it returns the last word again.
    std::uint32_t next_word() const { return at_[std::min(used_, last_)]; }
    LACEDRING_INLINE void go_on(std::uint64_t x) {
        now_ = next_;
        next_ = x;
    }

    static constexpr unsigned char kNothing[8] = {};

    static constexpr std::uint32_t kZero = 0;

    const std::uint32_t* at_ = &kZero;       // words of symbols
    std::uint64_t used_ = 0, last_ = 0;      // words used; index of the last word
    const unsigned char* bytes_ = kNothing;  // bytes of all words
    std::uint64_t last_byte_ = 0;            // last position from which eight bytes can be read
    std::uint64_t raw_bit_ = 0, raw_end_ = 0;
    std::uint64_t now_ = kLeast, next_ = kLeast;
    bool bad_ = false;
};

/// Adaptive model of numbers of any size: a symbol for the number of bits, then the bits below the highest as raw bits.
/// Numbers of 2^15 and more use an escape symbol.
struct NumberModel {
    SymbolModel bits;

    template <class Coder>
    std::uint32_t code(Coder& coder, std::uint32_t value) {
        const auto width = static_cast<std::uint32_t>(std::bit_width(value));
        std::uint32_t bits_of = coder.symbol(bits, std::min(width, 15U));
        if (bits_of == 15) bits_of = 15 + coder.raw(width - 15, 5);
        if (bits_of > 32) return 0;  // decoder only: no encoder writes this
        if (bits_of < 2) return bits_of;
        return 1U << (bits_of - 1) | coder.raw(value, bits_of - 1);
    }
};

/// Maps 0, -1, 1, -2, ... to 0, 1, 2, 3, ...
constexpr std::uint32_t fold(std::uint32_t x) {
    return x << 1 ^ (0U - (x >> 31));
}
constexpr std::uint32_t unfold(std::uint32_t code) {
    return code >> 1 ^ (0U - (code & 1));
}

}  // namespace lacedring::storage
