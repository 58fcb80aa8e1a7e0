#pragma once
// The surface of a mesh whose vertices are cut at seams.

#include <cstdint>
#include <vector>

#include "lacedring/mesh.hpp"

namespace lacedring {

/// A mesh's vertices of one position, joined. The mesh's vertices are their copies: they differ in normals, texture
/// coordinates and the like. Connectivity is that of the surface, which has all of the mesh's triangles.
struct Surface {
    std::uint32_t vertex_count = 0;
    std::vector<std::uint32_t> vertex_of;  ///< the surface's vertex of each of the mesh's; empty: each its own

    bool has_seams() const { return !vertex_of.empty(); }
};

/// Positions that joining changes.
struct SurfaceReport {
    std::uint32_t moved = 0;  ///< vertices whose position gets other bits: -0 becomes 0, or a tolerance was given
    double largest_move = 0;  ///< the farthest that a vertex moves
};

/// Joins the vertices of equal position; -0 equals 0. With a tolerance, also a vertex with the nearest one, of those
/// kept before it, that is no farther away. A surface vertex has the position of the first of its copies, but 0 for -0
/// where another copy has 0. Vertices that no triangle uses stay apart, and so do those of one triangle: none becomes
/// degenerate. Cost: O(V + T) expected time, 12 bytes a vertex and about 15 a surface vertex. `report` may be null.
Surface find_surface(const Mesh& mesh, double tolerance = 0, SurfaceReport* report = nullptr);

/// Gives each of the mesh's vertices its surface vertex's position, to the bit. Cost: O(V).
void move_to_surface(Mesh& mesh, const Surface& surface);

/// The mesh without copies that differ in no attribute, POSITION aside: the first one stands for all. `surface` becomes
/// that of the result; it has no seams where no copies are left. Cost: O(V + T) expected time, as find_surface's.
Mesh merge_copies(const Mesh& mesh, Surface& surface);

/// The surface as a mesh: its positions, and the mesh's triangles in their order.
Mesh surface_mesh(const Mesh& mesh, const Surface& surface);

/// The seams: for each edge across which the mesh's vertices differ at an end, the smaller of the two corners that face
/// it. `table` is the surface's, of the mesh's triangles in their order. Cost: O(T).
std::vector<CornerId> seam_edges(const CornerTable& table, const Mesh& mesh);

/// The first of the mesh's vertices for each of the surface's. Cost: O(V).
std::vector<std::uint32_t> first_vertices(const Surface& surface);

}  // namespace lacedring
