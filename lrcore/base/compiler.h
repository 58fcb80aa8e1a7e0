#pragma once
// Compiler extensions, each with a plain fallback. LACEDRING_PLAIN chooses the fallbacks (scripts/portability plain).

#include <cstdint>
#include <cstring>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

// LACEDRING_INLINE always inlines: for the few functions whose calls cost more than their bodies.
#if (defined(__GNUC__) || defined(__clang__)) && !defined(LACEDRING_PLAIN)
#define LACEDRING_INLINE inline __attribute__((always_inline))
#define LACEDRING_NOINLINE __attribute__((noinline))
#else
#define LACEDRING_INLINE inline
#define LACEDRING_NOINLINE
#endif

namespace lacedring::detail {

#if (defined(__GNUC__) || defined(__clang__)) && !defined(LACEDRING_PLAIN)
/// A hint that the object will be read soon.
inline void prefetch(const void* object) {
    __builtin_prefetch(object);
}

/// Four words for SIMD addition and masking.
using Lanes = std::uint32_t __attribute__((vector_size(16)));

#ifdef __SSE2__
/// Counts the numbers <= `most` among 16 ascending numbers below 2^15. The first number must be <= `most`.
LACEDRING_INLINE std::uint32_t count_up_to(const std::uint16_t* numbers, std::uint32_t most) {
    const __m128i limit = _mm_set1_epi16(static_cast<short>(most));
    const __m128i low = _mm_loadu_si128(reinterpret_cast<const __m128i*>(numbers));
    const __m128i high = _mm_loadu_si128(reinterpret_cast<const __m128i*>(numbers + 8));
    const __m128i above = _mm_packs_epi16(_mm_cmpgt_epi16(low, limit), _mm_cmpgt_epi16(high, limit));
    const auto mask = static_cast<std::uint32_t>(_mm_movemask_epi8(above));
    return static_cast<std::uint32_t>(__builtin_ctz(mask | 0x10000U));
}
#else
LACEDRING_INLINE std::uint32_t count_up_to(const std::uint16_t* numbers, std::uint32_t most) {
    using Shorts = std::int16_t __attribute__((vector_size(16)));
    const auto all = static_cast<std::int16_t>(most);
    const Shorts limit{all, all, all, all, all, all, all, all};
    Shorts low, high;
    std::memcpy(&low, numbers, sizeof low);
    std::memcpy(&high, numbers + 8, sizeof high);
    const Shorts counts = -((low <= limit) + (high <= limit));  // a true comparison is -1
    std::uint64_t halves[2];
    std::memcpy(halves, &counts, sizeof halves);
    return static_cast<std::uint32_t>((halves[0] + halves[1]) * 0x0001000100010001U >> 48);
}
#endif
#else
inline void prefetch(const void*) {}

inline std::uint32_t count_up_to(const std::uint16_t* numbers, std::uint32_t most) {
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < 16; ++i) count += numbers[i] <= most ? 1 : 0;
    return count;
}

struct alignas(16) Lanes {
    std::uint32_t lane[4];

    friend Lanes operator+(const Lanes& x, const Lanes& y) {
        return {{x.lane[0] + y.lane[0], x.lane[1] + y.lane[1], x.lane[2] + y.lane[2], x.lane[3] + y.lane[3]}};
    }
    friend Lanes operator+(const Lanes& x, std::uint32_t y) { return x + Lanes{{y, y, y, y}}; }
    friend Lanes operator&(const Lanes& x, const Lanes& y) {
        return {{x.lane[0] & y.lane[0], x.lane[1] & y.lane[1], x.lane[2] & y.lane[2], x.lane[3] & y.lane[3]}};
    }
};
#endif

}  // namespace lacedring::detail
