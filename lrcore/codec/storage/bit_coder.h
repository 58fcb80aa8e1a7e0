#pragma once
// The entropy coder of stored seams: binary arithmetic coding over adaptive bits. Nothing is around its words, as two
// states and a count are around those of rans.h: sections of seams have few words. Internal to lrcore.
//
// BitEncoder and BitDecoder have the same functions, as Encoder and Decoder of rans.h.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lrcore/base/compiler.h"
#include "lrcore/codec/storage/rans.h"

namespace lacedring::storage {

/// The numbers that what was coded so far leaves: `low` to `high`. Their upper words differ between two bits.
struct BitInterval {
    std::uint64_t low = 0, high = UINT64_MAX;

    /// The last number of a 0's part, which is zero / kScale of all.
    std::uint64_t middle(std::uint32_t zero) const { return low + ((high - low) >> kScaleBits) * zero; }
    void take(std::uint64_t middle, bool one) {
        if (one) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    bool is_settled() const { return (low ^ high) >> 32 == 0; }
    void shift() {
        low <<= 32;
        high = high << 32 | UINT32_MAX;
    }
    /// The upper word of the number that ends the words; all behind it are 0.
    std::uint32_t last() const { return static_cast<std::uint32_t>(low >> 32) + 1; }
};

class BitEncoder {
  public:
    static constexpr bool kDecodes = false;

    bool bit(BitModel& model, bool value) {
        put(model.zero, value);
        model.update(value ? 1 : 0);
        return value;
    }
    /// The lowest `count` bits, the highest of them first.
    std::uint32_t raw(std::uint32_t value, std::uint32_t count) {
        for (std::uint32_t i = count; i-- > 0;) put(kScale / 2, (value >> i & 1) != 0);
        return value;
    }
    bool bad() const { return false; }

    std::vector<std::uint32_t> finish() {
        words_.push_back(interval_.last());
        return std::move(words_);
    }

  private:
    void put(std::uint32_t zero, bool value) {
        interval_.take(interval_.middle(zero), value);
        for (; interval_.is_settled(); interval_.shift()) {
            words_.push_back(static_cast<std::uint32_t>(interval_.low >> 32));
        }
    }

    BitInterval interval_;
    std::vector<std::uint32_t> words_;
};

/// Any words: safe. What they say beyond their end is of no use, and bad() then says so.
class BitDecoder {
  public:
    static constexpr bool kDecodes = true;

    explicit BitDecoder(std::span<const std::uint32_t> words) : words_(words) {
        number_ = next();
        number_ = number_ << 32 | next();
    }

    LACEDRING_INLINE bool bit(BitModel& model, bool /*value*/ = false) {
        const bool value = take(model.zero);
        model.update(value ? 1 : 0);
        return value;
    }
    std::uint32_t raw(std::uint32_t /*value*/, std::uint32_t count) {
        std::uint32_t out = 0;
        for (std::uint32_t i = 0; i < count; ++i) out = out << 1 | (take(kScale / 2) ? 1 : 0);
        return out;
    }

    /// The word behind the last one is read, and is 0.
    bool bad() const { return at_ > words_.size() + 1; }
    /// Was all of it used, and does it end as an encoder ends?
    bool is_at_end() const { return at_ == words_.size() + 1 && number_ == std::uint64_t{interval_.last()} << 32; }

  private:
    std::uint32_t next() {
        const std::size_t at = at_++;
        return at < words_.size() ? words_[at] : 0;
    }
    LACEDRING_INLINE bool take(std::uint32_t zero) {
        const std::uint64_t middle = interval_.middle(zero);
        const bool value = number_ > middle;
        interval_.take(middle, value);
        for (; interval_.is_settled(); interval_.shift()) number_ = number_ << 32 | next();
        return value;
    }

    std::span<const std::uint32_t> words_;
    std::size_t at_ = 0;
    BitInterval interval_;
    std::uint64_t number_ = 0;
};

}  // namespace lacedring::storage
