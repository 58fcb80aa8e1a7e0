#pragma once
// The fuzz targets. Each takes any bytes; if the library accepts them, it decodes, walks and compares the result.
// libfuzzer.cpp runs the targets, guided by coverage.

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
    /// Returns whether the input was accepted. Aborts if the library breaks a promise. `bytes` has exactly its size in
    /// memory.
    bool (*run)(std::span<const std::byte> bytes);
    /// Mutates `bytes` and sets checksums, lengths and counts to valid ones. Null: mutate_bytes is used.
    void (*mutate)(Bytes& bytes, std::size_t max_size, Random& random);
};

std::span<const Target> targets();

/// Mutates `bytes` of any format by LLVMFuzzerMutate, to at most max_size bytes.
void mutate_bytes(Bytes& bytes, std::size_t max_size);

inline std::uint32_t random_below(Random& random, std::size_t n) {
    return std::uniform_int_distribution<std::uint32_t>(0, static_cast<std::uint32_t>(n) - 1)(random);
}

/// Aborts; libFuzzer then keeps the input.
[[noreturn]] inline void fail(const char* condition, const char* file, int line) {
    std::fprintf(stderr, "%s:%d: broken promise: %s\n", file, line, condition);
    std::abort();
}

}  // namespace lacedring::fuzz

#define REQUIRE(...) ((__VA_ARGS__) ? static_cast<void>(0) : ::lacedring::fuzz::fail(#__VA_ARGS__, __FILE__, __LINE__))
