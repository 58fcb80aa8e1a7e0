#pragma once
// The layout of a vertex stream around its blocks: header, components, exceptions, table (docs/vertex-format.md).
// Internal to lrcore.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/vertices.hpp"

namespace lacedring {

constexpr std::uint32_t kVertexGroup = 16;      ///< blocks per group of the table
constexpr std::uint32_t kVertexPlaneRun = 16;   ///< minimum number of vertices with a common plane
constexpr std::uint32_t kVertexMostZeros = 24;  ///< most zeros of a unary number

/// A component's parameters for the whole stream: values are relative to `low`; first_bits is the size of a block's
/// first value; width and predictor are the initial ones of a block that gives no others.
struct VertexComponent {
    std::uint32_t low = 0, first_bits = 0, width = 0, predictor = 0;
};

/// Sets low and first_bits of each component; low is the smallest value. Without values both are 0. Cost: O(values).
void find_vertex_ranges(std::span<const std::uint32_t> values, VertexMapping mapping,
                        std::span<VertexComponent> components);

struct VertexStreamParts {
    std::uint32_t vertices = 0;
    std::uint32_t layout = 0, parameter = 0, largest_error = 0;  ///< header words 2, 4 and 5
    std::span<const VertexComponent> components;
    std::span<const std::uint32_t> exceptions;  ///< two words each
    /// First bit of each block; a group's first block begins at a word.
    std::span<const std::uint64_t> begins;
    std::span<const std::uint32_t> data;  ///< the blocks

    std::uint32_t field_bits() const { return layout >> 18 & 31; }
    /// Words of the stream.
    std::uint64_t size() const;
};

/// Assembles the stream, including its checksum. Distances in the table must fit in field_bits() bits; the data has at
/// most 2^32 words.
std::vector<std::uint32_t> make_vertex_stream(const VertexStreamParts& parts);

}  // namespace lacedring
