#pragma once
// The answers to a seam decoder's questions, and the table that converts answers to bits (docs/seams-format.md).
// Internal to codec/seams.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/lacedring_seams.h"

namespace lacedring {

constexpr std::uint32_t kSeamContexts = LACEDRING_SEAM_CONTEXTS;

/// An answer: a flag, coded by the likely value and the class of its context, or raw bits.
struct SeamAnswer {
    std::uint32_t value;
    std::uint8_t context;  ///< kSeamContexts if the answer is raw bits
    std::uint8_t bits;
};

/// The answers of all blocks in sequence.
struct SeamAnswers {
    std::vector<SeamAnswer> all;
    std::vector<std::size_t> begin;     ///< first answer of each block
    std::vector<std::uint32_t> copies;  ///< number of copies each block makes

    bool flag(std::uint32_t context, bool value) {
        all.push_back({value ? 1U : 0U, static_cast<std::uint8_t>(context), 1});
        return value;
    }
    void bits(std::uint32_t value, std::uint32_t count) {
        if (count > 0) all.push_back({value, kSeamContexts, static_cast<std::uint8_t>(count)});
    }
    void golomb(std::uint32_t value, std::uint32_t order) {
        const std::uint32_t x = value + (1U << order);
        const auto width = static_cast<std::uint32_t>(std::bit_width(x)) - 1;
        const std::uint32_t ones = width - order;
        bits((1U << ones) - 1, ones + 1);
        bits(x & ((1U << width) - 1), width);
    }
    std::span<const SeamAnswer> block(std::size_t b) const {
        return std::span(all).subspan(begin[b], (b + 1 < begin.size() ? begin[b + 1] : all.size()) - begin[b]);
    }
};

/// The likely value of each context, and the class of its runs.
struct SeamTable {
    std::array<std::uint8_t, kSeamContexts> likely{}, run_class{};
};

/// The table with the smallest blocks, as measured on all or sampled blocks.
SeamTable best_table(const SeamAnswers& vertices, const SeamAnswers& corners);

/// The section's words; empty if it would be too large.
std::vector<std::uint32_t> write_section(std::uint32_t homes, const SeamAnswers& vertices, const SeamAnswers& corners,
                                         const SeamTable& table);

}  // namespace lacedring
