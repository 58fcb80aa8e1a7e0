#pragma once
// The rivals' index formats, made by meshoptimizer: triangle strips, and what a vertex cache sees of any order.

#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/base.hpp"

namespace lacedring {

constexpr std::uint32_t kStripRestart = UINT32_MAX;

struct Strips {
    std::vector<std::uint32_t> restart;     ///< one strip list, kStripRestart between strips
    std::vector<std::uint32_t> degenerate;  ///< one strip, joined by degenerate triangles
};

/// meshopt_optimizeVertexCacheStrip, then meshopt_stripify both ways. `indices` has no degenerate triangles.
/// Errors: those of check_valences.
Result<Strips> make_strips(std::span<const std::uint32_t> indices, std::uint32_t vertex_count);

/// The first of them alone: what an engine that wants strips would run. Errors: those of check_valences.
Result<std::vector<std::uint32_t>> make_restart_strip(std::span<const std::uint32_t> indices,
                                                      std::uint32_t vertex_count);

/// The triangles of a strip list as an index list (meshopt_unstripify). With `restart`, kStripRestart separates strips.
std::vector<std::uint32_t> unstrip(std::span<const std::uint32_t> strip, bool restart);

/// Transformed vertices per triangle and per vertex, for a FIFO cache (meshopt_analyzeVertexCache). Degenerate
/// triangles pass through the cache, but are not triangles to divide by.
struct CacheFigures {
    double acmr = 0;
    double atvr = 0;
};
CacheFigures analyze_fifo(std::span<const std::uint32_t> indices, std::size_t vertex_count, std::uint32_t cache_size);
inline CacheFigures analyze_fifo32(std::span<const std::uint32_t> indices, std::size_t vertex_count) {
    return analyze_fifo(indices, vertex_count, 32);
}

}  // namespace lacedring
