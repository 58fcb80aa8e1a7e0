#pragma once
// Compiler extensions, each with a plain fallback. LACEDRING_PLAIN chooses the fallbacks (scripts/portability plain).

#include <cstdint>

// Inlined whatever its size: for the few functions whose calls would cost more than they do.
#if (defined(__GNUC__) || defined(__clang__)) && !defined(LACEDRING_PLAIN)
#define LACEDRING_INLINE inline __attribute__((always_inline))
#else
#define LACEDRING_INLINE inline
#endif

namespace lacedring::detail {

#if (defined(__GNUC__) || defined(__clang__)) && !defined(LACEDRING_PLAIN)
/// A hint that the object will be read soon.
inline void prefetch(const void* object) {
    __builtin_prefetch(object);
}

/// Four words that are added and masked at once.
using Lanes = std::uint32_t __attribute__((vector_size(16)));
#else
inline void prefetch(const void*) {}

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
