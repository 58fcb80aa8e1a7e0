#pragma once
// Converts the values of an attribute to the integers of a vertex stream.

#include <cstdint>
#include <optional>
#include <vector>

#include "lacedring/vertices.hpp"

namespace lacedring {

struct VertexIntegers {
    std::vector<std::uint32_t> values;  // `components` per vertex
    std::uint32_t components = 0;
    VertexMapping mapping = VertexMapping::integers;
    std::uint32_t bits = 0;                 // octahedral only
    float step = 0;                         // lattice only
    std::uint32_t digits = 0;               // decimals only
    std::vector<std::uint32_t> exceptions;  // decimals only: two words each, as in the stream
    double largest_error = 0;
};

/// Cost: O(V). Errors: those of encode_vertices.
Result<VertexIntegers> to_integers(const VertexValues& values, const VertexOptions& options);

/// Converts floats to decimals, with the number of digits that is estimated to give the smallest stream; none if too
/// many values are not decimals. `values` must be accepted by to_integers. Cost: O(V).
std::optional<VertexIntegers> to_decimals(const VertexValues& values);

}  // namespace lacedring
