// glTF and GLB: every triangle of the default scene in one list, node transforms applied.

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "lrio/gltf/gltf_accessor.h"
#include "lrio/gltf/gltf_file.h"
#include "lrio/gltf/gltf_scene.h"
#include "lrio/mesh/read_formats.h"

namespace lacedring::detail {
namespace {

using NamedViews = std::map<std::string, AccessorView>;

/// Vertices that one or more primitives of a mesh use: those with the same accessors share them, as in the file.
struct VertexBlock {
    const std::map<std::string, int>* accessors = nullptr;
    NamedViews views;
    std::size_t count = 0;
};

struct Primitive {
    std::size_t block = 0;
    int mode = TINYGLTF_MODE_TRIANGLES;
    std::size_t number = 0;  // in its mesh
    std::optional<AccessorView> indices;

    std::size_t corner_count(std::size_t vertices) const {
        const std::size_t count = indices ? indices->count : vertices;
        if (mode == TINYGLTF_MODE_TRIANGLES) return count;
        return count < 3 ? 0 : (count - 2) * 3;
    }
};

struct MeshPlan {
    bool made = false;
    std::vector<VertexBlock> blocks;
    std::vector<Primitive> primitives;
    double vertices = 0, corners = 0;  ///< of all of them
};

bool is_direction(const Attribute& attribute) {
    return (attribute.name == "NORMAL" && attribute.components == 3) ||
           (attribute.name == "TANGENT" && attribute.components == 4);
}

class GltfReader {
  public:
    GltfReader(GltfFile& file, Reading& reading, std::size_t file_bytes)
        : file_(file), model_(file.model), reading_(reading), file_bytes_(file_bytes) {}

    Result<Mesh> read() {
        const auto instances = place_meshes(file_, reading_, file_bytes_);
        if (!instances) return instances.error();
        plans_.resize(model_.meshes.size());
        for (const MeshInstance& instance : *instances) {
            if (auto good = plan(instance.mesh); !good) return good.error();
        }
        choose_attributes(*instances);
        if (auto good = allocate(*instances); !good) return good.error();
        for (const MeshInstance& instance : *instances) {
            if (auto good = append(instance); !good) return good.error();
        }
        tell_what_is_left_out(*instances);
        return checked(std::move(mesh_));
    }

  private:
    Result<void> plan(std::size_t mesh) {
        MeshPlan& plan = plans_[mesh];
        if (plan.made) return {};
        plan.made = true;
        const auto& primitives = model_.meshes[mesh].primitives;
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            if (auto good = plan_primitive(plan, primitives[p], p); !good) {
                return Error{good.error().code,
                             fmt::format("glTF: mesh {}: primitive {}: {}", mesh, p, good.error().message)};
            }
        }
        return {};
    }

    Result<void> plan_primitive(MeshPlan& plan, const tinygltf::Primitive& from, std::size_t number) {
        if (from.mode < TINYGLTF_MODE_POINTS || from.mode > TINYGLTF_MODE_TRIANGLE_FAN) {
            return malformed("mode {}", from.mode);
        }
        if (from.mode < TINYGLTF_MODE_TRIANGLES) {
            ++(from.mode == TINYGLTF_MODE_POINTS ? points_ : lines_);
            return {};
        }
        if (!from.attributes.contains("POSITION")) {
            ++without_position_;
            return {};
        }
        morph_targets_ += from.targets.size();
        Primitive primitive;
        primitive.mode = from.mode;
        primitive.number = number;
        const auto block = find_block(plan, from);
        if (!block) return block.error();
        primitive.block = *block;
        if (from.indices != -1) {
            const auto view = view_accessor(file_, from.indices);
            if (!view) return view.error();
            const bool is_unsigned =
                view->type == ComponentType::u8 || view->type == ComponentType::u16 || view->type == ComponentType::u32;
            if (!is_unsigned || view->components != 1) return malformed("the indices are not unsigned scalars");
            primitive.indices = *view;
        }
        const std::size_t corners = primitive.corner_count(plan.blocks[primitive.block].count);
        if (corners % 3 != 0) return malformed("{} indices are not triangles", corners);
        if (corners == 0) return {};  // placed a million times, nothing would still be work
        plan.corners += static_cast<double>(corners);
        plan.primitives.push_back(primitive);
        return {};
    }

    Result<std::size_t> find_block(MeshPlan& plan, const tinygltf::Primitive& from) {
        // Only the latest block: primitives that share vertices follow one another, and a search could be quadratic.
        if (!plan.blocks.empty() && *plan.blocks.back().accessors == from.attributes) return plan.blocks.size() - 1;
        VertexBlock block;
        block.accessors = &from.attributes;
        for (const auto& [name, accessor] : from.attributes) {
            const auto view = view_accessor(file_, accessor);
            if (!view && view.error().code == ErrorCode::unsupported &&
                is_padded_matrix(model_.accessors[static_cast<std::size_t>(accessor)])) {  // no mesh can hold it
                dropped_.insert(name);
                continue;
            }
            if (!view) return Error{view.error().code, fmt::format("{}: {}", shown(name), view.error().message)};
            block.views.emplace(name, *view);
        }
        const auto position = block.views.find("POSITION");
        if (position == block.views.end() || position->second.components != 3 ||
            position->second.type == ComponentType::u32) {
            return malformed("POSITION is not 3 floats or small integers");
        }
        const bool has_bytes = position->second.values.data != nullptr || position->second.sparse_count > 0;
        if (!has_bytes && position->second.count > 0 && from.extensions.contains("KHR_draco_mesh_compression")) {
            return unsupported("compressed with KHR_draco_mesh_compression, and this build has no libdraco");
        }
        block.count = position->second.count;
        plan.vertices += static_cast<double>(block.count);
        for (const auto& [name, view] : block.views) {
            if (view.count != block.count) {
                return malformed("{} has {} elements, POSITION {}", shown(name), view.count, block.count);
            }
        }
        plan.blocks.push_back(std::move(block));
        return plan.blocks.size() - 1;
    }

    /// Those that every block has alike. Integer normals and tangents that a node turns become floats.
    void choose_attributes(const std::vector<MeshInstance>& instances) {
        const bool moved = std::any_of(instances.begin(), instances.end(),
                                       [](const MeshInstance& i) { return !i.transform.is_identity(); });
        bool first = true;
        for (const MeshPlan& plan : plans_) {
            for (const VertexBlock& block : plan.blocks) {
                if (first) {
                    for (const auto& [name, view] : block.views) {
                        mesh_.attributes.push_back({name, view.type, view.components, view.normalized, {}});
                    }
                    first = false;
                    continue;
                }
                std::erase_if(mesh_.attributes, [&block](const Attribute& attribute) {
                    if (attribute.name == "POSITION") return false;
                    const auto view = block.views.find(attribute.name);
                    return view == block.views.end() || view->second.type != attribute.type ||
                           view->second.components != attribute.components ||
                           view->second.normalized != attribute.normalized;
                });
            }
        }
        std::set<std::string_view> kept;
        for (const Attribute& attribute : mesh_.attributes) kept.insert(attribute.name);
        for (const MeshPlan& plan : plans_) {
            for (const VertexBlock& block : plan.blocks) {
                for (const auto& [name, view] : block.views) {
                    if (!kept.contains(name)) dropped_.insert(name);
                }
            }
        }
        std::stable_partition(mesh_.attributes.begin(), mesh_.attributes.end(),
                              [](const Attribute& attribute) { return attribute.name == "POSITION"; });
        for (Attribute& attribute : mesh_.attributes) {
            if (attribute.name != "POSITION" && !(moved && is_direction(attribute))) continue;
            attribute.type = ComponentType::f32;
            attribute.normalized = false;
        }
    }

    Result<void> allocate(const std::vector<MeshInstance>& instances) {
        double vertices = 0;
        double corners = 0;
        for (const MeshInstance& instance : instances) {
            vertices += plans_[instance.mesh].vertices;
            corners += plans_[instance.mesh].corners;
        }
        if (vertices > static_cast<double>(max_vertices)) return too_many_vertices();
        double stride = 0;
        for (const Attribute& attribute : mesh_.attributes) stride += static_cast<double>(attribute.stride());
        const auto room = reading_.check_memory(vertices, stride, corners / 3,
                                                static_cast<double>(file_bytes_ + file_.buffers.loaded_bytes()));
        if (!room) return room;
        for (Attribute& attribute : mesh_.attributes) {
            attribute.data.reserve(static_cast<std::size_t>(vertices) * attribute.stride());
        }
        mesh_.indices.reserve(static_cast<std::size_t>(corners));
        return {};
    }

    Result<void> append(const MeshInstance& instance) {
        const MeshPlan& plan = plans_[instance.mesh];
        const bool mirrors = instance.transform.determinant() < 0;
        std::vector<std::uint32_t> first_vertices;
        for (const VertexBlock& block : plan.blocks) {
            first_vertices.push_back(mesh_.vertex_count);
            for (Attribute& attribute : mesh_.attributes) {
                if (auto good = append_values(block.views.at(attribute.name), instance.transform, mirrors, attribute);
                    !good) {
                    return Error{good.error().code, fmt::format("glTF: mesh {}: {}: {}", instance.mesh,
                                                                shown(attribute.name), good.error().message)};
                }
            }
            mesh_.vertex_count += static_cast<std::uint32_t>(block.count);
        }
        for (const Primitive& primitive : plan.primitives) {
            const std::size_t from = mesh_.indices.size();
            if (auto good =
                    append_triangles(primitive, first_vertices[primitive.block], plan.blocks[primitive.block].count);
                !good) {
                return Error{good.error().code, fmt::format("glTF: mesh {}: primitive {}: {}", instance.mesh,
                                                            primitive.number, good.error().message)};
            }
            if (!mirrors) continue;
            for (std::size_t i = from; i < mesh_.indices.size(); i += 3) {
                std::swap(mesh_.indices[i + 1], mesh_.indices[i + 2]);
            }
        }
        return {};
    }

    Result<void> append_values(const AccessorView& view, const Transform& transform, bool mirrors, Attribute& to) {
        const bool turns = !transform.is_identity() && (to.name == "POSITION" || is_direction(to));
        const std::size_t at = to.data.size();
        if (!turns && view.type == to.type) {
            to.data.resize(at + view.count * view.element_bytes());
            return copy_elements(view, to.data.data() + at);
        }
        std::vector<std::byte> packed(view.count * view.element_bytes());
        if (auto good = copy_elements(view, packed.data()); !good) return good;
        to.data.resize(at + view.count * to.stride());
        const std::array<double, 9> cofactors = transform.cofactors();
        const std::size_t width = view.components;
        for (std::size_t i = 0; i < view.count; ++i) {
            std::array<double, 4> value{};
            for (std::size_t c = 0; c < width; ++c) {
                value[c] = component_at(packed.data(), view.type, view.normalized, i * width + c);
            }
            if (turns) {
                Vector3 xyz{value[0], value[1], value[2]};
                if (to.name == "POSITION") {
                    xyz = transform_point(transform, xyz);
                } else if (to.name == "NORMAL") {
                    xyz = normalized(transform_normal(cofactors, mirrors, xyz));
                } else {
                    xyz = normalized(transform_direction(transform, xyz));
                }
                std::copy(xyz.begin(), xyz.end(), value.begin());
            }
            for (std::size_t c = 0; c < width; ++c) {
                const auto rounded = static_cast<float>(value[c]);
                std::memcpy(to.data.data() + at + (i * width + c) * sizeof(float), &rounded, sizeof(float));
            }
        }
        return {};
    }

    Result<void> append_triangles(const Primitive& primitive, std::uint32_t first_vertex, std::size_t vertices) {
        std::vector<std::uint32_t> list(primitive.indices ? primitive.indices->count : vertices);
        if (primitive.indices) {
            std::vector<std::byte> packed(primitive.indices->count * primitive.indices->element_bytes());
            if (auto good = copy_elements(*primitive.indices, packed.data()); !good) return good;
            for (std::size_t i = 0; i < list.size(); ++i) {
                const std::uint32_t index = unsigned_at(packed.data(), primitive.indices->type, i);
                if (index >= vertices) {
                    return malformed("index {} at place {} is out of range ({} vertices)", index, i, vertices);
                }
                list[i] = first_vertex + index;
            }
        } else {
            for (std::size_t i = 0; i < list.size(); ++i) list[i] = first_vertex + static_cast<std::uint32_t>(i);
        }
        if (primitive.mode == TINYGLTF_MODE_TRIANGLES) {
            mesh_.indices.insert(mesh_.indices.end(), list.begin(), list.end());
        } else if (primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
            Strip strip;
            for (const std::uint32_t v : list) strip.add(v, mesh_.indices);
        } else {  // the order of the specification: the fan's middle is each triangle's last corner
            for (std::size_t i = 2; i < list.size(); ++i) {
                mesh_.indices.insert(mesh_.indices.end(), {list[i - 1], list[i], list[0]});
            }
        }
        return {};
    }

    void tell_what_is_left_out(const std::vector<MeshInstance>& instances) {
        std::size_t placed = 0, primitives = 0;
        for (const MeshPlan& plan : plans_) {
            placed += plan.made ? 1 : 0;
            primitives += plan.primitives.size();
        }
        if (model_.nodes.size() > 1) {
            reading_.leave_out(model_.nodes.size(), "node", "nodes (their transforms are applied)");
        }
        reading_.leave_out(instances.size() - placed, "instance (its triangles are repeated)",
                           "instances (their triangles are repeated)");
        if (primitives > 1) reading_.leave_out(primitives, "", "primitives (joined into one)");
        reading_.leave_out(morph_targets_, "morph target", "morph targets");
        reading_.leave_out(points_, "primitive of points", "primitives of points");
        reading_.leave_out(lines_, "primitive of lines", "primitives of lines");
        reading_.leave_out(without_position_, "primitive without positions", "primitives without positions");
        if (dropped_.empty()) return;
        const std::string names = shown_names(std::vector<std::string>(dropped_.begin(), dropped_.end()));
        reading_.leave_out(dropped_.size(), fmt::format("attribute that not every primitive has alike ({})", names),
                           fmt::format("attributes that not every primitive has alike ({})", names));
    }

    GltfFile& file_;
    const tinygltf::Model& model_;
    Reading& reading_;
    std::size_t file_bytes_;
    std::vector<MeshPlan> plans_;
    Mesh mesh_;
    std::size_t points_ = 0, lines_ = 0, without_position_ = 0, morph_targets_ = 0;
    std::set<std::string> dropped_;  ///< attributes
};

}  // namespace

Result<Mesh> read_gltf(std::span<const std::byte> bytes, Reading& reading) {
    auto file = load_gltf(bytes, reading);
    if (!file) return file.error();
    return GltfReader(*file, reading, bytes.size()).read();
}

}  // namespace lacedring::detail
