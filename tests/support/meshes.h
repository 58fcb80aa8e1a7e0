#pragma once
// Small meshes of every local shape.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lacedring/base.hpp"
#include "lacedring/mesh.hpp"

namespace lacedring::test {

/// True if the tests are built with sanitizers, which make them ten times slower.
#ifdef LACEDRING_SANITIZE
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

struct NamedMesh {
    std::string name;
    Mesh mesh;
};

/// Some 130 meshes of up to 10,000 triangles (2,000 with sanitizers): every local shape that a triangle list can have;
/// closed, bordered, non-orientable and non-manifold surfaces; each generator with some seeds and sizes. The list is
/// the same on every call and names are unique. Takes about 0.01 s.
std::vector<NamedMesh> named_meshes();

/// A mesh of the triangles, whose vertices have distinct positions.
Mesh make_mesh(std::vector<std::uint32_t> indices, std::uint32_t vertex_count);
Mesh make_mesh(std::span<const std::array<std::uint32_t, 3>> triangles, std::uint32_t vertex_count);

/// Triangles of random vertices, of any topology. With `degenerate`, a triangle may have a vertex twice.
Mesh random_soup(std::uint32_t vertices, std::uint32_t triangles, std::uint64_t seed, bool degenerate = true);

/// A connected mesh of triangles that are glued to edges of earlier ones, some at non-manifold edges, some with the
/// wrong orientation. A hard case for walks over a surface. vertices >= 3.
Mesh random_gluing(std::uint32_t vertices, std::uint32_t triangles, std::uint64_t seed);

/// Reads every mesh file of the folder LACEDRING_MESHES and calls visit(path, mesh). Returns the number of files;
/// nothing if the variable is not set.
std::optional<std::size_t> for_each_real_mesh(
    const std::function<void(const std::string& path, const Result<Mesh>& mesh)>& visit);

/// The triangles, sorted, each rotated to begin with its smallest vertex, without degenerate ones (a vertex repeated).
/// Two index lists hold the same oriented triangles exactly if the results are equal.
std::vector<std::array<std::uint32_t, 3>> oriented_triangles(std::span<const std::uint32_t> indices);

}  // namespace lacedring::test
