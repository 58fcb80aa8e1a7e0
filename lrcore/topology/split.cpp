#include "lacedring/topology.hpp"
#include "lrcore/base/bits.h"

namespace lacedring {

std::vector<VertexId> split_fans(CornerTable& table) {
    const auto corners = static_cast<std::uint32_t>(table.corners.size());
    std::vector<VertexId> copies;
    BitVector in_fan(corners), has_fan(table.vertex_count);
    for (std::uint32_t i = 0; i < corners; ++i) {
        if (in_fan.test(i) || table.degenerate(triangle(CornerId{i}))) continue;
        const VertexId v = table.vertex(CornerId{i});
        VertexId name = v;
        if (has_fan.test(v.value)) {
            name = VertexId{table.vertex_count + static_cast<std::uint32_t>(copies.size())};
            copies.push_back(v);
        } else {
            has_fan.set(v.value);
        }
        table.around(CornerId{i}, [&](CornerId c) {
            in_fan.set(c.value);
            table.corners[c.value].vertex = name;
            return false;
        });
    }
    table.vertex_count += static_cast<std::uint32_t>(copies.size());
    return copies;
}

}  // namespace lacedring
