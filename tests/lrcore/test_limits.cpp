// Sizes at which 32-bit arithmetic would overflow are refused or computed in 64 bits.

#include <doctest/doctest.h>
#include <sys/mman.h>

#include "lacedring/lacedring.hpp"
#include "lacedring/streams.hpp"
#include "lrlab/rivals/squad.h"

using namespace lacedring;

namespace {

/// Zeroed memory that is not resident until written.
class Sparse {
  public:
    explicit Sparse(std::size_t words) : size_(words * sizeof(std::uint32_t)) {
        void* const at =
            mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        if (at != MAP_FAILED) words_ = {static_cast<std::uint32_t*>(at), words};
    }
    Sparse(const Sparse&) = delete;
    Sparse& operator=(const Sparse&) = delete;
    ~Sparse() {
        if (!words_.empty()) munmap(words_.data(), size_);
    }
    std::span<std::uint32_t> words() const { return words_; }

  private:
    std::size_t size_;
    std::span<std::uint32_t> words_;
};

CornerTable empty_table(std::uint32_t vertices) {
    CornerTable table;
    table.vertex_count = vertices;
    return table;
}

const Rings kNoRings{{}, {0}};

template <class T>
void check_too_large(const Result<T>& result) {
    REQUIRE_FALSE(result);
    CHECK(result.error().code == ErrorCode::too_large);
    CHECK(result.error().message.find('\n') == std::string::npos);
}

}  // namespace

TEST_CASE("encoders refuse more vertices than their format can number") {
    check_too_large(encode_lean(empty_table((1U << 29) + 1), kNoRings));
    check_too_large(encode_packed(empty_table((1U << 29) + 1), kNoRings));
    check_too_large(encode_packed(empty_table((1U << 29) + 1), kNoRings, PackedProfile::cache));
    check_too_large(build_lr(empty_table((1U << 28) - 1), kNoRings));
}

TEST_CASE("a corner table refuses sizes at which split_fans would run out of vertex numbers") {
    const std::uint32_t one = 0;
    // Only the size of the span is read.
    const auto indices = [&](std::size_t count) { return std::span(&one, count); };
    check_too_large(build_corner_table(indices(3), (1U << 29) + 1));
    check_too_large(build_corner_table(indices(std::size_t{UINT32_MAX}), 1));
    check_too_large(build_corner_table(indices(std::size_t{UINT32_MAX} - (1U << 29) + 2), 1U << 29));
}

TEST_CASE("T0 number 900 million, beyond 2^32 words of VO, is read") {
    constexpr std::uint32_t kT0 = 900'000'000;
    const Sparse sparse(std::size_t{6} * (kT0 + 1));
    if (sparse.words().empty()) return;  // not enough address space
    const std::size_t at = std::size_t{6} * kT0;
    for (std::size_t k = 0; k < 6; ++k) sparse.words()[at + k] = static_cast<std::uint32_t>(100 + k);
    LrView standard;
    CompactLrView compact;
    standard.vo = compact.vo = sparse.words();
    for (std::uint32_t k = 0; k < 3; ++k) {
        CHECK(standard.t0_vertex(3 * kT0 + k) == 100 + k);
        CHECK(standard.t0_opposite(3 * kT0 + k) == 103 + k);
        CHECK(compact.t0_vertex(3 * kT0 + k) == 100 + k);
        CHECK(compact.t0_opposite(3 * kT0 + k) == 103 + k);
    }
    CHECK(standard.triangle_numbers() == kT0 + 1);
    CHECK(compact.triangle_numbers() == kT0 + 1);
}
