#pragma once
// Damaged copies of words or bytes that are valid, for tests of who reads them. Each says what was done to it where a
// check fails, and lies in memory of exactly its size, so that a sanitizer sees who reads on behind its end.

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

/// Calls use(span) with the first 0, 1, 2, ... of `good`, never all of them.
template <class T, class Use>
void for_each_cut(const std::vector<T>& good, Use use) {
    for (std::size_t size = 0; size < good.size(); ++size) {
        INFO("cut to ", size);
        const auto exact = exact_copy(std::span(good).first(size));
        use(std::span<const T>(exact.get(), size));
    }
}

/// Calls use(changed, bit) with one bit of `good` flipped: every bit, or so many of each element.
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

/// A word after some chance: mostly one bit flipped, else its flags with a small number, or any.
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

/// Where damage is most telling: half of it goes there.
struct Likely {
    std::size_t begin, size;
};

/// Calls use(changed, random) `trials` times with one to three words of `good` damaged. Never with `good` itself.
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
