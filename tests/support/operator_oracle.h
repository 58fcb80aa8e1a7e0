#pragma once
// Every operator of a structure at every corner and vertex, against the corner table that it was built from.

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "lacedring/streams.hpp"
#include "lacedring/topology.hpp"
#include "tests/support/fast_require.h"

namespace lacedring::test {

/// `ops` has the operators of Operators. Its triangle t has corners stride * t + 0, 1, 2, and is triangle
/// map.triangle[t] of the table, whose corner map.start[t] it begins with.
template <class Operators>
void check_operators(const CornerTable& table, const Operators& ops, const LrMap& map, std::uint32_t stride = 4) {
    // The bijection: every triangle that is not degenerate has one canonical number, every vertex one number.
    std::vector<std::uint32_t> number(table.triangle_count(), UINT32_MAX);
    for (std::uint32_t t = 0; t < map.triangle.size(); ++t) {
        REQUIRE_FAST(ops.is_canonical(TriangleId{t}) == !map.triangle[t].is_null());
        if (map.triangle[t].is_null()) continue;
        REQUIRE_FAST(number[map.triangle[t].value] == UINT32_MAX);
        number[map.triangle[t].value] = t;
    }
    for (std::uint32_t t = 0; t < table.triangle_count(); ++t) {
        REQUIRE_FAST((number[t] == UINT32_MAX) == table.degenerate(TriangleId{t}));
    }
    std::vector<std::uint32_t> vertex_number(table.vertex_count, UINT32_MAX);
    REQUIRE_FAST(map.vertex.size() == table.vertex_count);
    for (std::uint32_t v = 0; v < map.vertex.size(); ++v) {
        REQUIRE_FAST(vertex_number[map.vertex[v].value] == UINT32_MAX);
        vertex_number[map.vertex[v].value] = v;
    }
    const auto there = [&](CornerId c) -> CornerId {  // the corner table's corner of a canonical corner
        if (c.is_null()) return c;
        const std::uint32_t t = c.value / stride;
        REQUIRE_FAST(t < map.triangle.size());
        REQUIRE_FAST(!map.triangle[t].is_null());
        return corner(map.triangle[t], (map.start[t] + c.value % stride) % 3);
    };
    // A laced ring's corners of no triangle lie at an edge with a border; others may not be asked about at all.
    constexpr bool border_slots = requires {
        ops.ring_next(0U);
    };

    for (std::uint32_t t = 0; t < map.triangle.size(); ++t) {
        REQUIRE_FAST(ops.corner(TriangleId{t}).value == stride * t);
        for (std::uint32_t k = 0; k < 3; ++k) {
            const CornerId c{stride * t + k};
            CAPTURE(c.value);
            REQUIRE_FAST(ops.triangle(c).value == t);
            REQUIRE_FAST(ops.next(c).value == stride * t + (k + 1) % 3);
            REQUIRE_FAST(ops.previous(c).value == stride * t + (k + 2) % 3);
            const CornerId canonical = ops.canonical(c);
            if (canonical.is_null()) {
                if (border_slots) REQUIRE_FAST(ops.opposite(c).is_null());
                continue;
            }
            const CornerId x = there(canonical);
            if (ops.is_canonical(TriangleId{t})) REQUIRE_FAST(canonical == c);
            REQUIRE_FAST(map.vertex[ops.vertex(c).value] == table.vertex(x));  // of a T2's first copy as well
            REQUIRE_FAST(there(ops.next(canonical)) == next(x));
            REQUIRE_FAST(there(ops.canonical(ops.next(c))) == next(x));
            REQUIRE_FAST(there(ops.opposite(c)) == table.opposite(x));
            REQUIRE_FAST(there(ops.left(c)) == table.left(x));
            REQUIRE_FAST(there(ops.right(c)) == table.right(x));
            REQUIRE_FAST(there(ops.swing(c)) == table.swing(x));
            const CornerId back = table.right(x);
            REQUIRE_FAST(there(ops.swing_back(c)) == (back.is_null() ? back : previous(back)));
        }
    }

    std::vector<std::uint32_t> triangles_at(table.vertex_count, 0), border_starts(table.vertex_count, 0);
    for (std::uint32_t i = 0; i < table.corners.size(); ++i) {
        if (table.degenerate(triangle(CornerId{i}))) continue;
        ++triangles_at[table.vertex(CornerId{i}).value];
        if (table.opposite(CornerId{i}).is_null()) ++border_starts[table.vertex(next(CornerId{i})).value];
    }
    for (std::uint32_t v = 0; v < map.vertex.size(); ++v) {
        CAPTURE(v);
        const std::uint32_t there_v = map.vertex[v].value;
        const CornerId c = ops.corner(VertexId{v});
        REQUIRE_FAST(c.is_null() == (triangles_at[there_v] == 0));
        if (c.is_null()) {
            CHECK(ops.valence(VertexId{v}) == 0);
            continue;
        }
        REQUIRE_FAST(ops.vertex(c).value == v);
        REQUIRE_FAST(ops.canonical(c) == c);
        REQUIRE_FAST(border_starts[there_v] <= 1);  // a pseudo-manifold
        REQUIRE_FAST(ops.is_border(VertexId{v}) == (border_starts[there_v] == 1));
        REQUIRE_FAST(ops.valence(VertexId{v}) == triangles_at[there_v] + border_starts[there_v]);
        std::vector<std::uint32_t> star;
        ops.star(VertexId{v}, [&](CornerId x) {
            REQUIRE_FAST(ops.vertex(x).value == v);
            star.push_back(there(x).value);
        });
        REQUIRE_FAST(star.size() == triangles_at[there_v]);
        std::sort(star.begin(), star.end());
        REQUIRE_FAST(std::adjacent_find(star.begin(), star.end()) == star.end());
        std::vector<std::uint32_t> neighbours, expected;
        ops.neighbors(VertexId{v}, [&](VertexId u) { neighbours.push_back(map.vertex[u.value].value); });
        REQUIRE_FAST(neighbours.size() == ops.valence(VertexId{v}));
        const CornerId begin = there(c);
        CornerId x = begin;
        do {  // around an interior vertex, the order is that of swing
            expected.push_back(table.vertex(next(x)).value);
            x = table.swing(x);
        } while (!x.is_null() && x != begin);
        if (x.is_null()) {
            expected.clear();
            for (const std::uint32_t s : star) {
                expected.push_back(table.vertex(next(CornerId{s})).value);
                if (table.left(CornerId{s}).is_null()) expected.push_back(table.vertex(previous(CornerId{s})).value);
            }
            std::sort(expected.begin(), expected.end());
            std::sort(neighbours.begin(), neighbours.end());
        }
        REQUIRE_FAST(neighbours == expected);
    }
}

}  // namespace lacedring::test
