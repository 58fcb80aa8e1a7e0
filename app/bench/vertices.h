#pragma once
// Decoding positions on the CPU, beside meshoptimizer's vertex codec.

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/bench/measure.h"
#include "lacedring/mesh.hpp"
#include "lacedring/vertices.hpp"

namespace lacedring::app {

/// Bits of the positions that bench decodes: the default, and the most, as the rival's integers have 16 bits.
constexpr std::uint32_t kBenchPositions = 14, kMostBenchPositions = 16;

struct VertexBench {
    std::vector<Candidate> candidates;
    std::vector<std::pair<std::string, std::string>> absent;  ///< name, reason
};

/// Makes two candidates. "vertices" decodes a vertex stream to floats. "meshopt_vertex_codec" decodes the same lattice
/// integers with meshoptimizer, stored as four u16 per vertex (x, y, z and 0), as is usual for that codec. `order` and
/// `coded_order` are their vertex orders, order[new] = old. The codec is absent if `coded_order` is empty or the
/// positions are not on a lattice. Errors: invalid_argument if the codec decodes other integers.
Result<VertexBench> vertex_candidates(const Mesh& mesh, const VertexOptions& options,
                                      std::span<const std::uint32_t> order, std::span<const std::uint32_t> coded_order);

}  // namespace lacedring::app
