#include <algorithm>
#include <cctype>
#include <string>

#include "lacedring/file.hpp"
#include "lacedring/mesh_files.hpp"
#include "lrcore/base/try.h"
#include "lrio/mesh/write_formats.h"

namespace lacedring {
namespace {

/// Checks the preconditions of the writers: the guarantees of Mesh.
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
    // The readers refuse meshes without triangles, so they are not written.
    if (mesh.indices.empty()) return Error{ErrorCode::unsupported, "the mesh has no triangles"};
    return {};
}

struct File {
    detail::Bytes head, body;
};

Result<File> make_file(const Mesh& mesh, MeshFormat format, WriteNotes* notes) {
    LR_TRY(check(mesh));
    WriteNotes unwanted;
    WriteNotes& told = notes != nullptr ? *notes : unwanted;
    File file;
    switch (format) {
        case MeshFormat::gltf:
            LR_TRY(detail::make_glb(mesh, file.head, file.body, told));
            return file;
        case MeshFormat::ply:
            detail::make_ply(mesh, file.head, file.body);
            return file;
        case MeshFormat::obj:
            detail::make_obj(mesh, file.body, told);
            return file;
        default:
            return Error{ErrorCode::invalid_argument, "meshes are written as .glb, .ply or .obj"};
    }
}

}  // namespace

MeshFormat writable_format(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (extension == ".glb") return MeshFormat::gltf;
    if (extension == ".ply") return MeshFormat::ply;
    if (extension == ".obj") return MeshFormat::obj;
    return MeshFormat::any;
}

Result<void> write_mesh(const Mesh& mesh, const std::filesystem::path& path, WriteNotes* notes, std::uint64_t* bytes) {
    LR_ASSIGN(const File file, make_file(mesh, writable_format(path), notes));
    if (bytes != nullptr) *bytes = file.head.size() + file.body.size();
    const std::span<const std::byte> parts[] = {file.head, file.body};
    return write_file(path, parts);
}

Result<void> write_mesh(const Mesh& mesh, MeshFormat format, int descriptor, WriteNotes* notes, std::uint64_t* bytes) {
    LR_ASSIGN(const File file, make_file(mesh, format, notes));
    if (bytes != nullptr) *bytes = file.head.size() + file.body.size();
    const std::span<const std::byte> parts[] = {file.head, file.body};
    return write_descriptor(descriptor, parts);
}

Result<std::vector<std::byte>> mesh_file_bytes(const Mesh& mesh, MeshFormat format, WriteNotes* notes) {
    LR_ASSIGN(File file, make_file(mesh, format, notes));
    detail::append(file.head, file.body);
    return std::move(file.head);
}

}  // namespace lacedring
