#pragma once
// The entropy coder of stored seams: binary arithmetic coding over adaptive bits. Unlike rans.h, it stores no states
// and no count, since seam sections have few words. Internal to lrcore.
//
// BitEncoder and BitDecoder have the same functions, like Encoder and Decoder of rans.h.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lrcore/base/compiler.h"
#include "lrcore/codec/storage/rans.h"

namespace lacedring::storage {

/// The interval of arithmetic coding: `low` to `high`. Between two bits, the upper words of both differ.
struct BitInterval {
    std::uint64_t low = 0, high = UINT64_MAX;

    /// The last number of the part of a 0, which is zero / kScale of the interval.
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
    /// The last word an encoder writes; readers take all words after it as 0.
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
    /// Codes the lowest `count` bits, the highest of these first.
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

/// Safe with any words. Values read beyond the end are meaningless; bad() reports this.
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

    /// Was more than one word beyond the end read? The first of them is legal and reads as 0.
    bool bad() const { return at_ > words_.size() + 1; }
    /// Were all words used, and do they end as an encoder ends them?
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
