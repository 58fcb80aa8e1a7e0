// Orientation by flooding each component from its first triangle.
// Rossignac's chapter, section on orientation: crossing an edge whose half-edges have the same direction flips the next
// triangle.

#include <utility>

#include "lrcore/topology/edges.h"

namespace lacedring {
namespace {

/// Flips triangle t: swaps corners 1 and 2 in V and O.
void turn(CornerTable& table, TriangleId t) {
    const CornerId a = corner(t, 1), b = corner(t, 2);
    const CornerId oa = table.corners[a.value].opposite, ob = table.corners[b.value].opposite;
    std::swap(table.corners[a.value].vertex, table.corners[b.value].vertex);
    table.corners[a.value].opposite = ob;
    table.corners[b.value].opposite = oa;
    if (!oa.is_null()) table.corners[oa.value].opposite = b;
    if (!ob.is_null()) table.corners[ob.value].opposite = a;
    table.flip[t.value / 64] ^= std::uint64_t{1} << (t.value % 64);
}

}  // namespace

void orient(CornerTable& table) {
    const std::uint32_t triangles = table.triangle_count();
    table.flip.assign((triangles + 63) / 64, 0);
    std::vector<bool> reached(triangles, false);
    std::vector<TriangleId> component;  // also the queue
    for (std::uint32_t seed = 0; seed < triangles; ++seed) {
        if (reached[seed]) continue;
        component.assign(1, TriangleId{seed});
        reached[seed] = true;
        std::size_t flipped = 0;
        for (std::size_t i = 0; i < component.size(); ++i) {
            for (std::uint32_t k = 0; k < 3; ++k) {
                const CornerId c = corner(component[i], k), o = table.opposite(c);
                if (o.is_null()) continue;
                const TriangleId u = triangle(o);
                const bool twisted = edge_start(table, c) == edge_start(table, o);
                if (!reached[u.value]) {
                    reached[u.value] = true;
                    component.push_back(u);
                    if (twisted) {
                        turn(table, u);
                        ++flipped;
                    }
                } else if (twisted) {
                    table.corners[c.value].opposite = kNullCorner;
                    table.corners[o.value].opposite = kNullCorner;
                    ++table.topology.cut_edges;
                }
            }
        }
        // The opposite orientation flips fewer triangles.
        if (flipped * 2 > component.size()) {
            for (const TriangleId t : component) turn(table, t);
            flipped = component.size() - flipped;
        }
        table.topology.flipped += static_cast<std::uint32_t>(flipped);
    }
    if (table.topology.flipped == 0) table.flip.clear();
}

}  // namespace lacedring
