// The readers of mesh files. What they accept is written in every format and read back.

#include <string_view>

#include "lacedring/mesh_files.hpp"
#include "lacedring/topology.hpp"
#include "tests/fuzz/gltf.h"
#include "tests/fuzz/use.h"

namespace lacedring::fuzz {
namespace {

/// Little enough to stay fast. A small file can place its meshes very often.
constexpr std::uint64_t kMaxBytes = 8 << 20;

template <MeshFormat format>
bool run(std::span<const std::byte> bytes) {
    ReadReport report;
    const Result<Mesh> mesh = read_mesh(bytes, {}, {.format = format, .max_bytes = kMaxBytes}, &report);
    REQUIRE(report.files.empty());  // no name, no folder to look in
    if (!mesh) {
        check_message(mesh.error());
        return false;
    }
    check_mesh(*mesh);
    std::uint64_t size = 4 * mesh->indices.size();
    for (const Attribute& attribute : mesh->attributes) size += attribute.data.size();
    REQUIRE(size <= kMaxBytes);
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
