#pragma once
// The surface of a mesh whose vertices are cut at seams.

#include <cstdint>
#include <vector>

#include "lacedring/mesh.hpp"

namespace lacedring {

/// The mesh with the vertices of equal position joined. A surface vertex has the joined mesh vertices as its copies;
/// they differ in normals, texture coordinates etc. The surface has all triangles of the mesh.
struct Surface {
    std::uint32_t vertex_count = 0;
    std::vector<std::uint32_t> vertex_of;  ///< surface vertex of each mesh vertex; empty: the identity

    bool has_seams() const { return !vertex_of.empty(); }
};

/// Positions changed by joining.
struct SurfaceReport {
    std::uint32_t moved = 0;  ///< vertices whose position changes: by the tolerance, or from -0 to 0
    double largest_move = 0;  ///< largest distance that a vertex moves
};

/// Joins the vertices of equal position; -0 equals 0. With a tolerance, a vertex also joins the nearest earlier vertex
/// that was kept, if it is within the tolerance. A surface vertex has the position of its first copy, but 0 for -0 if
/// another copy has 0. Vertices that no triangle uses are not joined, nor are two vertices of one triangle: no triangle
/// becomes degenerate. `report` may be null. Cost: O(V + T) expected time, 12 bytes a vertex and about 15 a surface
/// vertex.
Surface find_surface(const Mesh& mesh, double tolerance = 0, SurfaceReport* report = nullptr);

/// Gives each mesh vertex exactly the position of its surface vertex. Cost: O(V).
void move_to_surface(Mesh& mesh, const Surface& surface);

/// Merges the copies of a surface vertex that agree in all attributes but POSITION into the first of them. Updates
/// `surface` to the result; it has no seams if no copies are left. Cost: O(V + T) expected time, as find_surface.
Mesh merge_copies(const Mesh& mesh, Surface& surface);

/// The surface as a mesh: its positions, and the mesh's triangles in their order.
Mesh surface_mesh(const Mesh& mesh, const Surface& surface);

/// The seam edges: those where the triangles on the two sides use different mesh vertices at an end. Each edge is
/// given by the smaller of its two opposite corners. `table` has the surface's triangles in the mesh's order. Cost:
/// O(T).
std::vector<CornerId> seam_edges(const CornerTable& table, const Mesh& mesh);

/// The first mesh vertex of each surface vertex. Cost: O(V).
std::vector<std::uint32_t> first_vertices(const Surface& surface);

}  // namespace lacedring
