#include "app/view/session/coarse.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace lacedring::view {

Mesh coarse(const Mesh& mesh) {
    constexpr std::uint32_t kCells = 160;  // along the longest side of the mesh
    const std::vector<float> positions = positions_f32(mesh);
    std::array<float, 3> low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
    for (const std::uint32_t v : mesh.indices) {
        for (std::size_t i = 0; i < 3; ++i) {
            const float x = positions[3 * std::size_t{v} + i];
            low[i] = std::min(low[i], x);
            high[i] = std::max(high[i], x);
        }
    }
    const float side = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2], 1e-30F});
    Mesh out;
    std::vector<float> kept;
    constexpr std::uint32_t kUnused = UINT32_MAX;
    std::vector<std::uint32_t> vertex_in(std::size_t{kCells} * kCells * kCells, kUnused);  // per cell
    std::vector<std::uint32_t> vertex(mesh.vertex_count, kUnused);
    for (const std::uint32_t v : mesh.indices) {
        if (vertex[v] != kUnused) continue;
        std::uint32_t cell = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const float share = (positions[3 * std::size_t{v} + i] - low[i]) / side;  // NaN for a NaN position
            const float at = std::clamp(share >= 0 ? share : 0.0F, 0.0F, 1.0F) * static_cast<float>(kCells - 1);
            cell = cell * kCells + static_cast<std::uint32_t>(at);
        }
        const bool added = vertex_in[cell] == kUnused;
        if (added) vertex_in[cell] = out.vertex_count++;
        vertex[v] = vertex_in[cell];
        if (!added) continue;
        kept.insert(kept.end(), {positions[3 * std::size_t{v}], positions[3 * std::size_t{v} + 1],
                                 positions[3 * std::size_t{v} + 2]});
    }
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        std::array<std::uint32_t, 3> t{vertex[mesh.indices[i]], vertex[mesh.indices[i + 1]],
                                       vertex[mesh.indices[i + 2]]};
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
        std::ranges::rotate(t, std::ranges::min_element(t));
        triangles.push_back(t);
    }
    // Parallel sheets in the same cells give the same triangle several times.
    std::ranges::sort(triangles);
    const auto [end, last] = std::ranges::unique(triangles);
    triangles.erase(end, last);
    for (const auto& t : triangles) out.indices.insert(out.indices.end(), t.begin(), t.end());
    Attribute attribute;
    attribute.name = "POSITION";
    attribute.data.resize(sizeof(float) * kept.size());
    std::memcpy(attribute.data.data(), kept.data(), attribute.data.size());
    out.attributes.push_back(std::move(attribute));
    return out;
}

}  // namespace lacedring::view
