#pragma once
// Checks the promises of validate_lr and validate_compact_lr for the tables that they accept.

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "lacedring/operators.hpp"
#include "lacedring/streams.hpp"

namespace lacedring::test {

/// The tables without their shortcuts (plain_opposite, plain_fan), so that Operators takes the general path.
template <class View>
struct GeneralStore {
    const View* view;
    std::uint32_t ring_vertices;

    std::uint32_t kind(std::uint32_t v, std::uint32_t side) const { return view->kind(v, side); }
    bool closes(std::uint32_t v) const { return view->closes(v); }
    std::uint32_t first(std::uint32_t v) const { return view->first(v); }
    std::uint32_t tip(std::uint32_t v, std::uint32_t side) const { return view->tip(v, side); }
    std::uint32_t star_opposite(std::uint32_t v, std::uint32_t side, std::uint32_t end) const {
        return view->star_opposite(v, side, end);
    }
    std::uint32_t t0_vertex(std::uint32_t i) const { return view->t0_vertex(i); }
    std::uint32_t t0_opposite(std::uint32_t i) const { return view->t0_opposite(i); }
    std::uint32_t isolated_corner(std::uint32_t i) const { return view->isolated_corner(i); }
    std::uint32_t used_vertices() const { return view->used_vertices(); }
};

/// Compares the operators at every corner and vertex with the triangles. Returns the first difference, or "".
template <class View>
std::string inconsistency(const View& view) {
    const Operators<View> ops(view);
    const Operators<GeneralStore<View>> general({&view, view.ring_vertices});
    const std::uint32_t used = view.used_vertices();
    std::vector<std::uint32_t> triangles(used, 0), borders(used, 0);
    std::vector<std::vector<std::uint32_t>> next_to(used);  // by vertex: a neighbor for each edge
    for (std::uint32_t t = 0; t < view.triangle_numbers(); ++t) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            const CornerId c{4 * t + k}, real = ops.canonical(c), o = ops.opposite(c);
            if (o != general.opposite(c))
                return fmt::format("opposite of corner {} differs by the general path", c.value);
            if (real.is_null()) {
                if (!o.is_null()) return fmt::format("border corner {} has an opposite", c.value);
                continue;
            }
            if (ops.vertex(c) != ops.vertex(real) || o != ops.opposite(real))
                return fmt::format("vertex or opposite of corner {} differs from its canonical corner's", c.value);
            if (!ops.is_canonical(TriangleId{t})) continue;
            const std::uint32_t v = ops.vertex(c).value;
            if (v >= used) return fmt::format("vertex {} of corner {} is not used", v, c.value);
            ++triangles[v];
            next_to[v].push_back(ops.vertex(ops.next(c)).value);
            if (!o.is_null()) {
                if (ops.opposite(o) != c)
                    return fmt::format("the opposite of corner {}'s opposite is another corner", c.value);
                continue;
            }
            const std::uint32_t end = ops.vertex(ops.previous(c)).value, start = ops.vertex(ops.next(c)).value;
            ++borders[end];
            if (end >= used) return fmt::format("border vertex {} is not used", end);
            next_to[end].push_back(start);
        }
    }
    for (std::uint32_t v = 0; v < used; ++v) {
        std::uint32_t star = 0;
        ops.star(VertexId{v}, [&](CornerId c) {
            star += ops.vertex(c).value == v && ops.is_canonical(TriangleId{c.value / 4}) ? 1 : 0;
        });
        if (star != triangles[v] || star == 0)
            return fmt::format("vertex {}: its star has {} of {} corners", v, star, triangles[v]);
        if (ops.is_border(VertexId{v}) != (borders[v] != 0) || borders[v] > 1)
            return fmt::format("vertex {}: is_border is wrong, or it has several border edges", v);
        if (ops.valence(VertexId{v}) != next_to[v].size())
            return fmt::format("vertex {}: the valence is not the number of edges", v);
        std::vector<std::uint32_t> met, walked;
        ops.neighbors(VertexId{v}, [&](VertexId u) { met.push_back(u.value); });
        general.neighbors(VertexId{v}, [&](VertexId u) { walked.push_back(u.value); });
        if (met != walked) return fmt::format("vertex {}: neighbors differ by the general path", v);
        std::sort(met.begin(), met.end());
        std::sort(next_to[v].begin(), next_to[v].end());
        if (met != next_to[v]) return fmt::format("vertex {}: neighbors are not those of its edges", v);
    }
    for (std::uint32_t v = used; v < std::min(view.vertices, used + 2); ++v) {
        if (!ops.corner(VertexId{v}).is_null() || ops.valence(VertexId{v}) != 0)
            return fmt::format("unused vertex {} has a corner or a valence", v);
    }
    return {};
}

}  // namespace lacedring::test
