// Reads glTF and GLB: joins all triangles of the default scene into one mesh, with node transforms applied.

#include <algorithm>
#include <cstring>
#include <optional>
#include <set>
#include <string>

#include "lacedring/surface.hpp"
#include "lrcore/base/try.h"
#include "lrio/gltf/gltf_accessor.h"
#include "lrio/gltf/gltf_file.h"
#include "lrio/gltf/gltf_materials.h"
#include "lrio/gltf/gltf_primitives.h"
#include "lrio/gltf/gltf_scene.h"
#include "lrio/gltf/gltf_values.h"
#include "lrio/mesh/read_formats.h"
#include "lrio/scene/plain_scene.h"

namespace lacedring::detail {
namespace {

const AccessorView* view_of(const VertexBlock& block, const std::string& name) {
    const auto view = block.views.find(name);
    return view == block.views.end() ? nullptr : &view->second;
}

bool has_normals(const VertexBlock& block) {
    const AccessorView* normals = view_of(block, "NORMAL");
    return normals != nullptr && normals->components == 3;
}

class GltfJoiner {
  public:
    GltfJoiner(GltfFile& file, Reading& reading, std::size_t file_bytes)
        : file_(file), reading_(reading), file_bytes_(file_bytes), plans_(file, reading) {}

    Result<Mesh> read() {
        LR_ASSIGN(const auto instances, place_meshes(file_, reading_, file_bytes_));
        LR_TRY(plans_.make(instances));
        choose_attributes(instances);
        if (reading_.materials != nullptr) {
            LR_ASSIGN(auto materials, read_materials(file_, reading_));
            *reading_.materials = std::move(materials);
            flat_.resize(reading_.materials->materials.size());
        }
        LR_TRY(allocate(instances));
        for (const MeshInstance& instance : instances) {
            LR_TRY(append(instance));
        }
        make_normals();
        tell_what_is_left_out(instances);
        return checked(std::move(mesh_));
    }

  private:
    template <class Visit>
    void for_each_block(const Visit& visit) const {
        for (const MeshPlan& plan : plans_.meshes()) {
            for (const VertexBlock& block : plan.blocks) visit(block);
        }
    }

    /// Keeps the attributes that all blocks have with the same type, and NORMAL if any block has it, since dropping it
    /// would change the shading. Integer normals and tangents that a node transforms become floats.
    void choose_attributes(const std::vector<MeshInstance>& instances) {
        const bool moved = std::any_of(instances.begin(), instances.end(),
                                       [](const MeshInstance& i) { return !i.transform.is_identity(); });
        bool first = true;
        std::size_t blocks = 0, with_normals = 0;
        for_each_block([&](const VertexBlock& block) {
            ++blocks;
            with_normals += has_normals(block) ? 1 : 0;
            if (first) {
                for (const auto& [name, view] : block.views) {
                    mesh_.attributes.push_back({name, view.type, view.components, view.normalized, {}});
                }
                first = false;
                return;
            }
            std::erase_if(mesh_.attributes, [&block](const Attribute& attribute) {
                if (attribute.name == "POSITION") return false;
                const AccessorView* view = view_of(block, attribute.name);
                return view == nullptr || view->type != attribute.type || view->components != attribute.components ||
                       view->normalized != attribute.normalized;
            });
        });
        if (with_normals > 0 && find_attribute(mesh_, "NORMAL") == nullptr) {
            mesh_.attributes.push_back({"NORMAL", ComponentType::f32, 3, false, {}});
            makes_normals_ = with_normals < blocks;
        }
        if (reading_.materials != nullptr) keep_for_materials();
        std::set<std::string_view> kept;
        for (const Attribute& attribute : mesh_.attributes) kept.insert(attribute.name);
        for_each_block([&](const VertexBlock& block) {
            for (const auto& [name, view] : block.views) {
                if (!kept.contains(name)) dropped_.insert(name);
            }
        });
        std::sort(mesh_.attributes.begin(), mesh_.attributes.end(), [](const Attribute& a, const Attribute& b) {
            const bool first_a = a.name == "POSITION", first_b = b.name == "POSITION";
            return first_a != first_b ? first_a : a.name < b.name;
        });
        for (Attribute& attribute : mesh_.attributes) {
            if (attribute.name != "POSITION" && !(moved && is_direction(attribute))) continue;
            attribute.type = ComponentType::f32;
            attribute.normalized = false;
        }
    }

    /// Number of components of an attribute that materials use; 0: they do not use the attribute.
    static std::uint8_t shading_components(std::string_view name) {
        return name == "TEXCOORD_0" || name == "TEXCOORD_1" ? 2 : name == "COLOR_0" ? 4 : 0;
    }
    static bool is_shading(const std::string& name, const AccessorView& view) {
        return view.components == shading_components(name) || (name == "COLOR_0" && view.components == 3);
    }

    /// Keeps each attribute that materials use if any block has it, and makes it floats.
    void keep_for_materials() {
        std::erase_if(mesh_.attributes, [](const Attribute& a) { return shading_components(a.name) != 0; });
        for (const char* name : {"TEXCOORD_0", "TEXCOORD_1", "COLOR_0"}) {
            bool is_there = false;
            for_each_block([&](const VertexBlock& block) {
                const AccessorView* view = view_of(block, name);
                is_there |= view != nullptr && is_shading(name, *view);
            });
            if (is_there) mesh_.attributes.push_back({name, ComponentType::f32, shading_components(name), false, {}});
        }
    }

    /// Appends a block's values; if it lacks the attribute, appends 1 for colors, else 0.
    static Result<void> append_shading(const VertexBlock& block, Attribute& to) {
        const std::size_t n = to.components;
        std::vector<float> values(block.count * n, to.name == "COLOR_0" ? 1.0F : 0.0F);
        if (const AccessorView* view = view_of(block, to.name); view != nullptr && is_shading(to.name, *view)) {
            std::vector<std::byte> packed(view->count * view->element_bytes());
            if (auto good = copy_elements(*view, packed.data()); !good) return good;
            for (std::size_t i = 0; i < block.count; ++i) {
                for (std::size_t c = 0; c < view->components; ++c) {
                    const double value =
                        component_at(packed.data(), view->type, view->normalized, i * view->components + c);
                    values[i * n + c] = static_cast<float>(value);
                }
            }
        }
        const auto bytes = std::as_bytes(std::span(values));
        to.data.insert(to.data.end(), bytes.begin(), bytes.end());
        return {};
    }

    Result<void> allocate(const std::vector<MeshInstance>& instances) {
        double vertices = 0;
        double corners = 0;
        for (const MeshInstance& instance : instances) {
            vertices += plans_.meshes()[instance.mesh].vertices;
            corners += plans_.meshes()[instance.mesh].corners;
        }
        if (vertices > static_cast<double>(max_vertices)) return too_many_vertices();
        double stride = 0;
        for (const Attribute& attribute : mesh_.attributes) stride += static_cast<double>(attribute.stride());
        constexpr double kSurface = 12 + 15 + 3 * 12;  // bytes: find_surface's, two positions and a normal
        auto room = reading_.check_memory(vertices, stride + (makes_normals_ ? kSurface : 0), corners / 3,
                                          static_cast<double>(file_bytes_ + file_.buffers.loaded_bytes()));
        if (!room) return room;
        for (Attribute& attribute : mesh_.attributes) {
            attribute.data.reserve(static_cast<std::size_t>(vertices) * attribute.stride());
        }
        mesh_.indices.reserve(static_cast<std::size_t>(corners));
        return {};
    }

    Result<void> append(const MeshInstance& instance) {
        const MeshPlan& plan = plans_.meshes()[instance.mesh];
        std::vector<std::uint32_t> first_vertices;
        for (const VertexBlock& block : plan.blocks) {
            first_vertices.push_back(mesh_.vertex_count);
            for (Attribute& attribute : mesh_.attributes) {
                if (makes_normals_ && attribute.name == "NORMAL" && !has_normals(block)) {
                    attribute.data.resize(attribute.data.size() + block.count * attribute.stride());
                    continue;
                }
                const bool shades = reading_.materials != nullptr && shading_components(attribute.name) != 0;
                const auto good = shades ? append_shading(block, attribute)
                                         : append_values(block.views.at(attribute.name), instance.transform, attribute);
                if (!good) {
                    return Error{good.error().code, fmt::format("glTF: mesh {}: {}: {}", instance.mesh,
                                                                shown(attribute.name), good.error().message)};
                }
            }
            mesh_.vertex_count += static_cast<std::uint32_t>(block.count);
        }
        for (const PrimitivePlan& primitive : plan.primitives) {
            const VertexBlock& block = plan.blocks[primitive.block];
            const std::size_t from = mesh_.indices.size();
            if (auto good = append_triangles(primitive, first_vertices[primitive.block], block.count, mesh_.indices);
                !good) {
                return Error{good.error().code, fmt::format("glTF: mesh {}: primitive {}: {}", instance.mesh,
                                                            primitive.number, good.error().message)};
            }
            const auto added = std::span(mesh_.indices).subspan(from);
            if (instance.transform.determinant() < 0) reverse_orientation(added);
            if (reading_.materials != nullptr) {
                const int said = file_.model.meshes[instance.mesh].primitives[primitive.number].material;
                const std::uint32_t material = material_of(said, has_normals(block));
                reading_.materials->of_triangle.resize(mesh_.indices.size() / 3, material);
            }
            if (makes_normals_ && !has_normals(block))
                without_normals_.insert(without_normals_.end(), added.begin(), added.end());
        }
        return {};
    }

    /// The index of a primitive's material, or of its flat-shaded copy if the primitive has no normals; the copy is
    /// made at its first use. Primitives without a material get the default one, which read_materials appends.
    std::uint32_t material_of(int said, bool smooth) {
        const std::size_t usual = flat_.size() - 1;
        const std::size_t material = said < 0 ? usual : std::min(static_cast<std::size_t>(said), usual);
        std::vector<Material>& all = reading_.materials->materials;
        if (smooth) return static_cast<std::uint32_t>(material);
        if (flat_[material] == 0) {
            flat_[material] = static_cast<std::uint32_t>(all.size());
            all.push_back(Material(all[material]));
            all.back().flat = true;
        }
        return flat_[material];
    }

    /// Computes normals for the primitives without normals, from the surface that these primitives form together.
    void make_normals() {
        if (without_normals_.empty()) return;
        Attribute& normals = *std::find_if(mesh_.attributes.begin(), mesh_.attributes.end(),
                                           [](const Attribute& a) { return a.name == "NORMAL"; });
        const Mesh bare{mesh_.vertex_count, std::move(without_normals_), {mesh_.attributes.front()}};
        const Surface surface = find_surface(bare);
        const std::vector<float> made = normals_f32(surface_mesh(bare, surface));
        for (const std::uint32_t v : bare.indices) {
            const std::size_t from = surface.has_seams() ? surface.vertex_of[v] : v;
            std::memcpy(normals.data.data() + v * normals.stride(), &made[3 * from], normals.stride());
        }
    }

    void tell_what_is_left_out(const std::vector<MeshInstance>& instances) {
        tell_of_nodes(file_, plans_, instances, reading_);
        reading_.report.primitives = plans_.primitive_count();
        if (reading_.report.primitives > 1) {
            reading_.leave_out(reading_.report.primitives, "", "primitives (joined into one)");
        }
        plans_.tell_what_is_left_out();
        std::size_t made = 0;
        for (const MeshPlan& plan : plans_.meshes()) {
            for (const PrimitivePlan& primitive : plan.primitives) {
                made += makes_normals_ && !has_normals(plan.blocks[primitive.block]) ? 1 : 0;
            }
        }
        reading_.leave_out(made, "primitive without normals (made from its triangles)",
                           "primitives without normals (made from their triangles)");
        if (dropped_.empty()) return;
        const std::string names = shown_names(std::vector<std::string>(dropped_.begin(), dropped_.end()));
        reading_.leave_out(dropped_.size(), fmt::format("attribute that not every primitive has alike ({})", names),
                           fmt::format("attributes that not every primitive has alike ({})", names));
    }

    GltfFile& file_;
    Reading& reading_;
    std::size_t file_bytes_;
    MeshPlans plans_;
    Mesh mesh_;
    bool makes_normals_ = false;                  ///< some primitives have normals, others get computed ones
    std::vector<std::uint32_t> without_normals_;  ///< the triangles of primitives without normals
    std::vector<std::uint32_t> flat_;             ///< the flat-shaded copy of each material; 0: none yet
    std::set<std::string> dropped_;               ///< names of attributes that the mesh lacks
};

}  // namespace

Result<Mesh> read_gltf(std::span<const std::byte> bytes, Reading& reading) {
    LR_ASSIGN(const auto source, PlainScene::open(bytes, reading));
    LR_ASSIGN(const auto chunks, source.chunks());
    LR_ASSIGN(auto file, load_gltf(chunks, source.file_bytes, reading));
    return GltfJoiner(file, reading, source.file_bytes).read();
}

}  // namespace lacedring::detail
