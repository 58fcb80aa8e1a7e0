// The targets for readers of mesh files. Accepted meshes are written in every format and read again.

#include <algorithm>
#include <string_view>
#include <vector>

#include "lacedring/mesh_files.hpp"
#include "lacedring/primitives.hpp"
#include "lacedring/topology.hpp"
#include "tests/fuzz/gltf.h"
#include "tests/fuzz/use.h"

namespace lacedring::fuzz {
namespace {

/// A limit that keeps targets fast: a small file can place its meshes very often.
constexpr std::uint64_t kMaxBytes = 8 << 20;

/// Checks that the primitives, placed, have the triangles of the mesh that read_mesh returns.
void check_primitives(std::span<const std::byte> bytes, const Mesh& joined, std::size_t count) {
    const Result<PrimitiveList> list = read_primitives(bytes, {}, {.format = MeshFormat::gltf, .max_bytes = kMaxBytes});
    // Primitives may exceed the limit with attributes that the joined mesh does not have.
    if (!list) {
        REQUIRE(list.error().code != ErrorCode::malformed || !list.error().message.ends_with("has no triangles"));
        return;
    }
    REQUIRE(list->primitives.size() == count);
    std::vector<std::size_t> triangles(list->mesh_names.size());
    for (const Primitive& primitive : list->primitives) {
        check_mesh(primitive.geometry);
        triangles[primitive.mesh] += primitive.geometry.triangle_count();
        const auto placed = std::ranges::find(list->placed, primitive.mesh, &PlacedMesh::mesh);
        REQUIRE(placed != list->placed.end());
        const Mesh moved = place(primitive.geometry, placed->placement);
        REQUIRE(moved.indices.size() == primitive.geometry.indices.size());
    }
    std::size_t sum = 0;
    for (const PlacedMesh& placed : list->placed) sum += triangles[placed.mesh];
    REQUIRE(sum == joined.triangle_count());
}

/// Checks that reading with materials gives the same triangles, each with a material.
void check_materials(std::span<const std::byte> bytes, const Mesh& joined) {
    Materials materials;
    const Result<Mesh> mesh =
        read_mesh(bytes, {}, {.format = MeshFormat::gltf, .max_bytes = 2 * kMaxBytes}, nullptr, &materials);
    if (!mesh) return check_message(mesh.error());
    check_mesh(*mesh);
    REQUIRE(mesh->indices == joined.indices);
    REQUIRE(materials.of_triangle.size() == mesh->triangle_count());
    REQUIRE(std::ranges::all_of(materials.of_triangle, [&](auto m) { return m < materials.materials.size(); }));
    for (const Material& m : materials.materials) {
        for (const TextureUse* use : {&m.base, &m.metallic_roughness, &m.normal, &m.occluding, &m.emitting})
            REQUIRE(use->image == TextureUse::kNone || use->image < materials.images.size());
    }
}

template <MeshFormat format>
bool run(std::span<const std::byte> bytes) {
    ReadReport report;
    const Result<Mesh> mesh = read_mesh(bytes, {}, {.format = format, .max_bytes = kMaxBytes}, &report);
    REQUIRE(report.files.empty());  // without a path no other file is opened
    if (!mesh) {
        check_message(mesh.error());
        return false;
    }
    check_mesh(*mesh);
    std::uint64_t size = 4 * mesh->indices.size();
    for (const Attribute& attribute : mesh->attributes) size += attribute.data.size();
    REQUIRE(size <= kMaxBytes);
    if (format == MeshFormat::gltf) {
        check_primitives(bytes, *mesh, report.primitives);
        check_materials(bytes, *mesh);
    }
    check_writers(*mesh);
    const Result<CornerTable> table = build_corner_table(mesh->indices, mesh->vertex_count);
    REQUIRE(table && check_corner_table(*table).empty());
    return true;
}

}  // namespace

extern const Target gltf_target{"gltf", run<MeshFormat::gltf>, mutate_gltf};
extern const Target obj_target{"obj", run<MeshFormat::obj>, nullptr};
extern const Target off_target{"off", run<MeshFormat::off>, nullptr};
extern const Target ply_target{"ply", run<MeshFormat::ply>, nullptr};
extern const Target stl_target{"stl", run<MeshFormat::stl>, nullptr};

}  // namespace lacedring::fuzz
