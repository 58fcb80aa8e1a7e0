#include "lrcore/ring/expansion_order.h"

namespace lr {

std::vector<std::uint32_t> expansion_order(const CornerTable& table) {
    std::vector<std::uint32_t> order(table.triangle_count(), UINT32_MAX);
    std::vector<bool> reached(table.vertex_count), seen(table.triangle_count());
    std::uint32_t steps = 0;
    std::vector<CornerId> stack;
    for (std::uint32_t t = 0; t < table.triangle_count(); ++t) {
        if (seen[t] || table.degenerate({t})) continue;
        const CornerId seed = corner({t}, 0);
        bool fresh = true;
        for (std::uint32_t i = 0; i < 3; ++i) fresh = fresh && !reached[table.vertex(corner({t}, i)).value];
        if (!fresh) continue;
        reached[table.vertex(next(seed)).value] = reached[table.vertex(previous(seed)).value] = true;
        stack.push_back(seed);
        while (!stack.empty()) {
            const CornerId c = stack.back();
            stack.pop_back();
            // Entered across the edge that c faces: the triangle is invaded if its tip is new.
            const std::uint32_t tip = table.vertex(c).value, triangle_number = triangle(c).value;
            if (seen[triangle_number] || reached[tip]) continue;
            reached[tip] = seen[triangle_number] = true;
            order[triangle_number] = steps++;
            if (const CornerId left = table.left(c); !left.is_null()) stack.push_back(left);
            if (const CornerId right = table.right(c); !right.is_null()) stack.push_back(right);  // first
        }
    }
    return order;
}

}  // namespace lr
