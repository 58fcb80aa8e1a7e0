#pragma once
// From the values of an attribute to the integers that a vertex stream codes.

#include <cstdint>
#include <optional>
#include <vector>

#include "lacedring/vertices.hpp"

namespace lacedring {

struct VertexIntegers {
    std::vector<std::uint32_t> values;  // `components` a vertex
    std::uint32_t components = 0;
    VertexMapping mapping = VertexMapping::integers;
    std::uint32_t bits = 0;                 // octahedral
    float step = 0;                         // lattice
    std::uint32_t digits = 0;               // decimals
    std::vector<std::uint32_t> exceptions;  // decimals: two words each, as the stream has them
    double largest_error = 0;
};

/// Cost: O(V). Errors: encode_vertices'.
Result<VertexIntegers> to_integers(const VertexValues& values, const VertexOptions& options);

/// Floats as decimals, with the number of digits that promises to be smallest; none if many of them are no decimals.
/// `values` are some that to_integers takes. Cost: O(V).
std::optional<VertexIntegers> to_decimals(const VertexValues& values);

}  // namespace lacedring
