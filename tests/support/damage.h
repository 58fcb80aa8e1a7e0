#pragma once
// Makes damaged copies of valid words or bytes. A failing check prints the damage. Cut copies have exactly their size
// in memory, so that a sanitizer reports reads past the end.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "lrcore/base/random.h"
#include "tests/support/exact_copy.h"

namespace lacedring::test {

/// Calls use(span) with every proper prefix of `good`.
template <class T, class Use>
void for_each_cut(const std::vector<T>& good, Use use) {
    for (std::size_t size = 0; size < good.size(); ++size) {
        INFO("cut to ", size);
        const auto exact = exact_copy(std::span(good).first(size));
        use(std::span<const T>(exact.get(), size));
    }
}

/// Calls use(changed, bit) with one bit of `good` flipped: each bit, or `bits_of_each` bits of each element.
template <class T, class Use>
void for_each_flip(const std::vector<T>& good, Use use, std::size_t bits_of_each = 8 * sizeof(T)) {
    constexpr std::size_t kWidth = 8 * sizeof(T);
    std::vector<T> bad = good;
    for (std::size_t i = 0; i < good.size(); ++i) {
        for (std::size_t k = 0; k < bits_of_each; ++k) {
            const std::size_t bit = (i + k) % kWidth;
            INFO("bit ", bit, " of ", i);
            bad[i] ^= static_cast<T>(std::uint64_t{1} << bit);
            use(bad, kWidth * i + bit);
            bad = good;
        }
    }
}

/// A word randomly damaged: one bit flipped (half of the time), its four flag bits with a small number, all ones, or
/// random.
inline std::uint32_t damaged_word(std::uint32_t word, detail::SplitMix64& random) {
    switch (random.below(4)) {
        case 0:
            return (word & 0xf0000000U) | random.below(100);
        case 1:
            return random.below(2) == 0 ? UINT32_MAX : static_cast<std::uint32_t>(random.next());
        default:
            return word ^ 1U << random.below(32);
    }
}

/// The words that get half of the damage.
struct Likely {
    std::size_t begin, size;
};

/// Calls use(changed, random) `trials` times with one to three words of `good` damaged; `changed` always differs from
/// it.
template <class Use>
void for_each_damage(const std::vector<std::uint32_t>& good, std::uint64_t seed, std::uint32_t trials, Use use,
                     Likely likely = {0, 0}) {
    INFO("seed ", seed);
    detail::SplitMix64 random(seed);
    for (std::uint32_t trial = 0; trial < trials; ++trial) {
        INFO("trial ", trial);
        std::vector<std::uint32_t> bad = good;
        for (std::uint32_t k = 0, changes = 1 + random.below(3); k < changes || bad == good; ++k) {
            const bool near = likely.size > 0 && random.below(2) == 0;
            const std::size_t at = near ? likely.begin + random.below(likely.size) : random.below(good.size());
            std::uint32_t& word = bad[std::min(at, good.size() - 1)];
            word = damaged_word(word, random);
        }
        use(bad, random);
    }
}

}  // namespace lacedring::test
