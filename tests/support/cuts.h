#pragma once
// Surfaces cut along seams, for all tests.

#include <cstdint>
#include <functional>
#include <vector>

namespace lacedring::test {

/// A surface and the copies of its corners. Slots without a triangle are UINT32_MAX three times.
struct CutSurface {
    std::vector<std::uint32_t> triangles, copies;
    std::uint32_t vertices = 0;
};

/// Numbers the copies: corners of a vertex in charts of one number share one.
CutSurface cut_by_chart(std::vector<std::uint32_t> triangles, std::uint32_t vertices,
                        const std::function<std::uint32_t(std::uint32_t corner)>& chart_of);

/// Ways to cut: no seams, stripes of triangles, random triangles, each triangle alone, random copies.
constexpr std::uint32_t kCuts = 5;
CutSurface cut(const std::vector<std::uint32_t>& triangles, std::uint32_t vertices, std::uint32_t how,
               std::uint64_t seed);

}  // namespace lacedring::test
