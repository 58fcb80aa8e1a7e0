#include "lrio/scene/scene_plan.h"

#include <algorithm>
#include <set>

#include "lrio/gltf/gltf_accessor.h"
#include "lrio/gltf/tinygltf.h"
#include "lrio/mesh/read_formats.h"

namespace lacedring::detail {
namespace {

constexpr std::uint32_t kNone = UINT32_MAX;

/// Is it an extension of primitives that does not refer to vertices or triangles by index?
bool is_order_free(std::string_view extension) {
    constexpr std::string_view kNames[] = {"KHR_draco_mesh_compression", "KHR_materials_variants", "EXT_mesh_features",
                                           "EXT_structural_metadata"};
    return std::find(std::begin(kNames), std::end(kNames), extension) != std::end(kNames);
}

struct Candidate {
    PrimitivePlace place;
    std::vector<SceneAttribute> attributes;
    std::optional<std::uint32_t> indices;
    int mode = 4;
    bool in_order = false;  ///< an extension may refer to its vertices or triangles by index
};

class Planner {
  public:
    Planner(const JsonValue& document, GltfFile& file, bool keep_order)
        : document_(document), file_(file), keep_order_(keep_order), accessors_(document.list("accessors").size()) {
        group_.resize(accessors_);
        for (std::uint32_t i = 0; i < accessors_; ++i) group_[i] = i;
        used_otherwise_.assign(accessors_, false);
        is_indices_.assign(accessors_, false);
        lacks_positions_.assign(accessors_, false);
    }

    Result<ScenePlan> run() {
        std::uint32_t mesh = 0;
        for (const auto& member : document_.list("meshes")) {
            std::uint32_t number = 0;
            for (const auto& primitive : member.value.list("primitives")) {
                if (auto good = take(primitive.value, {mesh, number}); !good) {
                    return Error{good.error().code,
                                 fmt::format("glTF: mesh {}: primitive {}: {}", mesh, number, good.error().message)};
                }
                ++number;
            }
            ++mesh;
        }
        mark_other_uses();
        return make_sets();
    }

  private:
    bool known(std::uint64_t accessor) const { return accessor < accessors_; }

    std::uint32_t find(std::uint32_t accessor) {
        while (group_[accessor] != accessor) accessor = group_[accessor] = group_[group_[accessor]];
        return accessor;
    }

    Result<void> take(const JsonValue& primitive, PrimitivePlace place) {
        Candidate out{place, {}, {}, 4, false};
        if (const JsonValue* mode = primitive.find("mode")) {
            const auto value = mode->integer();
            if (!value || *value > 6) return malformed("mode {}", shown(mode->text));
            out.mode = static_cast<int>(*value);
        }
        if (const JsonValue* indices = primitive.find("indices")) {
            const auto accessor = indices->integer();
            if (!accessor || !known(*accessor)) return malformed("accessor {} does not exist", shown(indices->text));
            out.indices = static_cast<std::uint32_t>(*accessor);
        }
        const auto attribute = [&](std::string name, std::uint32_t accessor) -> Result<void> {
            if (!known(accessor)) return malformed("{}: accessor {} does not exist", shown(name), accessor);
            out.attributes.push_back({accessor, std::move(name)});
            return {};
        };
        if (auto good = visit_attributes(primitive, attribute); !good) return good;
        if (const JsonValue* extensions = primitive.find("extensions")) {
            for (const auto& extension : extensions->members) {
                out.in_order = out.in_order || !is_order_free(plain_key(extension.key));
            }
        }
        const bool has_positions = std::any_of(out.attributes.begin(), out.attributes.end(),
                                               [](const auto& a) { return a.name == "POSITION"; });
        if (out.mode < 4 || !has_positions) {
            leave_out(out, out.mode == 0 ? "points" : out.mode < 4 ? "lines" : "triangles without positions");
            if (out.mode < 4) return {};
            for (const SceneAttribute& a : out.attributes) lacks_positions_[a.accessor] = true;
            return {};
        }
        for (const SceneAttribute& a : out.attributes) {
            group_[find(a.accessor)] = find(out.attributes[0].accessor);
        }
        if (out.indices) {
            group_[find(*out.indices)] = find(out.attributes[0].accessor);
            is_indices_[*out.indices] = true;
        }
        candidates_.push_back(std::move(out));
        return {};
    }

    void leave_out(const Candidate& primitive, const std::string& what) {
        ++plan_.not_compressed[what];
        for (const SceneAttribute& a : primitive.attributes) used_otherwise_[a.accessor] = true;
        if (primitive.indices) used_otherwise_[*primitive.indices] = true;
    }

    void mark(const JsonValue* number) {
        const auto accessor = number == nullptr ? std::nullopt : number->integer();
        if (accessor && known(*accessor)) used_otherwise_[static_cast<std::size_t>(*accessor)] = true;
    }

    /// Marks accessors that animations, skins and instances use.
    void mark_other_uses() {
        for (const auto& animation : document_.list("animations")) {
            for (const auto& sampler : animation.value.list("samplers")) {
                mark(sampler.value.find("input"));
                mark(sampler.value.find("output"));
            }
        }
        for (const auto& skin : document_.list("skins")) mark(skin.value.find("inverseBindMatrices"));
        for (const auto& node : document_.list("nodes")) {
            const JsonValue* extensions = node.value.find("extensions");
            const JsonValue* several = extensions == nullptr ? nullptr : extensions->find("EXT_mesh_gpu_instancing");
            const JsonValue* attributes = several == nullptr ? nullptr : several->find("attributes");
            if (attributes == nullptr) continue;
            for (const auto& attribute : attributes->members) mark(&attribute.value);
        }
    }

    Result<ScenePlan> make_sets() {
        std::map<std::uint32_t, std::vector<const Candidate*>> groups;  // by the index of the first candidate
        std::map<std::uint32_t, std::uint32_t> first;                   // index of each group's first candidate
        for (std::uint32_t i = 0; i < candidates_.size(); ++i) {
            const std::uint32_t group = find(candidates_[i].attributes[0].accessor);
            groups[first.try_emplace(group, i).first->second].push_back(&candidates_[i]);
        }
        for (const auto& [number, primitives] : groups) {
            auto set = make_set(primitives);
            if (!set) {
                const PrimitivePlace at = primitives.front()->place;
                return Error{set.error().code, fmt::format("glTF: mesh {}: primitive {}: {}", at.mesh, at.primitive,
                                                           set.error().message)};
            }
            if (set->attributes.empty()) continue;
            plan_.sets.push_back(std::move(*set));
        }
        return std::move(plan_);
    }

    /// Makes the set of a group. Without attributes, the set is not compressed; its primitives have been counted.
    Result<VertexSet> make_set(const std::vector<const Candidate*>& primitives) {
        VertexSet set;
        set.keep_order = keep_order_;
        const auto refuse = [&](const std::string& why) {
            for (const Candidate* primitive : primitives) leave_out(*primitive, why);
            return VertexSet{};
        };
        std::set<std::uint32_t> taken;  // accessors
        std::map<std::string, std::size_t> names;
        for (const Candidate* primitive : primitives) {
            set.keep_order = set.keep_order || primitive->in_order;
            for (const SceneAttribute& a : primitive->attributes) {
                if (!taken.insert(a.accessor).second) continue;
                const std::size_t count = ++names[a.name];
                set.attributes.push_back({a.accessor, count == 1 ? a.name : fmt::format("{}#{}", a.name, count)});
            }
        }
        const auto position = std::find_if(set.attributes.begin(), set.attributes.end(),
                                           [](const SceneAttribute& a) { return a.name == "POSITION"; });
        std::rotate(set.attributes.begin(), position, position + 1);
        bool first = true;
        for (const SceneAttribute& a : set.attributes) {
            const auto view = view_accessor(file_, static_cast<int>(a.accessor));
            if (!view && view.error().code == ErrorCode::unsupported) {
                if (!is_padded_matrix(file_.model.accessors[a.accessor])) return view.error();
                return refuse("triangles with matrices of small integers");
            }
            if (!view) return Error{view.error().code, fmt::format("{}: {}", shown(a.name), view.error().message)};
            const bool is_position = a.name.starts_with("POSITION");
            if (is_position && (view->components != 3 || view->type == ComponentType::u32)) {
                return malformed("{} is not 3 floats or small integers", shown(a.name));
            }
            if (!first && view->count != set.vertices) {
                return malformed("{} has {} elements, POSITION {}", shown(a.name), view->count, set.vertices);
            }
            first = false;
            set.vertices = view->count;
            if (is_indices_[a.accessor]) return refuse("triangles with an accessor for indices and attributes");
            if (lacks_positions_[a.accessor])
                return refuse("triangles that share vertices with some without positions");
            set.keep_order = set.keep_order || used_otherwise_[a.accessor];
        }
        std::map<std::pair<std::uint32_t, int>, std::size_t> parts;
        for (const Candidate* primitive : primitives) {
            const std::pair key{primitive->indices.value_or(kNone), primitive->mode};
            const auto [at, added] = parts.emplace(key, set.parts.size());
            if (added) set.parts.push_back({primitive->indices, primitive->mode, {}});
            set.parts[at->second].primitives.push_back(primitive->place);
            if (primitive->indices && used_otherwise_[*primitive->indices]) {
                return refuse("triangles whose indices something else uses");
            }
        }
        std::set<std::uint32_t> indices;
        for (const ScenePart& part : set.parts) {
            if (part.indices && !indices.insert(*part.indices).second) {
                return refuse("triangles whose indices are a strip and a list");
            }
        }
        return set;
    }

    const JsonValue& document_;
    GltfFile& file_;
    bool keep_order_;
    std::size_t accessors_;
    std::vector<std::uint32_t> group_;
    std::vector<bool> used_otherwise_, is_indices_;
    /// Attributes of triangles without positions. Compressing their accessors would make readers of a packed document
    /// treat these triangles as a part.
    std::vector<bool> lacks_positions_;
    std::vector<Candidate> candidates_;
    ScenePlan plan_;
};

}  // namespace

Result<ScenePlan> plan_scene(const JsonValue& document, GltfFile& file, bool keep_order) {
    return Planner(document, file, keep_order).run();
}

}  // namespace lacedring::detail
