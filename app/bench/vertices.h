#pragma once
// Decoding of positions on the CPU, beside meshoptimizer's vertex codec.

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/bench/measure.h"
#include "lacedring/mesh.hpp"
#include "lacedring/vertices.hpp"

namespace lacedring::app {

/// Bits of the positions that bench decodes, unless told; the rival's integers have 16 at most.
constexpr std::uint32_t kBenchPositions = 14, kMostBenchPositions = 16;

struct VertexBench {
    std::vector<Candidate> candidates;
    std::vector<std::pair<std::string, std::string>> absent;  ///< name, reason
};

/// "vertices": a vertex stream to floats; "meshopt_vertex_codec": the same integers, stored as its users do, 4 of 16
/// bits a vertex, to integers. Each has the vertices in its own order, `order[new] = old`; no `coded_order`: no rival.
/// Errors: invalid_argument if the rival decodes other integers.
Result<VertexBench> vertex_candidates(const Mesh& mesh, const VertexOptions& options,
                                      std::span<const std::uint32_t> order, std::span<const std::uint32_t> coded_order);

}  // namespace lacedring::app
