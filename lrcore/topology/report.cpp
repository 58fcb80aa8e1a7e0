#include <algorithm>
#include <numeric>

#include "lacedring/topology.hpp"

namespace lacedring {
namespace {

/// The border edge after the border edge that corner c faces, in the direction of c's triangle.
CornerId next_border(const CornerTable& table, CornerId c) {
    CornerId x = next(c);
    while (!table.opposite(x).is_null()) x = next(table.opposite(x));
    return x;
}

/// Number of connected components of the used vertices.
std::uint32_t count_components(const CornerTable& table) {
    std::vector<std::uint32_t> parent(table.vertex_count);
    std::iota(parent.begin(), parent.end(), 0U);
    const auto find = [&](VertexId v) {
        std::uint32_t i = v.value;
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    std::vector<bool> used(table.vertex_count, false);
    std::uint32_t components = 0;
    for (std::uint32_t t = 0; t < table.triangle_count(); ++t) {
        if (table.degenerate(TriangleId{t})) continue;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const VertexId v = table.vertex(corner(TriangleId{t}, k));
            if (!used[v.value]) ++components;
            used[v.value] = true;
            const std::uint32_t a = find(v), b = find(table.vertex(corner(TriangleId{t}, 0)));
            if (a == b) continue;
            parent[a] = b;
            --components;
        }
    }
    return components;
}

}  // namespace

TopologyReport report_topology(const CornerTable& table) {
    TopologyReport report;
    const auto corners = static_cast<std::uint32_t>(table.corners.size());
    report.triangles = table.triangle_count() - table.topology.degenerate;
    report.components = count_components(table);
    report.shells = swirl_shells(table, [](std::uint32_t, CornerId) {});
    report.orientable = table.topology.cut_edges == 0;

    // First the open fans, from corners without a predecessor around their vertex; then the closed fans.
    std::vector<std::uint32_t> valence(table.vertex_count, 0), fans(table.vertex_count, 0);
    std::vector<bool> seen(corners, false), on_loop(corners, false);
    std::uint64_t border_half_edges = 0;
    for (int closed = 0; closed < 2; ++closed) {
        for (std::uint32_t i = 0; i < corners; ++i) {
            const CornerId c{i};
            if (seen[i] || table.degenerate(triangle(c))) continue;
            if (closed == 0 && !table.right(c).is_null()) continue;
            const VertexId v = table.vertex(c);
            ++fans[v.value];
            if (closed == 0) ++valence[v.value];  // an open fan has one edge more than triangles
            for (CornerId x = c; !x.is_null() && !seen[x.value]; x = table.swing(x)) {
                seen[x.value] = true;
                ++valence[v.value];
            }
        }
    }
    for (std::uint32_t i = 0; i < corners; ++i) {
        const CornerId c{i};
        if (!table.opposite(c).is_null() || table.degenerate(triangle(c))) continue;
        ++border_half_edges;
        if (on_loop[i]) continue;
        ++report.border_loops;
        for (CornerId x = c; !on_loop[x.value]; x = next_border(table, x)) on_loop[x.value] = true;
    }
    std::uint32_t six = 0;
    for (std::uint32_t v = 0; v < table.vertex_count; ++v) {
        if (fans[v] == 0) continue;
        ++report.used_vertices;
        report.fans += fans[v];
        if (fans[v] > 1) ++report.nonmanifold_vertices;
        if (valence[v] == 6) ++six;
        report.max_valence = std::max(report.max_valence, valence[v]);
    }
    if (report.used_vertices > 0) report.valence6_percent = 100.0 * six / report.used_vertices;
    report.closed = border_half_edges == 0;
    const std::int64_t edges = (std::int64_t{report.triangles} * 3 + static_cast<std::int64_t>(border_half_edges)) / 2;
    report.euler_characteristic = std::int64_t{report.fans} - edges + std::int64_t{report.triangles};
    report.genus =
        (2 * std::int64_t{report.shells} - std::int64_t{report.border_loops} - report.euler_characteristic) / 2;
    return report;
}

}  // namespace lacedring
