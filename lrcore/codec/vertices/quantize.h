#pragma once
// From the values of an attribute to the integers that a vertex stream codes.

#include <cstdint>
#include <vector>

#include "lacedring/vertices.hpp"

namespace lacedring {

struct VertexIntegers {
    std::vector<std::uint32_t> values;  // `components` a vertex
    std::uint32_t components = 0;
    VertexMapping mapping = VertexMapping::integers;
    std::uint32_t bits = 0;  // octahedral
    float step = 0;          // lattice
    double largest_error = 0;
};

/// Cost: O(V). Errors: encode_vertices'.
Result<VertexIntegers> to_integers(const VertexValues& values, const VertexOptions& options);

}  // namespace lacedring
