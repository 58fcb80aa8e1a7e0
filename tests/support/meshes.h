#pragma once
// Small meshes of every shape, for all tests.

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

/// Built with sanitizers, which make all ten times slower.
#ifdef LACEDRING_SANITIZE
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

struct NamedMesh {
    std::string name;
    Mesh mesh;
};

/// Some 130 meshes of up to 10,000 triangles (2,000 with sanitizers): every local shape that a triangle list can have,
/// closed surfaces of several genera, borders, non-orientable and non-manifold ones, and each generator with a few
/// seeds and sizes. The same list on every call; names are unique. About 0.01 s.
std::vector<NamedMesh> named_meshes();

/// A mesh of these triangles. Every vertex has a position of its own.
Mesh make_mesh(std::vector<std::uint32_t> indices, std::uint32_t vertex_count);
Mesh make_mesh(std::span<const std::array<std::uint32_t, 3>> triangles, std::uint32_t vertex_count);

/// `triangles` triples of random vertices: any topology at all. With `degenerate` a vertex may be repeated in one.
Mesh random_soup(std::uint32_t vertices, std::uint32_t triangles, std::uint64_t seed, bool degenerate = true);

/// A connected soup that is mostly surface: random triangles glued to the edges of earlier ones, some at non-manifold
/// edges, some turned round. Hard on anything that walks a surface. vertices >= 3.
Mesh random_gluing(std::uint32_t vertices, std::uint32_t triangles, std::uint64_t seed);

/// Calls visit(path, mesh) for every mesh file of the folder that LACEDRING_MESHES names, read; says how many there
/// were, nothing where the variable is not set.
std::optional<std::size_t> for_each_real_mesh(
    const std::function<void(const std::string& path, const Result<Mesh>& mesh)>& visit);

/// The multiset of oriented triangles: each rotated so that its smallest vertex comes first, degenerate ones (a vertex
/// repeated) dropped, sorted. Equal for two index lists if and only if they hold the same triangles.
std::vector<std::array<std::uint32_t, 3>> oriented_triangles(std::span<const std::uint32_t> indices);

}  // namespace lacedring::test
