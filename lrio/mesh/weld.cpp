#include <algorithm>
#include <cmath>
#include <cstring>

#include "lacedring/mesh_files.hpp"
#include "lrio/mesh/distinct.h"

namespace lacedring {

namespace {

/// The values of an attribute that weld compares, tightly packed.
struct Key {
    std::size_t stride;
    const std::byte* data;
};

/// A copy of the values with 0 for -0; empty if there is no -0.
template <class Real>
std::vector<std::byte> without_negative_zero(const std::vector<std::byte>& data) {
    std::vector<std::byte> out;
    for (std::size_t at = 0; at + sizeof(Real) <= data.size(); at += sizeof(Real)) {
        Real value{};
        std::memcpy(&value, data.data() + at, sizeof(Real));
        if (value != 0 || !std::signbit(value)) continue;
        if (out.empty()) out = data;
        std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(at), sizeof(Real), std::byte{0});
    }
    return out;
}

/// Counts merged vertices whose attributes differ from those of the vertex that is kept.
WeldReport differences(const Mesh& mesh, const detail::Groups& groups, const std::vector<std::uint32_t>& kept) {
    WeldReport out;
    std::vector<bool> differs(mesh.vertex_count, false);
    for (const Attribute& attribute : mesh.attributes) {
        if (attribute.name == "POSITION") continue;
        const std::size_t stride = attribute.stride();
        bool any = false;
        for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
            const std::byte* own = attribute.data.data() + v * stride;
            if (std::memcmp(own, attribute.data.data() + kept[groups.of[v]] * stride, stride) == 0) continue;
            any = true;
            if (!differs[v]) ++out.vertices;
            differs[v] = true;
        }
        if (any) out.attributes.push_back(attribute.name);
    }
    return out;
}

}  // namespace

Mesh weld(const Mesh& mesh, Weld mode, WeldReport* report) {
    if (mode == Weld::none) return mesh;
    const Attribute* position = find_attribute(mesh, "POSITION");
    std::vector<std::byte> positions;  // without -0; empty if the attribute has none
    if (position != nullptr && position->type == ComponentType::f32)
        positions = without_negative_zero<float>(position->data);
    if (position != nullptr && position->type == ComponentType::f64)
        positions = without_negative_zero<double>(position->data);
    std::vector<Key> keys;
    for (const Attribute& attribute : mesh.attributes) {
        if (mode == Weld::position && &attribute != position) continue;
        const bool replaced = &attribute == position && !positions.empty();
        keys.push_back({attribute.stride(), replaced ? positions.data() : attribute.data.data()});
    }
    if (keys.empty()) return mesh;

    const detail::Groups groups = detail::group_equal(
        mesh.vertex_count,
        [&](std::uint32_t v) {
            std::uint64_t hash = 0;
            for (const Key& key : keys) hash = detail::hash_bytes(key.data + v * key.stride, key.stride, hash);
            return hash;
        },
        [&](std::uint32_t v, std::uint32_t w) {
            for (const Key& key : keys) {
                const int order = std::memcmp(key.data + v * key.stride, key.data + w * key.stride, key.stride);
                if (order != 0) return order;
            }
            return 0;
        });

    const std::vector<std::uint32_t> kept = groups.first_items();
    if (report != nullptr) *report = differences(mesh, groups, kept);
    Mesh out;
    out.vertex_count = groups.count;
    out.attributes = permute_attributes(mesh.attributes, kept);
    out.indices.reserve(mesh.indices.size());
    for (const std::uint32_t v : mesh.indices) out.indices.push_back(groups.of[v]);
    return out;
}

}  // namespace lacedring
