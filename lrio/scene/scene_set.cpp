#include "lrio/scene/scene_set.h"

#include <cmath>
#include <cstring>

#include "lrcore/base/try.h"
#include "lrio/gltf/gltf_accessor.h"
#include "lrio/gltf/gltf_primitives.h"
#include "lrio/gltf/tinygltf.h"
#include "lrio/mesh/read_formats.h"

namespace lacedring::detail {
namespace {

Result<AccessorView> view_indices(GltfFile& file, std::uint32_t accessor) {
    auto view = view_accessor(file, static_cast<int>(accessor));
    if (!view) return view;
    const bool is_unsigned =
        view->type == ComponentType::u8 || view->type == ComponentType::u16 || view->type == ComponentType::u32;
    if (!is_unsigned || view->components != 1) return malformed("the indices are not unsigned scalars");
    return view;
}

Result<void> append_part(GltfFile& file, const ScenePart& part, std::size_t vertices,
                         std::vector<std::uint32_t>& indices) {
    PrimitivePlan plan;
    plan.mode = part.mode;
    if (part.indices) {
        LR_ASSIGN(const auto view, view_indices(file, *part.indices));
        plan.indices = view;
    }
    const std::size_t corners = plan.corner_count(vertices);
    if (corners % 3 != 0) return malformed("{} indices are not triangles", corners);
    return append_triangles(plan, 0, vertices, indices);
}

Result<Attribute> read_attribute(GltfFile& file, const SceneAttribute& from) {
    LR_ASSIGN(const auto view, view_accessor(file, static_cast<int>(from.accessor)));
    Attribute out{from.name, view.type, view.components, view.normalized, {}};
    out.data.resize(view.count * view.element_bytes());
    LR_TRY(copy_elements(view, out.data.data()));
    if (from.name != "POSITION" || out.type == ComponentType::f32) return out;
    std::vector<std::byte> floats(view.count * 3 * sizeof(float));
    for (std::size_t i = 0; i < 3 * view.count; ++i) {
        const auto value = static_cast<float>(component_at(out.data.data(), out.type, false, i));
        std::memcpy(floats.data() + i * sizeof value, &value, sizeof value);
    }
    out.type = ComponentType::f32;
    out.normalized = false;
    out.data = std::move(floats);
    return out;
}

}  // namespace

Result<SetSize> size_of_set(GltfFile& file, const VertexSet& set) {
    SetSize out;
    out.vertices = static_cast<double>(set.vertices);
    for (const SceneAttribute& a : set.attributes) {
        LR_ASSIGN(const auto view, view_accessor(file, static_cast<int>(a.accessor)));
        out.stride += static_cast<double>(view.element_bytes());
    }
    for (const ScenePart& part : set.parts) {
        std::size_t corners = set.vertices;
        if (part.indices) {
            LR_ASSIGN(const auto view, view_indices(file, *part.indices));
            corners = view.count;
        }
        out.triangles += static_cast<double>(part.mode == TINYGLTF_MODE_TRIANGLES ? corners / 3 : corners);
    }
    return out;
}

Result<SetMesh> read_set(GltfFile& file, const VertexSet& set) {
    SetMesh out;
    out.mesh.vertex_count = static_cast<std::uint32_t>(set.vertices);
    for (const SceneAttribute& a : set.attributes) {
        auto attribute = read_attribute(file, a);
        if (!attribute) {
            return Error{attribute.error().code, fmt::format("{}: {}", shown(a.name), attribute.error().message)};
        }
        const auto view = view_accessor(file, static_cast<int>(a.accessor));
        if (a.name == "POSITION") out.integer_positions = view && view->type != ComponentType::f32;
        out.mesh.attributes.push_back(std::move(*attribute));
    }
    for (const ScenePart& part : set.parts) {
        out.first_triangle.push_back(static_cast<std::uint32_t>(out.mesh.triangle_count()));
        if (auto good = append_part(file, part, set.vertices, out.mesh.indices); !good) {
            const PrimitivePlace at = part.primitives.front();
            return Error{good.error().code,
                         fmt::format("glTF: mesh {}: primitive {}: {}", at.mesh, at.primitive, good.error().message)};
        }
    }
    out.first_triangle.push_back(static_cast<std::uint32_t>(out.mesh.triangle_count()));
    return out;
}

bool has_finite_positions(const Mesh& mesh) {
    const Attribute& position = mesh.attributes.front();
    for (std::size_t i = 0; i < position.data.size(); i += sizeof(float)) {
        float value = 0;
        std::memcpy(&value, position.data.data() + i, sizeof value);
        if (!std::isfinite(value)) return false;
    }
    return true;
}

std::uint32_t drop_unused_vertices(Mesh& mesh) {
    std::vector<std::uint32_t> place(mesh.vertex_count, 0);
    for (const std::uint32_t v : mesh.indices) place[v] = 1;
    std::vector<std::uint32_t> kept;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        if (place[v] == 0) continue;
        place[v] = static_cast<std::uint32_t>(kept.size());
        kept.push_back(v);
    }
    const auto dropped = mesh.vertex_count - static_cast<std::uint32_t>(kept.size());
    if (dropped == 0) return 0;
    mesh.attributes = permute_attributes(mesh.attributes, kept);
    mesh.vertex_count = static_cast<std::uint32_t>(kept.size());
    for (std::uint32_t& v : mesh.indices) v = place[v];
    return dropped;
}

}  // namespace lacedring::detail
