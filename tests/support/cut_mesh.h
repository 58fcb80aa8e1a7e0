#pragma once
// Meshes cut at seams.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "lacedring/surface.hpp"

namespace lacedring::test {

/// A mesh with seams and its surface. find_surface() finds the same surface if all positions differ.
struct CutMesh {
    Mesh mesh;
    Surface surface;
};

/// Cuts a mesh as cut() does (cuts.h); an unused vertex has one copy. Keeps POSITION and adds NORMAL (f32), TEXCOORD_0
/// (f32, v upwards, some NaN) and COLOR_0 (3 u8), which differ between copies, and "part" (u16), which does not.
CutMesh cut_mesh(const Mesh& whole, std::uint32_t how, std::uint64_t seed);

/// Numbers for the bytes of all attributes of a vertex.
using ValueNumbers = std::map<std::string, std::uint32_t>;

/// The sorted oriented triangles, without degenerate ones, by the bits of all attributes at their corners. Two meshes
/// have the same triangles if the results of calls with the same `numbers` are equal.
std::vector<std::array<std::uint32_t, 3>> triangles_by_values(const Mesh& mesh, ValueNumbers& numbers);

/// Returns whether a and b put the same elements together: a[i] == a[j] exactly where b[i] == b[j].
bool same_partition(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b);

}  // namespace lacedring::test
