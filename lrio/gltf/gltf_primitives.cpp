#include "lrio/gltf/gltf_primitives.h"

#include "lrcore/base/try.h"

namespace lacedring::detail {

Result<void> MeshPlans::make(const std::vector<MeshInstance>& instances) {
    meshes_.resize(file_.model.meshes.size());
    for (const MeshInstance& instance : instances) {
        MeshPlan& plan = meshes_[instance.mesh];
        if (plan.made) continue;
        plan.made = true;
        const auto& primitives = file_.model.meshes[instance.mesh].primitives;
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            if (auto good = plan_primitive(plan, primitives[p], p); !good) {
                return Error{good.error().code,
                             fmt::format("glTF: mesh {}: primitive {}: {}", instance.mesh, p, good.error().message)};
            }
        }
    }
    return {};
}

Result<void> MeshPlans::plan_primitive(MeshPlan& plan, const tinygltf::Primitive& from, std::size_t number) {
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
    PrimitivePlan primitive;
    primitive.mode = from.mode;
    primitive.number = number;
    LR_ASSIGN(const auto block, find_block(plan, from));
    primitive.block = block;
    if (from.indices != -1) {
        LR_ASSIGN(const auto view, view_accessor(file_, from.indices));
        const bool is_unsigned =
            view.type == ComponentType::u8 || view.type == ComponentType::u16 || view.type == ComponentType::u32;
        if (!is_unsigned || view.components != 1) return malformed("the indices are not unsigned scalars");
        primitive.indices = view;
    }
    const std::size_t corners = primitive.corner_count(plan.blocks[primitive.block].count);
    if (corners % 3 != 0) return malformed("{} indices are not triangles", corners);
    if (corners == 0) return {};  // empty primitives would cost time if the mesh is placed a million times
    plan.corners += static_cast<double>(corners);
    ++plan.blocks[primitive.block].primitives;
    plan.primitives.push_back(primitive);
    return {};
}

Result<std::size_t> MeshPlans::find_block(MeshPlan& plan, const tinygltf::Primitive& from) {
    // Compares only with the latest block: primitives that share vertices usually follow each other, and a search of
    // all blocks could take quadratic time.
    if (!plan.blocks.empty() && *plan.blocks.back().accessors == from.attributes) return plan.blocks.size() - 1;
    VertexBlock block;
    block.accessors = &from.attributes;
    for (const auto& [name, accessor] : from.attributes) {
        const auto view = view_accessor(file_, accessor);
        // A Mesh cannot hold padded matrices.
        if (!view && view.error().code == ErrorCode::unsupported &&
            is_padded_matrix(file_.model.accessors[static_cast<std::size_t>(accessor)])) {
            unreadable_.insert(name);
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

std::size_t MeshPlans::primitive_count() const {
    std::size_t count = 0;
    for (const MeshPlan& plan : meshes_) count += plan.primitives.size();
    return count;
}

void MeshPlans::tell_what_is_left_out() const {
    reading_.leave_out(morph_targets_, "morph target", "morph targets");
    reading_.leave_out(points_, "primitive of points", "primitives of points");
    reading_.leave_out(lines_, "primitive of lines", "primitives of lines");
    reading_.leave_out(without_position_, "primitive without positions", "primitives without positions");
    if (unreadable_.empty()) return;
    const std::string names = shown_names(std::vector<std::string>(unreadable_.begin(), unreadable_.end()));
    reading_.leave_out(unreadable_.size(), fmt::format("attribute of a type that is not read ({})", names),
                       fmt::format("attributes of a type that is not read ({})", names));
}

Result<void> append_triangles(const PrimitivePlan& primitive, std::uint32_t first_vertex, std::size_t vertices,
                              std::vector<std::uint32_t>& indices) {
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
        indices.insert(indices.end(), list.begin(), list.end());
    } else if (primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
        Strip strip;
        for (const std::uint32_t v : list) strip.add(v, indices);
    } else {  // in glTF's order, the fan's center is each triangle's last corner
        for (std::size_t i = 2; i < list.size(); ++i) {
            indices.insert(indices.end(), {list[i - 1], list[i], list[0]});
        }
    }
    return {};
}

void tell_of_nodes(const GltfFile& file, const MeshPlans& plans, const std::vector<MeshInstance>& instances,
                   Reading& reading) {
    std::size_t placed = 0;
    for (const MeshPlan& plan : plans.meshes()) placed += plan.made ? 1 : 0;
    if (file.model.nodes.size() > 1) {
        reading.leave_out(file.model.nodes.size(), "node", "nodes (their transforms are applied)");
    }
    reading.leave_out(instances.size() - placed, "instance (its triangles are repeated)",
                      "instances (their triangles are repeated)");
}

}  // namespace lacedring::detail
