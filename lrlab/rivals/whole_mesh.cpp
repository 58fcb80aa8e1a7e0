#include "lrlab/rivals/whole_mesh.h"

#include <algorithm>
#include <span>

#include "lrcore/codec/vertices/quantize.h"

namespace lacedring {

RivalMesh store_raw(const Mesh& mesh) {
    RivalMesh out;
    const auto add = [&](std::span<const std::byte> data) {
        out.bytes.insert(out.bytes.end(), data.begin(), data.end());
    };
    if (mesh.vertex_count <= 65536) {
        const std::vector<std::uint16_t> narrow(mesh.indices.begin(), mesh.indices.end());
        add(std::as_bytes(std::span(narrow)));
    } else {
        add(std::as_bytes(std::span(mesh.indices)));
    }
    for (const Attribute& attribute : mesh.attributes) add(attribute.data);
    out.largest_errors.assign(mesh.attributes.size(), 0);
    return out;
}

std::vector<std::array<std::uint32_t, 3>> oriented_triangles(const std::vector<std::uint32_t>& indices,
                                                             const std::vector<std::uint32_t>& order) {
    std::vector<std::array<std::uint32_t, 3>> out;
    out.reserve(indices.size() / 3);
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        std::array<std::uint32_t, 3> t{indices[i], indices[i + 1], indices[i + 2]};
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
        if (!order.empty()) {
            for (std::uint32_t& v : t) v = order[v];
        }
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        out.push_back(t);
    }
    std::sort(out.begin(), out.end());
    return out;
}

std::optional<VertexIntegers> quantized(const Attribute& attribute, const AttributeBits& bits) {
    const VertexOptions options = vertex_options(attribute, bits);
    if (options.mapping == VertexMapping::floats) return {};
    Result<VertexIntegers> integers =
        to_integers({attribute.type, attribute.components, attribute.normalized, attribute.data}, options);
    if (!integers) return {};
    return std::move(*integers);
}

}  // namespace lacedring
