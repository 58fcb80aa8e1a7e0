#pragma once
// Makes a coarse mesh that is shown until a large one is ready.

#include "lacedring/mesh.hpp"

namespace lacedring::view {

/// Joins the vertices in each cell of a grid over the mesh; about 100,000 triangles are left. The result has only
/// positions. Cost: O(V + T) time, 4 bytes per vertex.
Mesh coarse(const Mesh& mesh);

}  // namespace lacedring::view
