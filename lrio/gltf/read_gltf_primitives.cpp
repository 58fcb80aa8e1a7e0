// Reads glTF and GLB: the triangle primitives of the default scene one by one.

#include <algorithm>
#include <span>
#include <utility>

#include "lacedring/primitives.hpp"
#include "lrcore/base/try.h"
#include "lrio/gltf/gltf_file.h"
#include "lrio/gltf/gltf_primitives.h"
#include "lrio/gltf/gltf_scene.h"
#include "lrio/gltf/gltf_values.h"
#include "lrio/mesh/read_formats.h"
#include "lrio/scene/plain_scene.h"

namespace lacedring::detail {
namespace {

/// Bytes of a vertex's attributes.
double vertex_bytes(const VertexBlock& block) {
    double bytes = 0;
    for (const auto& [name, view] : block.views) {
        bytes += static_cast<double>(name == "POSITION" ? 3 * sizeof(float) : view.element_bytes());
    }
    return bytes;
}

/// Checks the memory for all primitives and for the largest block, whose attributes are read before they are copied.
Result<void> check_room(const MeshPlans& plans, const GltfFile& file, const Reading& reading, std::size_t file_bytes) {
    double bytes = 0, corners = 0, largest = 0;
    for (const MeshPlan& plan : plans.meshes()) {
        for (const PrimitivePlan& primitive : plan.primitives) {
            const VertexBlock& block = plan.blocks[primitive.block];
            if (block.count > max_vertices) return too_many_vertices();
            const auto count = static_cast<double>(block.count);
            const auto uses = static_cast<double>(primitive.corner_count(block.count));
            bytes += vertex_bytes(block) * (block.primitives > 1 ? std::min(count, uses) : count);
            largest = std::max(largest, vertex_bytes(block) * count);
            corners += uses;
        }
    }
    return reading.check_memory(bytes + largest, 1, corners / 3,
                                static_cast<double>(file_bytes + file.buffers.loaded_bytes()));
}

Result<std::vector<Attribute>> read_attributes(const VertexBlock& block) {
    std::vector<Attribute> out;
    for (const auto& [name, view] : block.views) {
        const bool position = name == "POSITION";
        Attribute to{
            name, position ? ComponentType::f32 : view.type, view.components, !position && view.normalized, {}};
        if (auto good = append_values(view, {}, to); !good) {
            return Error{good.error().code, fmt::format("{}: {}", shown(name), good.error().message)};
        }
        out.insert(position ? out.begin() : out.end(), std::move(to));
    }
    return out;
}

/// The attributes of the vertices that the triangles use, in the same order; renumbers `indices`.
std::vector<Attribute> take_used(const std::vector<Attribute>& attributes, std::vector<std::uint32_t>& indices,
                                 std::uint32_t& vertex_count) {
    std::vector<std::uint32_t> used = indices;  // flags would cost O(block) for each of many primitives
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (std::uint32_t& v : indices) {
        v = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), v) - used.begin());
    }
    vertex_count = static_cast<std::uint32_t>(used.size());
    return permute_attributes(attributes, used);
}

Result<void> read_mesh_primitives(const MeshPlan& plan, std::size_t mesh, std::vector<Primitive>& out) {
    std::size_t in_memory = SIZE_MAX;  // index of the block in `attributes`
    std::vector<Attribute> attributes;
    for (const PrimitivePlan& from : plan.primitives) {
        const auto wrong = [&](const Error& error) {
            return Error{error.code, fmt::format("glTF: mesh {}: primitive {}: {}", mesh, from.number, error.message)};
        };
        const VertexBlock& block = plan.blocks[from.block];
        if (from.block != in_memory) {
            Result<std::vector<Attribute>> read = read_attributes(block);
            if (!read) return wrong(read.error());
            attributes = std::move(*read);
            in_memory = from.block;
        }
        Primitive primitive{mesh, from.number, PrimitiveMode::triangles, {}};
        if (from.mode != TINYGLTF_MODE_TRIANGLES) {
            primitive.mode = from.mode == TINYGLTF_MODE_TRIANGLE_STRIP ? PrimitiveMode::strip : PrimitiveMode::fan;
        }
        Mesh& geometry = primitive.geometry;
        geometry.indices.reserve(from.corner_count(block.count));
        if (auto good = append_triangles(from, 0, block.count, geometry.indices); !good) return wrong(good.error());
        if (block.primitives > 1) {
            geometry.attributes = take_used(attributes, geometry.indices, geometry.vertex_count);
        } else {
            geometry.vertex_count = static_cast<std::uint32_t>(block.count);
            geometry.attributes = std::exchange(attributes, {});
            in_memory = SIZE_MAX;
        }
        Result<Mesh> good = checked(std::move(geometry));
        if (!good) return wrong(good.error());
        geometry = std::move(*good);
        out.push_back(std::move(primitive));
    }
    return {};
}

}  // namespace

Result<PrimitiveList> read_gltf_primitives(std::span<const std::byte> bytes, Reading& reading) {
    LR_ASSIGN(const auto source, PlainScene::open(bytes, reading));
    LR_ASSIGN(const auto chunks, source.chunks());
    LR_ASSIGN(GltfFile file, load_gltf(chunks, source.file_bytes, reading));
    LR_ASSIGN(const std::vector<MeshInstance> instances, place_meshes(file, reading, source.file_bytes));
    MeshPlans plans(file, reading);
    LR_TRY(plans.make(instances));
    LR_TRY(check_room(plans, file, reading, source.file_bytes));
    PrimitiveList out;
    out.primitives.reserve(plans.primitive_count());
    for (std::size_t mesh = 0; mesh < plans.meshes().size(); ++mesh) {
        LR_TRY(read_mesh_primitives(plans.meshes()[mesh], mesh, out.primitives));
        out.mesh_names.push_back(file.model.meshes[mesh].name);
    }
    if (out.primitives.empty()) return malformed("has no triangles");
    out.placed.reserve(instances.size());
    for (const MeshInstance& instance : instances) out.placed.push_back({instance.mesh, instance.transform.m});
    plans.tell_what_is_left_out();
    reading.report.primitives = out.primitives.size();
    return out;
}

}  // namespace lacedring::detail
