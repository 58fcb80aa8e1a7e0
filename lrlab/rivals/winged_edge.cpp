#include "lrlab/rivals/winged_edge.h"

namespace lacedring {

WingedEdge build_winged_edge(const CornerTable& table) {
    WingedEdge out;
    out.half_edges.resize(table.corners.size());
    out.half_edge_at.assign(table.vertex_count, kNullCorner);
    for (std::uint32_t t = table.triangle_count(); t-- > 0;) {
        const bool degenerate = table.degenerate(TriangleId{t});
        for (std::uint32_t i = 0; i < 3; ++i) {
            const CornerId c = corner(TriangleId{t}, i);
            const VertexId start = table.vertex(next(c));
            out.half_edges[c.value] = {start, table.opposite(c), next(c)};
            if (!degenerate) out.half_edge_at[start.value] = c;
        }
    }
    for (std::uint32_t t = 0; t < table.triangle_count(); ++t) {
        for (std::uint32_t i = 0; i < 3 && !table.degenerate(TriangleId{t});
             ++i) {  // v.c is the corner after half-edge c
            const CornerId c = corner(TriangleId{t}, i);
            if (table.opposite(c).is_null()) out.half_edge_at[table.vertex(next(c)).value] = c;
        }
    }
    return out;
}

}  // namespace lacedring
