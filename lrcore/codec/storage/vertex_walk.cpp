#include "lrcore/codec/storage/vertex_walk.h"

#include <algorithm>

namespace lacedring::storage {

std::vector<std::uint32_t> opposite_corners(std::span<const std::uint32_t> triangles, std::uint32_t vertices) {
    const std::size_t corners = triangles.size() / 3 * 3;
    std::vector<std::uint32_t> out(corners, kNone);
    // The corners whose edge has v as its smaller end are by_end[begin[v] to begin[v + 1]), in their order.
    struct Facing {
        std::uint32_t corner, larger;
    };
    std::vector<std::uint32_t> begin(std::size_t{vertices} + 2, 0);
    const auto each_edge = [&](auto&& visit) {
        for (std::size_t c = 0; c < corners; c += 3) {
            const std::uint32_t x = triangles[c], y = triangles[c + 1], z = triangles[c + 2];
            if (x == y || y == z || z == x) continue;
            const auto corner = static_cast<std::uint32_t>(c);
            visit(corner, std::min(y, z), std::max(y, z));
            visit(corner + 1, std::min(z, x), std::max(z, x));
            visit(corner + 2, std::min(x, y), std::max(x, y));
        }
    };
    each_edge([&](std::uint32_t, std::uint32_t smaller, std::uint32_t) { ++begin[std::size_t{smaller} + 2]; });
    for (std::size_t v = 2; v < begin.size(); ++v) begin[v] += begin[v - 1];
    std::vector<Facing> by_end(begin.back());
    each_edge([&](std::uint32_t corner, std::uint32_t smaller, std::uint32_t larger) {
        by_end[begin[std::size_t{smaller} + 1]++] = {corner, larger};
    });
    struct Open {
        std::uint32_t smaller = kNone, corner = 0;
    };
    std::vector<Open> open(vertices);  // by the larger end: an edge whose other triangle was not met yet
    for (std::uint32_t v = 0; v < vertices; ++v) {
        for (std::uint32_t i = begin[v]; i < begin[std::size_t{v} + 1]; ++i) {
            const auto [corner, larger] = by_end[i];
            Open& edge = open[larger];
            if (edge.smaller == v) {
                out[corner] = edge.corner;
                out[edge.corner] = corner;
                edge.smaller = kNone;
            } else {
                edge = {v, corner};
            }
        }
    }
    return out;
}

}  // namespace lacedring::storage
