#pragma once
// Surfaces cut along seams.

#include <cstdint>
#include <functional>
#include <vector>

namespace lacedring::test {

/// A surface and the vertex copy of each corner. A slot without a triangle is UINT32_MAX three times.
struct CutSurface {
    std::vector<std::uint32_t> triangles, copies;
    std::uint32_t vertices = 0;
};

/// Cuts a surface into charts: corners of a vertex share a copy if chart_of is equal.
CutSurface cut_by_chart(std::vector<std::uint32_t> triangles, std::uint32_t vertices,
                        const std::function<std::uint32_t(std::uint32_t corner)>& chart_of);

constexpr std::uint32_t kCuts = 5;
/// Cuts a surface in one of kCuts ways. `how` 0: no seams; 1: stripes of triangles; 2: random triangles; 3: each
/// triangle alone; 4: random copies.
CutSurface cut(const std::vector<std::uint32_t>& triangles, std::uint32_t vertices, std::uint32_t how,
               std::uint64_t seed);

}  // namespace lacedring::test
