#include "lrcore/mesh/weld.h"

#include <algorithm>
#include <cstring>

#include "lrcore/mesh/distinct.h"

namespace lr {

Mesh weld(const Mesh& mesh, Weld mode) {
    if (mode == Weld::none) return mesh;
    std::vector<const Attribute*> keys;
    for (const Attribute& attribute : mesh.attributes) {
        if (mode == Weld::attributes || attribute.name == "POSITION") keys.push_back(&attribute);
        if (mode == Weld::position && !keys.empty()) break;  // a second attribute of that name is not the position
    }
    if (keys.empty()) return mesh;

    const detail::Groups groups = detail::group_equal(
        mesh.vertex_count,
        [&](std::uint32_t v) {
            std::uint64_t hash = 0;
            for (const Attribute* key : keys) {
                const std::size_t stride = key->stride();
                hash = detail::hash_bytes(key->data.data() + v * stride, stride, hash);
            }
            return hash;
        },
        [&](std::uint32_t v, std::uint32_t w) {
            return std::all_of(keys.begin(), keys.end(), [v, w](const Attribute* key) {
                const std::size_t stride = key->stride();
                return std::memcmp(key->data.data() + v * stride, key->data.data() + w * stride, stride) == 0;
            });
        });

    Mesh out;
    out.vertex_count = groups.count;
    out.attributes = permute_attributes(mesh.attributes, groups.first_items());
    out.indices.reserve(mesh.indices.size());
    for (const std::uint32_t v : mesh.indices) out.indices.push_back(groups.of[v]);
    return out;
}

}  // namespace lr
