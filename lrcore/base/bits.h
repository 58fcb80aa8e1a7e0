#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lacedring {

/// One bit per element, 64 per word.
class BitVector {
  public:
    explicit BitVector(std::size_t size) : words_((size + 63) / 64, 0) {}

    bool empty() const { return words_.empty(); }
    bool test(std::size_t i) const { return (words_[i / 64] >> (i % 64) & 1) != 0; }
    void set(std::size_t i) { words_[i / 64] |= std::uint64_t{1} << (i % 64); }
    void clear(std::size_t i) { words_[i / 64] &= ~(std::uint64_t{1} << (i % 64)); }

  private:
    std::vector<std::uint64_t> words_;
};

}  // namespace lacedring
