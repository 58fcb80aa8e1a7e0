#pragma once
// Meshes cut at seams, for all tests.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "lacedring/surface.hpp"

namespace lacedring::test {

/// A mesh with seams and its surface, which find_surface() would find where positions differ.
struct CutMesh {
    Mesh mesh;
    Surface surface;
};

/// `whole`, cut as cut() does it (cuts.h); a vertex that no triangle uses has one copy. Keeps POSITION and adds NORMAL
/// (f32), TEXCOORD_0 (f32, v upwards) and COLOR_0 (u8, three), which differ between copies, some values being no
/// numbers, and "part" (u16), which does not.
CutMesh cut_mesh(const Mesh& whole, std::uint32_t how, std::uint64_t seed);

/// Numbers the values of vertices in all attributes.
using ValueNumbers = std::map<std::string, std::uint32_t>;

/// The multiset of the oriented triangles that name three vertices, by the bits of all attributes at their corners. Two
/// meshes have the same triangles if these are equal; `numbers` is shared by both.
std::vector<std::array<std::uint32_t, 3>> triangles_by_values(const Mesh& mesh, ValueNumbers& numbers);

/// Is each vertex of `b` one of `a`, and the other way round? Numbers may differ.
bool same_partition(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b);

}  // namespace lacedring::test
