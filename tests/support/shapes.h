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

/// A grid of quads whose left and right sides (close_x) and lower and upper sides (close_y) may be glued; `twist` glues
/// x reversed.
Shape grid(std::uint32_t width, std::uint32_t height, bool close_x, bool close_y, bool twist);
/// A grid without the cells (i, j) where i and j are odd: a disc with holes.
Shape grid_with_holes(std::uint32_t width, std::uint32_t height);
/// A plate of some thickness with holes: closed, of genus `holes`.
Shape plate(std::uint32_t holes);
/// Triangles around vertex 0; all around it if closed.
Shape fan(std::uint32_t triangles, bool closed);
Shape strip(std::uint32_t triangles);
Shape tetrahedron();
Shape octahedron();
Shape cube();
/// Two hubs and a ring of n vertices.
Shape bipyramid(std::uint32_t n);
/// Two fans over the same path, around the hubs 0 and 1, joined at all border edges: closed.
Shape double_fan(std::uint32_t n);
/// The projective plane on six vertices.
Shape projective_plane();
/// Moebius' torus: seven vertices, each pair joined by an edge.
Shape smallest_torus();
/// Splits each triangle into four, with new vertices at the middles of edges.
Shape subdivide(const Shape& shape);
/// Adds a vertex in the middle of each triangle (Apollonian network), which doubles the valences.
Shape stack_all(const Shape& shape);
/// Adds a vertex in the middle of a random triangle, `count` times.
Shape stack_random(Shape shape, std::uint32_t count, std::uint64_t seed);
/// Adds `count` vertices, each in a triangle at the previous vertex.
Shape stack_spiral(Shape shape, std::uint32_t count);
/// The union of both shapes, without a common vertex.
Shape beside(const Shape& a, const Shape& b);
/// Replaces vertex `from` by `to`, which pinches the surface. `from` is then unused.
Shape pinch(Shape shape, std::uint32_t from, std::uint32_t to);
/// Flips every k-th triangle.
Shape turn_some(Shape shape, std::uint32_t k);
/// Appends a second copy of every k-th triangle, reversed if `turned`.
Shape double_some(Shape shape, std::uint32_t k, bool turned);
/// Shuffles and rotates the triangles, and renumbers the vertices at random.
Shape shuffle(Shape shape, std::uint64_t seed);

}  // namespace lacedring::test
