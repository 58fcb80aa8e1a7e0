#include "lrio/gltf/gltf_draco.h"

#include <string>
#include <tuple>
#include <utility>

#include "lrcore/base/try.h"
#include "lrio/gltf/draco_mesh.h"
#include "lrio/gltf/gltf_accessor.h"
#include "lrio/gltf/gltf_view.h"

namespace lacedring::detail {
namespace {

constexpr const char* kDraco = "KHR_draco_mesh_compression";

/// tinygltf's value as an unsigned integer below 2^31; -1: it is not one.
int unsigned_of(const tinygltf::Value& value) {
    return value.IsInt() && value.GetNumberAsInt() >= 0 ? value.GetNumberAsInt() : -1;
}

class DracoFinder {
  public:
    explicit DracoFinder(GltfFile& file) : file_(file), accessors_(file.model.accessors) {}

    Result<void> note(tinygltf::Primitive& primitive) {
        const auto extension = primitive.extensions.find(kDraco);
        if (extension == primitive.extensions.end() || primitive.mode < TINYGLTF_MODE_TRIANGLES) return {};
        if (primitive.mode > TINYGLTF_MODE_TRIANGLE_STRIP) return malformed("{} in mode {}", kDraco, primitive.mode);
        if (!extension->second.IsObject()) return malformed("{} is not an object", kDraco);
        const int view = unsigned_of(extension->second.Get("bufferView"));
        if (view < 0) return malformed("{}: bufferView is missing", kDraco);
        const tinygltf::Value& attributes = extension->second.Get("attributes");
        if (!attributes.IsObject()) return malformed("{}: attributes are missing", kDraco);
        for (auto& [name, accessor] : primitive.attributes) {
            if (!attributes.Has(name)) continue;
            const int id = unsigned_of(attributes.Get(name));
            if (id < 0) return malformed("{}: the id of {} is not an unsigned integer", kDraco, shown(name));
            note(accessor, {view, id});
        }
        if (primitive.indices == -1) {
            tinygltf::Accessor indices;
            indices.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
            indices.type = TINYGLTF_TYPE_SCALAR;
            primitive.indices = static_cast<int>(accessors_.size());
            accessors_.push_back(std::move(indices));
        }
        note(primitive.indices, {view, -1});
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
        return {};
    }

  private:
    /// Records the accessor's source. An accessor with two sources is split into two: tools that merge equal accessors
    /// also merge Draco accessors of different primitives, because these have only a type and a count.
    void note(int& accessor, DracoData::Source source) {
        // view_accessor reports an index out of range.
        if (accessor < 0 || static_cast<std::size_t>(accessor) >= accessors_.size()) return;
        const auto [known, is_new] = known_.emplace(std::tuple(accessor, source), accessor);
        if (is_new) {
            if (file_.draco.sources.contains(accessor)) {
                const tinygltf::Accessor& from = accessors_[static_cast<std::size_t>(accessor)];
                tinygltf::Accessor copy;
                copy.componentType = from.componentType;
                copy.type = from.type;
                copy.normalized = from.normalized;
                known->second = static_cast<int>(accessors_.size());
                accessors_.push_back(std::move(copy));
            }
            file_.draco.sources[known->second] = source;
            file_.draco.accessors[source.view].push_back(known->second);
        }
        accessor = known->second;
    }

    GltfFile& file_;
    std::vector<tinygltf::Accessor>& accessors_;
    /// From the file's accessor and its source to the accessor that has this source.
    std::map<std::tuple<int, DracoData::Source>, int> known_;
};

#ifdef LACEDRING_DRACO

Result<void> decode_values(GltfFile& file, const draco::Mesh& mesh, int index) {
    const tinygltf::Accessor& accessor = file.model.accessors[static_cast<std::size_t>(index)];
    const std::int64_t id = file.draco.sources.at(index).attribute;
    ComponentType type{};
    const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    if (!to_component_type(accessor.componentType, type) || components < 1) return malformed("an unknown type");
    const std::size_t size = size_of(type) * static_cast<std::size_t>(components);
    const std::size_t count = id < 0 ? std::size_t{3} * mesh.num_faces() : mesh.num_points();
    if (auto room = file.take_memory(static_cast<double>(count) * static_cast<double>(size)); !room) return room;
    std::vector<std::byte> out(count * size);
    auto good = id < 0 && components == 1 ? copy_draco_indices(mesh, type, out)
                : id < 0                  ? malformed("indices of {} components", components)
                         : copy_draco_attribute(mesh, static_cast<std::uint32_t>(id), type, components, out);
    if (good) file.draco.values.emplace(index, std::move(out));
    return good;
}

Result<void> decode_draco(GltfFile& file, int view) {
    if (static_cast<std::size_t>(view) >= file.model.bufferViews.size()) return malformed("does not exist");
    LR_ASSIGN(const auto bytes, open_view(file, static_cast<std::size_t>(view)));
    LR_ASSIGN(const auto mesh, decode_draco_mesh(file, bytes));
    for (const int accessor : file.draco.accessors[view]) {
        if (auto good = decode_values(file, *mesh, accessor); !good) {
            return Error{good.error().code, fmt::format("accessor {}: {}", accessor, good.error().message)};
        }
    }
    return {};
}

#else

Result<void> decode_draco(GltfFile& /*file*/, int /*view*/) {
    return unsupported("this build has no libdraco");
}

#endif

}  // namespace

Result<void> find_draco_primitives(GltfFile& file) {
    if (!has_draco()) return {};
    DracoFinder finder(file);
    for (std::size_t m = 0; m < file.model.meshes.size(); ++m) {
        auto& primitives = file.model.meshes[m].primitives;
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            if (auto good = finder.note(primitives[p]); !good) {
                return malformed("glTF: mesh {}: primitive {}: {}", m, p, good.error().message);
            }
        }
    }
    return {};
}

Result<std::span<const std::byte>> draco_values(GltfFile& file, int accessor) {
    const int view = file.draco.sources.at(accessor).view;
    auto known = file.draco.decoded.find(view);
    if (known == file.draco.decoded.end()) {
        auto decoded = decode_draco(file, view);
        if (!decoded) {
            decoded =
                Error{decoded.error().code, fmt::format("buffer view {}: Draco: {}", view, decoded.error().message)};
        }
        known = file.draco.decoded.emplace(view, std::move(decoded)).first;
    }
    if (!known->second) return known->second.error();
    return std::span<const std::byte>(file.draco.values.at(accessor));
}

}  // namespace lacedring::detail
