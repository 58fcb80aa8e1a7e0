#pragma once
// Reads the vertices and triangles of a scene's vertex set. Internal to lrio.

#include <cstdint>
#include <vector>

#include "lacedring/mesh.hpp"
#include "lrio/scene/scene_plan.h"

namespace lacedring::detail {

/// A mesh of all parts of a set.
struct SetMesh {
    Mesh mesh;  ///< integer POSITION converted to floats, not normalized; other attributes unchanged
    bool integer_positions = false;
    std::vector<std::uint32_t> first_triangle;  ///< first triangle of each part; then the number of triangles
};

/// The size of a set in memory: numbers of vertices and triangles, and bytes of a vertex.
struct SetSize {
    double vertices = 0, stride = 0, triangles = 0;
};
Result<SetSize> size_of_set(GltfFile& file, const VertexSet& set);

/// Reads the values and converts strips and fans to triangles. Errors: malformed (an index out of range).
Result<SetMesh> read_set(GltfFile& file, const VertexSet& set);

/// Are all positions finite?
bool has_finite_positions(const Mesh& mesh);

/// Removes the vertices that no triangle uses. Returns their number.
std::uint32_t drop_unused_vertices(Mesh& mesh);

}  // namespace lacedring::detail
