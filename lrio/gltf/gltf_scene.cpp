#include "lrio/gltf/gltf_scene.h"

#include <algorithm>
#include <array>
#include <optional>

#include "lrcore/base/try.h"
#include "lrio/gltf/gltf_accessor.h"

namespace lacedring::detail {
namespace {

template <std::size_t count>
bool take(const std::vector<double>& from, std::array<double, count>& to) {
    if (from.size() == count) std::copy(from.begin(), from.end(), to.begin());
    return from.empty() || from.size() == count;
}

bool local_transform(const tinygltf::Node& node, Transform& out) {
    if (!node.matrix.empty()) return take(node.matrix, out.m);
    if (node.translation.empty() && node.rotation.empty() && node.scale.empty()) return true;
    Vector3 translation{0, 0, 0};
    std::array<double, 4> rotation{0, 0, 0, 1};
    Vector3 scale{1, 1, 1};
    const bool good = take(node.translation, translation) && take(node.rotation, rotation) && take(node.scale, scale);
    if (good) out = from_parts(translation, rotation, scale);
    return good;
}

Result<std::vector<int>> root_nodes(const tinygltf::Model& model) {
    if (!model.scenes.empty()) {
        const int scene = model.defaultScene == -1 ? 0 : model.defaultScene;
        if (scene < 0 || static_cast<std::size_t>(scene) >= model.scenes.size()) {
            return malformed("glTF: scene {} does not exist", scene);
        }
        return model.scenes[static_cast<std::size_t>(scene)].nodes;
    }
    std::vector<bool> is_child(model.nodes.size(), false);
    for (const tinygltf::Node& node : model.nodes) {
        for (const int child : node.children) {
            if (child >= 0 && static_cast<std::size_t>(child) < is_child.size()) {
                is_child[static_cast<std::size_t>(child)] = true;
            }
        }
    }
    std::vector<int> roots;
    for (std::size_t i = 0; i < is_child.size(); ++i) {
        if (!is_child[i]) roots.push_back(static_cast<int>(i));
    }
    return roots;
}

/// The instances of EXT_mesh_gpu_instancing. A missing attribute is the identity.
struct Instances {
    std::size_t count = 0;
    std::optional<AccessorView> translation, rotation, scale;
};

/// Null: the node does not use the extension.
Result<std::optional<Instances>> instances_of(GltfFile& file, const tinygltf::Node& node) {
    const auto extension = node.extensions.find("EXT_mesh_gpu_instancing");
    if (extension == node.extensions.end()) return std::optional<Instances>();
    const tinygltf::Value& attributes = extension->second.Get("attributes");
    Instances out;
    bool any = false;
    const auto take = [&](const char* name, std::uint8_t components, bool may_be_integer,
                          std::optional<AccessorView>& to) -> Result<void> {
        if (!attributes.IsObject() || !attributes.Has(name)) return {};
        const tinygltf::Value& number = attributes.Get(name);
        const auto view = view_accessor(file, number.IsInt() ? number.GetNumberAsInt() : -1);
        if (!view) return Error{view.error().code, fmt::format("instances' {}: {}", name, view.error().message)};
        const bool fits =
            view->type == ComponentType::f32 || (may_be_integer && view->normalized &&
                                                 (view->type == ComponentType::i8 || view->type == ComponentType::i16));
        if (view->components != components || !fits) return malformed("instances' {}: not of its type", name);
        if (any && view->count != out.count) return malformed("instances' {}: {} of {}", name, view->count, out.count);
        any = true;
        out.count = view->count;
        to = *view;
        return {};
    };
    LR_TRY(take("TRANSLATION", 3, false, out.translation));
    LR_TRY(take("ROTATION", 4, true, out.rotation));
    LR_TRY(take("SCALE", 3, false, out.scale));
    if (!any) return malformed("instances without TRANSLATION, ROTATION or SCALE");
    return std::optional<Instances>(out);
}

/// The values of an accessor as doubles; without an accessor, `count` times `unset`.
template <std::size_t width>
Result<std::vector<std::array<double, width>>> values_of(const std::optional<AccessorView>& view, std::size_t count,
                                                         const std::array<double, width>& unset) {
    std::vector<std::array<double, width>> out(count, unset);
    if (!view) return out;
    std::vector<std::byte> packed(count * view->element_bytes());
    LR_TRY(copy_elements(*view, packed.data()));
    for (std::size_t i = 0; i < count * width; ++i) {
        out[i / width][i % width] = component_at(packed.data(), view->type, view->normalized, i);
    }
    return out;
}

Result<void> place_each(const Instances& several, std::size_t mesh, const Transform& node,
                        std::vector<MeshInstance>& instances, const Reading& reading, std::size_t file_bytes) {
    // An accessor without a buffer view may have any count, and many nodes may name the same one. The size counts
    // twice: a vector that grows has its elements twice for a moment.
    auto room = reading.check_memory(static_cast<double>(instances.size()) + static_cast<double>(several.count),
                                     2.0 * sizeof(MeshInstance), 0, static_cast<double>(file_bytes));
    if (!room) return room;
    LR_ASSIGN(const auto translation, values_of<3>(several.translation, several.count, {0, 0, 0}));
    LR_ASSIGN(const auto rotation, values_of<4>(several.rotation, several.count, {0, 0, 0, 1}));
    LR_ASSIGN(const auto scale, values_of<3>(several.scale, several.count, {1, 1, 1}));
    for (std::size_t i = 0; i < several.count; ++i) {
        instances.push_back({mesh, node * from_parts(translation[i], rotation[i], scale[i])});
    }
    return {};
}

}  // namespace

Result<std::vector<MeshInstance>> place_meshes(GltfFile& file, Reading& reading, std::size_t file_bytes) {
    const tinygltf::Model& model = file.model;
    std::vector<MeshInstance> instances;
    if (model.nodes.empty()) {
        for (std::size_t mesh = 0; mesh < model.meshes.size(); ++mesh) instances.push_back({mesh, {}});
        return instances;
    }
    LR_ASSIGN(const auto roots, root_nodes(model));

    struct Visit {
        int node;
        Transform parent;
        bool is_root;
    };
    std::vector<Visit> stack;  // instead of recursion: hostile files nest nodes deeply
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) stack.push_back({*root, {}, true});
    std::vector<bool> visited(model.nodes.size(), false);
    while (!stack.empty()) {
        const Visit visit = stack.back();
        stack.pop_back();
        if (visit.node < 0 || static_cast<std::size_t>(visit.node) >= model.nodes.size()) {
            return malformed("glTF: node {} does not exist", visit.node);
        }
        const auto index = static_cast<std::size_t>(visit.node);
        const tinygltf::Node& node = model.nodes[index];
        if (visited[index]) return malformed("glTF: node {} is in a cycle or has two parents", index);
        visited[index] = true;
        Transform transform;
        if (!local_transform(node, transform))
            return malformed("glTF: node {}: the transform has a wrong length", index);
        if (!visit.is_root) transform = visit.parent * transform;
        if (node.mesh != -1) {
            if (node.mesh < 0 || static_cast<std::size_t>(node.mesh) >= model.meshes.size()) {
                return malformed("glTF: node {}: mesh {} does not exist", index, node.mesh);
            }
            const auto mesh = static_cast<std::size_t>(node.mesh);
            // Only its joints place a skinned mesh, not its node (glTF 2.0, section 3.7.3.2).
            const Transform placed = node.skin == -1 ? transform : Transform{};
            const auto several = instances_of(file, node);
            if (!several)
                return Error{several.error().code, fmt::format("glTF: node {}: {}", index, several.error().message)};
            if (!*several) {
                instances.push_back({mesh, placed});
            } else if (auto good = place_each(**several, mesh, placed, instances, reading, file_bytes); !good) {
                return Error{good.error().code, fmt::format("glTF: node {}: {}", index, good.error().message)};
            }
        }
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
            stack.push_back({*child, transform, false});
        }
    }
    return instances;
}

}  // namespace lacedring::detail
