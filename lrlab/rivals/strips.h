#pragma once
// Triangle strips made by meshoptimizer, and vertex-cache statistics of any triangle order.

#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/base.hpp"

namespace lacedring {

constexpr std::uint32_t kStripRestart = UINT32_MAX;

struct Strips {
    std::vector<std::uint32_t> restart;     ///< strips separated by kStripRestart
    std::vector<std::uint32_t> degenerate;  ///< one strip, joined by degenerate triangles
};

/// meshopt_optimizeVertexCacheStrip, then meshopt_stripify to both kinds. `indices` has no degenerate triangles.
/// Errors: those of check_valences.
Result<Strips> make_strips(std::span<const std::uint32_t> indices, std::uint32_t vertex_count);

/// Makes only Strips::restart. Errors: those of check_valences.
Result<std::vector<std::uint32_t>> make_restart_strip(std::span<const std::uint32_t> indices,
                                                      std::uint32_t vertex_count);

/// Converts strips to an index list (meshopt_unstripify). `restart`: kStripRestart separates the strips.
std::vector<std::uint32_t> unstrip(std::span<const std::uint32_t> strip, bool restart);

/// Transformed vertices per triangle (ACMR) and per vertex (ATVR) for a FIFO cache (meshopt_analyzeVertexCache).
/// Degenerate triangles pass through the cache, but are not counted as triangles.
struct CacheFigures {
    double acmr = 0;
    double atvr = 0;
};
CacheFigures analyze_fifo(std::span<const std::uint32_t> indices, std::size_t vertex_count, std::uint32_t cache_size);
inline CacheFigures analyze_fifo32(std::span<const std::uint32_t> indices, std::size_t vertex_count) {
    return analyze_fifo(indices, vertex_count, 32);
}

}  // namespace lacedring
