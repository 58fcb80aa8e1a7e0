#pragma once
// Compares every operator of a structure at every corner and vertex with the corner table that it was built from.

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "lacedring/streams.hpp"
#include "lacedring/topology.hpp"
#include "tests/support/fast_require.h"

namespace lacedring::test {

/// Checks `ops`, which has the operators of Operators. Its triangle t has the corners stride * t + 0, 1, 2 and is
/// triangle map.triangle[t] of the table, beginning with the table's corner map.start[t].
template <class Operators>
class OperatorOracle {
  public:
    OperatorOracle(const CornerTable& table, const Operators& ops, const LrMap& map, std::uint32_t stride)
        : table_(table),
          ops_(ops),
          map_(map),
          stride_(stride),
          triangles_at_(table.vertex_count, 0),
          border_starts_(table.vertex_count, 0) {
        for (std::uint32_t i = 0; i < table.corners.size(); ++i) {
            if (table.degenerate(triangle(CornerId{i}))) continue;
            ++triangles_at_[table.vertex(CornerId{i}).value];
            if (table.opposite(CornerId{i}).is_null()) ++border_starts_[table.vertex(next(CornerId{i})).value];
        }
    }

    void check_triangle_numbers() const {
        std::vector<std::uint32_t> number(table_.triangle_count(), UINT32_MAX);
        for (std::uint32_t t = 0; t < map_.triangle.size(); ++t) {
            const TriangleId of = map_.triangle[t];
            REQUIRE_PROPERTY("canonical triangles are those in the map",
                             ops_.is_canonical(TriangleId{t}) == !of.is_null());
            if (of.is_null()) continue;
            REQUIRE_PROPERTY("a triangle has one canonical number", number[of.value] == UINT32_MAX);
            number[of.value] = t;
        }
        for (std::uint32_t t = 0; t < table_.triangle_count(); ++t) {
            REQUIRE_PROPERTY("all triangles except the degenerate ones have a number",
                             (number[t] == UINT32_MAX) == table_.degenerate(TriangleId{t}));
        }
    }

    void check_vertex_numbers() const {
        std::vector<std::uint32_t> number(table_.vertex_count, UINT32_MAX);
        REQUIRE_FAST(map_.vertex.size() == table_.vertex_count);
        for (std::uint32_t v = 0; v < map_.vertex.size(); ++v) {
            REQUIRE_PROPERTY("a vertex has one number", number[map_.vertex[v].value] == UINT32_MAX);
            number[map_.vertex[v].value] = v;
        }
    }

    void check_corners() const {
        for (std::uint32_t t = 0; t < map_.triangle.size(); ++t) {
            REQUIRE_PROPERTY("the first corner of triangle t is stride * t",
                             ops_.corner(TriangleId{t}).value == stride_ * t);
            for (std::uint32_t k = 0; k < 3; ++k) {
                const CornerId c{stride_ * t + k};
                CAPTURE(c.value);
                check_corner_numbers(c, t, k);
                const CornerId canonical = ops_.canonical(c);
                if (canonical.is_null()) {
                    check_border_slot(c);
                } else {
                    check_corner(c, canonical);
                }
            }
        }
    }

    void check_vertices() const {
        for (std::uint32_t v = 0; v < map_.vertex.size(); ++v) {
            CAPTURE(v);
            const std::uint32_t there = map_.vertex[v].value;
            const CornerId c = ops_.corner(VertexId{v});
            REQUIRE_PROPERTY("only an unused vertex has no corner", c.is_null() == (triangles_at_[there] == 0));
            if (c.is_null()) {
                CHECK_MESSAGE(ops_.valence(VertexId{v}) == 0, "an unused vertex has no valence");
                continue;
            }
            check_vertex(v, there, c);
            check_neighbors(v, c, check_star(v, there));
        }
    }

  private:
    /// The table's corner of a canonical corner.
    CornerId in_table(CornerId c) const {
        if (c.is_null()) return c;
        const std::uint32_t t = c.value / stride_;
        REQUIRE_FAST(t < map_.triangle.size());
        REQUIRE_FAST(!map_.triangle[t].is_null());
        return corner(map_.triangle[t], (map_.start[t] + c.value % stride_) % 3);
    }

    void check_corner_numbers(CornerId c, std::uint32_t t, std::uint32_t k) const {
        REQUIRE_PROPERTY("triangle", ops_.triangle(c).value == t);
        REQUIRE_PROPERTY("next", ops_.next(c).value == stride_ * t + (k + 1) % 3);
        REQUIRE_PROPERTY("previous", ops_.previous(c).value == stride_ * t + (k + 2) % 3);
    }

    /// A slot of a laced ring without a triangle. Other structures have none, and need not answer for it.
    void check_border_slot(CornerId c) const {
        constexpr bool laced_ring = requires(const Operators& ops) {
            ops.ring_next(0U);
        };
        if (laced_ring) REQUIRE_PROPERTY("a border slot's corner has no opposite", ops_.opposite(c).is_null());
    }

    /// `c` may be a corner of a T2's redundant copy.
    void check_corner(CornerId c, CornerId canonical) const {
        const CornerId x = in_table(canonical), back = table_.right(x);
        if (ops_.is_canonical(ops_.triangle(c)))
            REQUIRE_PROPERTY("a canonical triangle's corners are canonical", canonical == c);
        REQUIRE_PROPERTY("vertex", map_.vertex[ops_.vertex(c).value] == table_.vertex(x));
        REQUIRE_PROPERTY("next of the canonical corner", in_table(ops_.next(canonical)) == next(x));
        REQUIRE_PROPERTY("canonical corner of next", in_table(ops_.canonical(ops_.next(c))) == next(x));
        REQUIRE_PROPERTY("opposite", in_table(ops_.opposite(c)) == table_.opposite(x));
        REQUIRE_PROPERTY("left", in_table(ops_.left(c)) == table_.left(x));
        REQUIRE_PROPERTY("right", in_table(ops_.right(c)) == table_.right(x));
        REQUIRE_PROPERTY("swing", in_table(ops_.swing(c)) == table_.swing(x));
        REQUIRE_PROPERTY("swing_back", in_table(ops_.swing_back(c)) == (back.is_null() ? back : previous(back)));
    }

    void check_vertex(std::uint32_t v, std::uint32_t there, CornerId c) const {
        REQUIRE_PROPERTY("the vertex of a vertex's corner is the vertex", ops_.vertex(c).value == v);
        REQUIRE_PROPERTY("a vertex's corner is canonical", ops_.canonical(c) == c);
        REQUIRE_PROPERTY("the table is a pseudo-manifold", border_starts_[there] <= 1);
        REQUIRE_PROPERTY("is_border", ops_.is_border(VertexId{v}) == (border_starts_[there] == 1));
        REQUIRE_PROPERTY("valence", ops_.valence(VertexId{v}) == triangles_at_[there] + border_starts_[there]);
    }

    /// Returns the table's corners of the star, sorted.
    std::vector<std::uint32_t> check_star(std::uint32_t v, std::uint32_t there) const {
        std::vector<std::uint32_t> star;
        ops_.star(VertexId{v}, [&](CornerId x) {
            REQUIRE_PROPERTY("the star has corners of its vertex", ops_.vertex(x).value == v);
            star.push_back(in_table(x).value);
        });
        REQUIRE_PROPERTY("the star has every triangle at its vertex", star.size() == triangles_at_[there]);
        std::sort(star.begin(), star.end());
        REQUIRE_PROPERTY("the star has no corner twice", std::adjacent_find(star.begin(), star.end()) == star.end());
        return star;
    }

    /// Around an interior vertex the neighbors are in the order of swing; around a border vertex the order is not
    /// checked.
    void check_neighbors(std::uint32_t v, CornerId c, const std::vector<std::uint32_t>& star) const {
        std::vector<std::uint32_t> neighbors, expected;
        ops_.neighbors(VertexId{v}, [&](VertexId u) { neighbors.push_back(map_.vertex[u.value].value); });
        REQUIRE_PROPERTY("as many neighbors as the valence", neighbors.size() == ops_.valence(VertexId{v}));
        const CornerId begin = in_table(c);
        CornerId x = begin;
        do {
            expected.push_back(table_.vertex(next(x)).value);
            x = table_.swing(x);
        } while (!x.is_null() && x != begin);
        if (x.is_null()) {
            expected.clear();
            for (const std::uint32_t s : star) {
                expected.push_back(table_.vertex(next(CornerId{s})).value);
                if (table_.left(CornerId{s}).is_null()) expected.push_back(table_.vertex(previous(CornerId{s})).value);
            }
            std::sort(expected.begin(), expected.end());
            std::sort(neighbors.begin(), neighbors.end());
        }
        REQUIRE_PROPERTY("neighbors", neighbors == expected);
    }

    const CornerTable& table_;
    const Operators& ops_;
    const LrMap& map_;
    std::uint32_t stride_;
    std::vector<std::uint32_t> triangles_at_,
        border_starts_;  ///< by vertex: its triangles; border edges that start there
};

/// Checks all operators (OperatorOracle).
template <class Operators>
void check_operators(const CornerTable& table, const Operators& ops, const LrMap& map, std::uint32_t stride = 4) {
    const OperatorOracle<Operators> oracle(table, ops, map, stride);
    oracle.check_triangle_numbers();
    oracle.check_vertex_numbers();
    oracle.check_corners();
    oracle.check_vertices();
}

}  // namespace lacedring::test
