#pragma once
// The layout of a vertex stream around its blocks: header, components, exceptions, table. Internal to lrcore;
// docs/vertex-format.md has it.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/vertices.hpp"

namespace lacedring {

constexpr std::uint32_t kVertexGroup = 16;      ///< blocks of a group of the table
constexpr std::uint32_t kVertexPlaneRun = 16;   ///< vertices with a common plane, at least
constexpr std::uint32_t kVertexMostZeros = 24;  ///< of a unary number

/// What the whole stream says of a component: its values count from `low`; bits of a block's first value; the width and
/// the predictor with which a block begins unless it says others.
struct VertexComponent {
    std::uint32_t low = 0, first_bits = 0, width = 0, predictor = 0;
};

/// Sets low and first_bits of each component: low is the least value. Without values both are 0. Cost: O(values).
void find_vertex_ranges(std::span<const std::uint32_t> values, VertexMapping mapping,
                        std::span<VertexComponent> components);

struct VertexStreamParts {
    std::uint32_t vertices = 0;
    std::uint32_t layout = 0, parameter = 0, largest_error = 0;  ///< words 2, 4 and 5
    std::span<const VertexComponent> components;
    std::span<const std::uint32_t> exceptions;  ///< two words each
    std::span<const std::uint64_t> begins;      ///< of each block: its first bit; of a group's first block, of a word
    std::span<const std::uint32_t> data;        ///< the blocks

    std::uint32_t field_bits() const { return layout >> 18 & 31; }
    /// Words of the stream.
    std::uint64_t size() const;
};

/// The stream, its checksum included. Distances in the table have field_bits() bits; the data has at most 2^32 words.
std::vector<std::uint32_t> make_vertex_stream(const VertexStreamParts& parts);

}  // namespace lacedring
