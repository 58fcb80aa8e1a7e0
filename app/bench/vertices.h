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

/// "vertices": a vertex stream to floats; "meshopt_vertex_codec": the same integers, stored as its users do, as 4 of 16
/// bits per vertex, to integers. `order`, `coded_order`: their vertex orders, order[new] = old; empty `coded_order`: no
/// rival. Errors: invalid_argument if the rival decodes other integers.
Result<VertexBench> vertex_candidates(const Mesh& mesh, const VertexOptions& options,
                                      std::span<const std::uint32_t> order, std::span<const std::uint32_t> coded_order);

}  // namespace lacedring::app
