#pragma once
// The fuzz targets. Each takes any bytes, and decodes, walks and compares whatever the library accepts of them.
// libfuzzer.cpp runs them, guided by coverage.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <span>
#include <vector>

namespace lacedring::fuzz {

using Bytes = std::vector<std::byte>;
using Random = std::minstd_rand;

struct Target {
    const char* name;
    /// Returns whether the input was accepted. Aborts if the library breaks a promise. `bytes` is exactly sized.
    bool (*run)(std::span<const std::byte> bytes);
    /// Changes `bytes` so that checksums, lengths and counts fit again. Null: mutate_bytes alone.
    void (*mutate)(Bytes& bytes, std::size_t max_size, Random& random);
};

std::span<const Target> targets();

/// Mutates `bytes` without knowing what they are (LLVMFuzzerMutate); the result has at most max_size bytes.
void mutate_bytes(Bytes& bytes, std::size_t max_size);

inline std::uint32_t random_below(Random& random, std::size_t n) {
    return std::uniform_int_distribution<std::uint32_t>(0, static_cast<std::uint32_t>(n) - 1)(random);
}

/// Aborts, so that the input is kept.
[[noreturn]] inline void fail(const char* condition, const char* file, int line) {
    std::fprintf(stderr, "%s:%d: broken promise: %s\n", file, line, condition);
    std::abort();
}

}  // namespace lacedring::fuzz

#define REQUIRE(...) ((__VA_ARGS__) ? static_cast<void>(0) : ::lacedring::fuzz::fail(#__VA_ARGS__, __FILE__, __LINE__))
