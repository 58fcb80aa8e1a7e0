#pragma once
// A coarse mesh that stands in for a large one.

#include "lacedring/mesh.hpp"

namespace lacedring::view {

/// Joins the vertices in each cell of a grid over the mesh; some 100,000 triangles are left of any surface. Positions
/// alone. Cost: O(V + T) time, 4 bytes a vertex.
Mesh coarse(const Mesh& mesh);

}  // namespace lacedring::view
