#include "lrcore/mesh/write.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "lrcore/base/file.h"
#include "lrcore/mesh/write_formats.h"

namespace lr {
namespace {

/// What the writers rely on: see the invariant of Mesh.
Result<void> check(const Mesh& mesh) {
    const auto refuse = [](std::string why) {
        return Error{ErrorCode::invalid_argument, "the mesh " + std::move(why)};
    };
    if (mesh.attributes.empty() || mesh.attributes.front().name != "POSITION") return refuse("has no positions");
    const Attribute& position = mesh.attributes.front();
    if (position.components != 3 || (position.type != ComponentType::f32 && position.type != ComponentType::f64)) {
        return refuse("has positions that are not 3 floats");
    }
    for (const Attribute& attribute : mesh.attributes) {
        if (attribute.data.size() != attribute.stride() * mesh.vertex_count) {
            return refuse("has attributes of a wrong size");
        }
    }
    const bool in_range = std::all_of(mesh.indices.begin(), mesh.indices.end(),
                                      [&mesh](std::uint32_t v) { return v < mesh.vertex_count; });
    if (mesh.indices.size() % 3 != 0 || !in_range) return refuse("has indices out of range");
    return {};
}

}  // namespace

Result<void> write_mesh(const Mesh& mesh, const std::filesystem::path& path) {
    if (auto good = check(mesh); !good) return good;
    std::string extension = path.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    detail::Bytes head;
    detail::Bytes body;
    Result<void> made;
    if (extension == ".glb") {
        made = detail::make_glb(mesh, head, body);
    } else if (extension == ".ply") {
        detail::make_ply(mesh, head, body);
    } else if (extension == ".obj") {
        detail::make_obj(mesh, body);
    } else {
        made = Error{ErrorCode::invalid_argument, "meshes are written as .glb, .ply or .obj"};
    }
    if (!made) return made;
    const std::span<const std::byte> parts[] = {head, body};
    return write_file(path, parts);
}

}  // namespace lr
