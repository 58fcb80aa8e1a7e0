#include "lrlab/rivals/corner_table_c.h"

namespace lacedring {

CornerTableC build_corner_table_c(const CornerTable& table) {
    CornerTableC out;
    out.vertex_of.resize(table.corners.size());
    out.opposite_of.resize(table.corners.size());
    out.corner_of.assign(table.vertex_count, kNullCorner.value);
    for (std::uint32_t t = table.triangle_count(); t-- > 0;) {  // backwards, so that C is a vertex's lowest corner
        const bool degenerate = table.degenerate(TriangleId{t});
        for (std::uint32_t i = 0; i < 3; ++i) {
            const CornerId c = corner(TriangleId{t}, i);
            out.vertex_of[c.value] = table.vertex(c).value;
            out.opposite_of[c.value] = table.opposite(c).value;
            if (!degenerate) out.corner_of[table.vertex(c).value] = c.value;
        }
    }
    for (std::uint32_t t = 0; t < table.triangle_count(); ++t) {
        for (std::uint32_t i = 0; i < 3 && !table.degenerate(TriangleId{t}); ++i) {
            const CornerId c = corner(TriangleId{t}, i);
            if (table.right(c).is_null()) out.corner_of[table.vertex(c).value] = c.value;
        }
    }
    return out;
}

}  // namespace lacedring
