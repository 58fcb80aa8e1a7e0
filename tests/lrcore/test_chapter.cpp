// Compares the library with the definitions and procedures of Rossignac's chapter (docs/chapter-map.md). The tests that
// need positions are in test_geometry.cpp.

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "lacedring/topology.hpp"
#include "tests/support/built.h"
#include "tests/support/capture.h"
#include "tests/support/meshes.h"
#include "tests/support/shapes.h"

using namespace lacedring;
using lacedring::test::build;

namespace {

SmeshCheck check_connectivity(const Mesh& mesh) {
    const CornerTable table = build(mesh);
    return check_smesh(table, report_topology(table));
}
Mesh mesh_of(const test::Shape& shape) {
    return test::make_mesh(shape.triangles, shape.vertices);
}

/// The chapter's procedure, where c.l is c.p.o and c.r is c.n.o.
void recursive_swirl(const CornerTable& table, CornerId c, std::vector<bool>& m, std::vector<CornerId>& order) {
    if (c.is_null() || m[triangle(c).value]) return;
    m[triangle(c).value] = true;
    order.push_back(c);
    recursive_swirl(table, table.opposite(previous(c)), m, order);
    recursive_swirl(table, table.opposite(next(c)), m, order);
}

}  // namespace

TEST_CASE("section 15: the table of opposites equals the chapter's quadratic procedure") {
    std::size_t compared = 0;
    for (const auto& [name, mesh] : test::named_meshes()) {
        const CornerTable table = build(mesh);
        if (mesh.triangle_count() > 600 || table.topology.nonmanifold_edges > 0) continue;
        if (table.topology.flipped > 0 || table.topology.cut_edges > 0 || table.topology.degenerate > 0) continue;
        CAPTURE_COPY(name);
        std::vector<CornerId> o(table.corners.size(), kNullCorner);
        for (std::uint32_t i = 0; i < o.size(); ++i) {
            for (std::uint32_t j = i + 1; j < o.size(); ++j) {
                const CornerId c{i}, b{j};
                if (table.vertex(next(c)) == table.vertex(previous(b)) &&
                    table.vertex(previous(c)) == table.vertex(next(b))) {
                    o[i] = b;
                    o[j] = c;
                }
            }
        }
        for (std::uint32_t i = 0; i < o.size(); ++i) CHECK(table.opposite(CornerId{i}) == o[i]);
        ++compared;
    }
    CHECK(compared > 30);
}

TEST_CASE("section 9: a swirl visits every triangle of a shell once, in the chapter's order") {
    for (const auto& [name, mesh] : test::named_meshes()) {
        CAPTURE_COPY(name);
        const CornerTable table = build(mesh);
        const std::uint32_t triangles = table.triangle_count();
        const std::uint32_t step = std::max(1U, triangles / 12) * 3 + 1;
        for (std::uint32_t s = 0; s < triangles * 3; s += step) {
            std::vector<bool> m(triangles, false);
            std::vector<CornerId> expected, order;
            recursive_swirl(table, CornerId{s}, m, expected);
            Swirl swirl(table);
            swirl.run(CornerId{s}, [&](CornerId c) { order.push_back(c); });
            REQUIRE(order.size() >= expected.size());
            CHECK(std::equal(expected.begin(), expected.end(), order.begin()));
            bool closed = true;
            std::vector<bool> seen(triangles, false);
            for (const CornerId c : order) {
                CHECK_FALSE(seen[triangle(c).value]);
                CHECK(swirl.visited(triangle(c)));
                seen[triangle(c).value] = true;
                if (c.value != s)
                    CHECK_MESSAGE(seen[triangle(table.opposite(c)).value], "entered from a visited triangle");
            }
            for (std::uint32_t i = 0; i < table.corners.size(); ++i) {  // whole shells: nothing open is left
                const CornerId o = table.opposite(CornerId{i});
                if (!o.is_null()) CHECK(seen[i / 3] == seen[triangle(o).value]);
                if (o.is_null() && seen[i / 3]) closed = false;
            }
            if (closed) CHECK(order == expected);  // the seed's own edge matters only where there is a border
        }
    }
}

TEST_CASE("section 9: a second swirl skips the triangles that the first visited") {
    const CornerTable table = build(mesh_of(test::grid(8, 8, true, true, false)));
    Swirl swirl(table);
    std::uint32_t first = 0, second = 0;
    swirl.run(CornerId{17}, [&](CornerId) { ++first; });
    swirl.run(CornerId{5}, [&](CornerId) { ++second; });
    CHECK(first == 128);
    CHECK(second == 0);
}

TEST_CASE("section 9: a swirl a million triangles deep") {
    // A recursive swirl descends one level per triangle of a strip.
    const CornerTable table = build(mesh_of(test::strip(1'000'000)));
    for (const std::uint32_t seed :
         {0U, 1U, 2U, 1'500'000U, 1'500'001U, 1'500'002U, 2'999'997U, 2'999'998U, 2'999'999U}) {
        Swirl swirl(table);
        std::uint32_t visits = 0;
        swirl.run(CornerId{seed}, [&](CornerId) { ++visits; });
        CHECK(visits == 1'000'000);
    }
}

TEST_CASE("section 8: swirl_shells visits each triangle once, shell by shell") {
    for (const auto& [name, mesh] : test::named_meshes()) {
        CAPTURE_COPY(name);
        const CornerTable table = build(mesh);
        const TopologyReport report = report_topology(table);
        std::uint32_t visits = 0, last = 0;
        CHECK(swirl_shells(table, [&](std::uint32_t shell, CornerId) {
                  CHECK((shell == last || shell == last + 1));
                  last = shell;
                  ++visits;
              }) == report.shells);
        CHECK(visits == report.triangles);
    }
}

TEST_CASE("section 9: c.n.v = c.o.p.v for any orientation of the input's triangles") {
    for (const std::uint32_t k : {1U, 2U, 3U, 7U}) {
        CAPTURE(k);
        const test::Shape shape = test::turn_some(test::shuffle(test::subdivide(test::cube()), k), k);
        const CornerTable table = build(mesh_of(shape));
        for (std::uint32_t i = 0; i < table.corners.size(); ++i) {
            const CornerId c{i}, o = table.opposite(c);
            CHECK(table.vertex(next(c)) == table.vertex(previous(o)));
            CHECK(table.vertex(previous(c)) == table.vertex(next(o)));
        }
        const TopologyReport report = report_topology(table);
        CHECK(report.orientable);
        CHECK(report.closed);
    }
    for (const test::Shape& shape : {test::projective_plane(), test::grid(7, 6, true, true, true),  // a Klein bottle
                                     test::grid(5, 1, true, false, true)}) {                        // a Moebius strip
        CHECK_FALSE(report_topology(build(mesh_of(shape))).orientable);
        CHECK_FALSE(report_topology(build(mesh_of(test::turn_some(shape, 2)))).orientable);
    }
}

TEST_CASE("section 12: the smesh test names its fault") {
    using test::beside;
    using test::pinch;
    const auto fault = [](const test::Shape& shape) { return check_connectivity(mesh_of(shape)).fault; };
    SUBCASE("simple meshes have none") {
        CHECK(fault(test::tetrahedron()) == SmeshFault::none);
        CHECK(fault(test::octahedron()) == SmeshFault::none);
        CHECK(fault(test::shuffle(test::turn_some(test::subdivide(test::cube()), 3), 9)) == SmeshFault::none);
        CHECK(fault(test::stack_random(test::tetrahedron(), 200, 3)) == SmeshFault::none);
    }
    SUBCASE("no triangle, or only degenerate ones") {
        CHECK(fault({5, {}}) == SmeshFault::empty);
        CHECK(fault({3, {{0, 0, 1}}}) == SmeshFault::empty);
    }
    SUBCASE("a degenerate triangle beside a tetrahedron") {
        CHECK(fault({4, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {0, 2, 3}, {0, 0, 1}}}) == SmeshFault::degenerate);
    }
    SUBCASE("tetrahedra that share an edge") {
        CHECK(fault(pinch(pinch(beside(test::tetrahedron(), test::tetrahedron()), 4, 0), 5, 1)) ==
              SmeshFault::nonmanifold_edge);
    }
    SUBCASE("a border: a triangle, a Moebius strip") {
        CHECK(fault({3, {{0, 1, 2}}}) == SmeshFault::border);
        CHECK(fault(test::grid(5, 1, true, false, true)) == SmeshFault::border);
    }
    SUBCASE("two shells, apart or joined at a vertex") {
        CHECK(fault(beside(test::tetrahedron(), test::octahedron())) == SmeshFault::not_connected);
        CHECK(fault(pinch(beside(test::tetrahedron(), test::tetrahedron()), 4, 0)) == SmeshFault::not_connected);
    }
    SUBCASE("the projective plane and a Klein bottle") {
        CHECK(fault(test::projective_plane()) == SmeshFault::not_orientable);
        CHECK(fault(test::grid(7, 6, true, true, true)) == SmeshFault::not_orientable);
    }
    SUBCASE("a sphere two of whose vertices are one") {
        CHECK(fault(pinch(test::subdivide(test::subdivide(test::octahedron())), 1, 0)) ==
              SmeshFault::nonmanifold_vertex);
    }
    SUBCASE("handles: a torus, a plate with five holes") {
        CHECK(fault(test::smallest_torus()) == SmeshFault::handles);
        const SmeshCheck plate = check_connectivity(mesh_of(test::plate(5)));
        CHECK(plate.fault == SmeshFault::handles);
        CHECK(plate.reason == "5 handles");
    }
}

TEST_CASE("section 12: Equations 1 and 2 hold for the closed manifolds of genus 0, and no others") {
    std::size_t spheres = 0, others = 0;
    for (const auto& [name, mesh] : test::named_meshes()) {
        CAPTURE_COPY(name);
        const CornerTable table = build(mesh);
        const TopologyReport report = report_topology(table);
        const SmeshCheck check = check_smesh(table, report);
        CHECK(check.is_smesh() == check.reason.empty());
        if (!check.is_smesh() && check.fault != SmeshFault::handles) continue;
        // A closed edge-manifold has 3|F| = 2|E|. Equation 2 is |F| - |E| + |G| = 2.
        REQUIRE(report.triangles % 2 == 0);
        const std::int64_t f = report.triangles, e = f / 2 * 3, g = report.used_vertices;
        CHECK(satisfies_equation_1(report) == (f - e + g == 2));
        CHECK(check.is_smesh() == (f - e + g == 2));
        CHECK(f - e + g == 2 - 2 * report.genus);
        (check.is_smesh() ? spheres : others) += 1;
    }
    CHECK(spheres > 15);
    CHECK(others > 10);
}

TEST_CASE("section 12: the genus is the number of handles") {
    for (std::uint32_t holes = 0; holes < 7; ++holes) {
        CAPTURE(holes);
        CHECK(report_topology(build(mesh_of(test::plate(holes)))).genus == holes);
    }
    const TopologyReport two = report_topology(build(mesh_of(test::beside(test::plate(3), test::smallest_torus()))));
    CHECK(two.genus == 4);
    CHECK(two.shells == 2);
    const TopologyReport holed = report_topology(build(mesh_of(test::grid_with_holes(9, 7))));
    CHECK(holed.genus == 0);
    CHECK(holed.border_loops == 4 * 3 + 1);
}

TEST_CASE("section 11: a pseudo-manifold copies a vertex once per fan after the first") {
    const auto copies = [](const test::Shape& shape) {
        CornerTable table = build(mesh_of(shape));
        const TopologyReport before = report_topology(table);
        const std::vector<VertexId> split = split_fans(table);
        CHECK(check_corner_table(table) == "");
        const TopologyReport after = report_topology(table);
        CHECK(after.nonmanifold_vertices == 0);
        CHECK(after.used_vertices == before.fans);
        CHECK(split.size() == before.fans - before.used_vertices);
        return split.size();
    };
    using test::beside;
    using test::pinch;
    const test::Shape two = beside(test::tetrahedron(), test::tetrahedron());
    CHECK(copies(test::octahedron()) == 0);
    CHECK_MESSAGE(copies({5, {{0, 1, 2}, {0, 3, 4}}}) == 1, "two triangles at a vertex");
    CHECK_MESSAGE(copies(pinch(two, 4, 0)) == 1, "two tetrahedra at a vertex");
    CHECK_MESSAGE(copies({6, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {1, 0, 5}}}) == 2, "two quads crossing at an edge");
    CHECK_MESSAGE(copies({5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}}) == 2, "a quad and a triangle at its diagonal");
    // The four triangles at the edge are joined across the tetrahedra: one shell, and each vertex has one fan.
    CHECK_MESSAGE(copies(pinch(pinch(two, 4, 0), 5, 1)) == 0, "two tetrahedra at an edge");
}
