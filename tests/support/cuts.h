#pragma once
// Surfaces cut along seams, for all tests.

#include <cstdint>
#include <functional>
#include <vector>

#include "lacedring/mesh.hpp"

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

/// A mesh with seams. surface[v] is the surface's vertex of the mesh's vertex v.
struct CutMesh {
    Mesh mesh;
    std::vector<std::uint32_t> surface;
    std::uint32_t surface_vertices = 0;
};
/// `whole`, cut so: every copy is a vertex with a normal of its own. Vertex 0 is in no triangle.
CutMesh cut_mesh(const Mesh& whole, std::uint32_t how, std::uint64_t seed);

}  // namespace lacedring::test
