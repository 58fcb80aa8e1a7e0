#pragma once
// The shapes behind named_meshes(): triangle lists over vertices 0, 1, 2, ...

#include <array>
#include <cstdint>
#include <vector>

#include "lrcore/base/random.h"

namespace lacedring::test {

using detail::SplitMix64;
using Triangle = std::array<std::uint32_t, 3>;

struct Shape {
    std::uint32_t vertices = 0;
    std::vector<Triangle> triangles;
};

/// The surfaces that a grid of quads makes when its sides are glued: x alone or x and y; `twist` glues x reversed.
Shape grid(std::uint32_t width, std::uint32_t height, bool close_x, bool close_y, bool twist);
/// A grid without the cells (i, j), i and j odd: a disc with holes.
Shape grid_with_holes(std::uint32_t width, std::uint32_t height);
/// Both sides of a plate with holes and its walls: closed; genus = holes.
Shape plate(std::uint32_t holes);
/// Triangles around vertex 0; closed: a disc.
Shape fan(std::uint32_t triangles, bool closed);
Shape strip(std::uint32_t triangles);
Shape tetrahedron();
Shape octahedron();
Shape cube();
/// Two hubs and a ring of n vertices.
Shape bipyramid(std::uint32_t n);
/// Hubs 0 and 1 both see every vertex of a path: a closed double fan whose halves share all border edges.
Shape double_fan(std::uint32_t n);
/// The projective plane on six vertices.
Shape projective_plane();
/// Seven vertices, every two joined by an edge: Moebius' torus.
Shape smallest_torus();
/// Every triangle into four, vertices at the middles of edges.
Shape subdivide(const Shape& shape);
/// A vertex in the middle of every triangle (Apollonian network): valences double each time.
Shape stack_all(const Shape& shape);
/// A vertex in the middle of a random triangle, `count` times.
Shape stack_random(Shape shape, std::uint32_t count, std::uint64_t seed);
/// A vertex put into one triangle, then one into a triangle at that vertex, and so on.
Shape stack_spiral(Shape shape, std::uint32_t count);
/// Both, unconnected.
Shape beside(const Shape& a, const Shape& b);
/// The same with vertex `from` replaced by `to`: pinches the surface. The number `from` is not used any more.
Shape pinch(Shape shape, std::uint32_t from, std::uint32_t to);
/// Every k-th triangle turned round.
Shape turn_some(Shape shape, std::uint32_t k);
/// Every k-th triangle once more, behind the others, or its reverse.
Shape double_some(Shape shape, std::uint32_t k, bool turned);
/// Triangles in random order, rotated, and vertices renumbered at random.
Shape shuffle(Shape shape, std::uint64_t seed);

}  // namespace lacedring::test
