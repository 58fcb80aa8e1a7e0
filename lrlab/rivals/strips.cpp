#include "lrlab/rivals/strips.h"

#include <meshoptimizer.h>

#include "lrcore/base/try.h"
#include "lrlab/rivals/limit.h"

namespace lacedring {

namespace {

std::vector<std::uint32_t> strip_order(std::span<const std::uint32_t> indices, std::uint32_t vertex_count) {
    std::vector<std::uint32_t> ordered(indices.size());
    if (!indices.empty()) {
        meshopt_optimizeVertexCacheStrip(ordered.data(), indices.data(), indices.size(), vertex_count);
    }
    return ordered;
}

std::vector<std::uint32_t> stripify(std::span<const std::uint32_t> ordered, std::uint32_t vertex_count,
                                    std::uint32_t restart) {
    std::vector<std::uint32_t> strip(meshopt_stripifyBound(ordered.size()));
    if (ordered.empty()) return {};
    strip.resize(meshopt_stripify(strip.data(), ordered.data(), ordered.size(), vertex_count, restart));
    return strip;
}

}  // namespace

Result<Strips> make_strips(std::span<const std::uint32_t> indices, std::uint32_t vertex_count) {
    LR_TRY(check_valences(indices, vertex_count));
    const std::vector<std::uint32_t> ordered = strip_order(indices, vertex_count);
    return Strips{stripify(ordered, vertex_count, kStripRestart), stripify(ordered, vertex_count, 0)};
}

Result<std::vector<std::uint32_t>> make_restart_strip(std::span<const std::uint32_t> indices,
                                                      std::uint32_t vertex_count) {
    LR_TRY(check_valences(indices, vertex_count));
    return stripify(strip_order(indices, vertex_count), vertex_count, kStripRestart);
}

std::vector<std::uint32_t> unstrip(std::span<const std::uint32_t> strip, bool restart) {
    if (strip.empty()) return {};
    std::vector<std::uint32_t> indices(meshopt_unstripifyBound(strip.size()));
    indices.resize(meshopt_unstripify(indices.data(), strip.data(), strip.size(), restart ? kStripRestart : 0));
    return indices;
}

CacheFigures analyze_fifo(std::span<const std::uint32_t> indices, std::size_t vertex_count, std::uint32_t cache_size) {
    if (indices.empty()) return {};
    const auto figures = meshopt_analyzeVertexCache(indices.data(), indices.size(), vertex_count, cache_size, 0, 0);
    std::size_t triangles = 0;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const std::uint32_t a = indices[i], b = indices[i + 1], c = indices[i + 2];
        triangles += a != b && b != c && c != a ? 1 : 0;
    }
    if (triangles == 0) return {};
    return {static_cast<double>(figures.vertices_transformed) / static_cast<double>(triangles),
            static_cast<double>(figures.atvr)};
}

}  // namespace lacedring
