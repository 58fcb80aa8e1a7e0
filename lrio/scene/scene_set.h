#pragma once
// The vertices and triangles of a scene's vertex set, as its accessors have them. Internal to lrio.

#include <cstdint>
#include <vector>

#include "lacedring/mesh.hpp"
#include "lrio/scene/scene_plan.h"

namespace lacedring::detail {

/// One mesh of all parts of a set.
struct SetMesh {
    Mesh mesh;  ///< POSITION as floats, integers by their value; any other attribute as it is
    bool integer_positions = false;
    std::vector<std::uint32_t> first_triangle;  ///< of each part, and behind the last one
};

/// Triangles and bytes of vertices that reading the set takes: for a check of memory.
struct SetSize {
    double vertices = 0, stride = 0, triangles = 0;
};
Result<SetSize> size_of_set(GltfFile& file, const VertexSet& set);

/// Reads the values and cuts strips and fans into triangles. Errors: malformed (an index out of range).
Result<SetMesh> read_set(GltfFile& file, const VertexSet& set);

/// Are all positions finite?
bool has_finite_positions(const Mesh& mesh);

/// Leaves out the vertices that no triangle uses. Returns how many there were.
std::uint32_t drop_unused_vertices(Mesh& mesh);

}  // namespace lacedring::detail
