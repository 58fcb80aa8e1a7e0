#include "lrio/gltf/gltf_values.h"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "lacedring/primitives.hpp"

namespace lacedring {
namespace detail {
namespace {

/// Appends packed values to `to` as floats, transformed if `to` is POSITION or a direction.
void append_floats(const std::byte* packed, const Attribute& from, std::size_t count, const Transform& transform,
                   Attribute& to) {
    const bool turns = !transform.is_identity() && (to.name == "POSITION" || is_direction(to));
    const bool mirrors = transform.determinant() < 0;
    const std::size_t at = to.data.size();
    to.data.resize(at + count * to.stride());
    const std::array<double, 9> cofactors = transform.cofactors();
    const std::size_t width = from.components;
    for (std::size_t i = 0; i < count; ++i) {
        std::array<double, 4> value{};
        for (std::size_t c = 0; c < width; ++c) {
            value[c] = component_at(packed, from.type, from.normalized, i * width + c);
        }
        if (turns) {
            Vector3 xyz{value[0], value[1], value[2]};
            if (to.name == "POSITION") {
                if (from.normalized) {  // rounds to floats first, as read_primitives does
                    for (double& x : xyz) x = static_cast<float>(x);
                }
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
}

}  // namespace

bool is_direction(const Attribute& attribute) {
    return (attribute.name == "NORMAL" && attribute.components == 3) ||
           (attribute.name == "TANGENT" && attribute.components == 4);
}

Result<void> append_values(const AccessorView& view, const Transform& transform, Attribute& to) {
    const bool turns = !transform.is_identity() && (to.name == "POSITION" || is_direction(to));
    if (!turns && view.type == to.type) {
        const std::size_t at = to.data.size();
        to.data.resize(at + view.count * view.element_bytes());
        return copy_elements(view, to.data.data() + at);
    }
    std::vector<std::byte> packed(view.count * view.element_bytes());
    if (auto good = copy_elements(view, packed.data()); !good) return good;
    append_floats(packed.data(), {to.name, view.type, view.components, view.normalized, {}}, view.count, transform, to);
    return {};
}

void reverse_orientation(std::span<std::uint32_t> indices) {
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) std::swap(indices[i + 1], indices[i + 2]);
}

}  // namespace detail

bool mirrors(const Placement& placement) {
    return detail::Transform{placement}.determinant() < 0;
}

Mesh place(const Mesh& mesh, const Placement& placement) {
    const detail::Transform transform{placement};
    if (transform.is_identity()) return mesh;
    Mesh out{mesh.vertex_count, mesh.indices, {}};
    for (const Attribute& from : mesh.attributes) {
        if ((from.name != "POSITION" || from.components != 3) && !detail::is_direction(from)) {
            out.attributes.push_back(from);
            continue;
        }
        Attribute to{from.name, ComponentType::f32, from.components, false, {}};
        detail::append_floats(from.data.data(), from, mesh.vertex_count, transform, to);
        out.attributes.push_back(std::move(to));
    }
    if (mirrors(placement)) detail::reverse_orientation(out.indices);
    return out;
}

}  // namespace lacedring
