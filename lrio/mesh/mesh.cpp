#include "lacedring/mesh.hpp"

#include <cmath>
#include <cstring>

#include "lrcore/base/vec3.h"

namespace lacedring {

using detail::cross, detail::minus, detail::Vec3;

const Attribute* find_attribute(const Mesh& mesh, std::string_view name) {
    for (const Attribute& attribute : mesh.attributes) {
        if (attribute.name == name) return &attribute;
    }
    return nullptr;
}

Positions positions_of(const Mesh& mesh) {
    const Attribute* position = find_attribute(mesh, "POSITION");
    if (position == nullptr || position->components != 3) return {};
    if (position->type != ComponentType::f32 && position->type != ComponentType::f64) return {};
    return {position->data, position->type == ComponentType::f64};
}

std::vector<float> positions_f32(const Mesh& mesh) {
    std::vector<float> out(std::size_t{mesh.vertex_count} * 3);
    const Attribute* position = find_attribute(mesh, "POSITION");
    if (out.empty() || position == nullptr || position->components != 3) return out;
    if (position->type == ComponentType::f32) {
        std::memcpy(out.data(), position->data.data(), out.size() * sizeof(float));
    } else if (position->type == ComponentType::f64) {
        for (std::size_t i = 0; i < out.size(); ++i) {
            double value = 0;
            std::memcpy(&value, position->data.data() + i * sizeof(double), sizeof(double));
            out[i] = static_cast<float>(value);
        }
    }
    return out;
}

std::vector<float> normals_f32(const Mesh& mesh) {
    const std::size_t count = mesh.vertex_count;
    std::vector<float> out(count * 3, 0.0F);
    if (out.empty()) return out;
    const Attribute* normal = find_attribute(mesh, "NORMAL");
    if (normal != nullptr && normal->type == ComponentType::f32 && normal->components == 3) {
        std::memcpy(out.data(), normal->data.data(), out.size() * sizeof(float));
    } else {
        const std::vector<float> p = positions_f32(mesh);
        for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
            const auto at = [&](std::size_t k) { return std::size_t{mesh.indices[3 * t + k]} * 3; };
            const auto position = [&](std::size_t i) { return Vec3<float>{p[i], p[i + 1], p[i + 2]}; };
            const std::size_t a = at(0), b = at(1), c = at(2);
            const Vec3<float> n = cross(minus(position(b), position(a)), minus(position(c), position(a)));
            for (const std::size_t v : {a, b, c}) {
                for (std::size_t i = 0; i < 3; ++i) out[v + i] += n[i];
            }
        }
    }
    for (std::size_t v = 0; v < count; ++v) {
        float* n = &out[v * 3];
        const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        if (length > 0.0F && std::isfinite(length)) {
            for (int i = 0; i < 3; ++i) n[i] /= length;
        } else {
            n[0] = n[1] = 0.0F;
            n[2] = 1.0F;
        }
    }
    return out;
}

std::vector<Attribute> permute_attributes(std::span<const Attribute> attributes, std::span<const std::uint32_t> order) {
    std::vector<Attribute> out;
    out.reserve(attributes.size());
    for (const Attribute& from : attributes) {
        Attribute to{from.name, from.type, from.components, from.normalized, {}, from.v_up};
        const std::size_t stride = from.stride();
        to.data.resize(order.size() * stride);
        for (std::size_t i = 0; i < order.size(); ++i) {
            std::memcpy(to.data.data() + i * stride, from.data.data() + order[i] * stride, stride);
        }
        out.push_back(std::move(to));
    }
    return out;
}

}  // namespace lacedring
