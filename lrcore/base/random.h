#pragma once
// Pseudo-random numbers: the same seed gives the same numbers on every platform.

#include <cstdint>

namespace lacedring::detail {

/// The finalizer of SplitMix64 (Steele, Lea, Flood 2014): a good hash of one word.
constexpr std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
}

/// SplitMix64. Not <random>: its distributions differ between standard libraries.
class SplitMix64 {
  public:
    explicit SplitMix64(std::uint64_t seed) : state_(seed) {}

    std::uint64_t next() { return mix(state_ += 0x9e3779b97f4a7c15U); }
    /// In [0, n), n in [1, 2^32]. The bias of at most n / 2^32 does not matter here.
    std::uint32_t below(std::uint64_t n) { return static_cast<std::uint32_t>(((next() >> 32U) * n) >> 32U); }

  private:
    std::uint64_t state_;
};

}  // namespace lacedring::detail
