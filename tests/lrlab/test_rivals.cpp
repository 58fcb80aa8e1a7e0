// Compares the corner table with C, the winged edge and SQuad with the corner table that they were built from.

#include <doctest/doctest.h>

#include "lacedring/topology.hpp"
#include "lrlab/generate/generate.h"
#include "lrlab/rivals/corner_table_c.h"
#include "lrlab/rivals/squad.h"
#include "lrlab/rivals/winged_edge.h"
#include "tests/support/capture.h"
#include "tests/support/meshes.h"
#include "tests/support/operator_oracle.h"

using namespace lacedring;

namespace {

CornerTable pseudo_manifold(const Mesh& mesh) {
    Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
    REQUIRE(table);
    split_fans(*table);
    return std::move(*table);
}

/// The map of a structure that keeps the numbers of triangles and vertices.
LrMap identity(const CornerTable& table) {
    LrMap map;
    for (std::uint32_t v = 0; v < table.vertex_count; ++v) map.vertex.push_back(VertexId{v});
    for (std::uint32_t t = 0; t < table.triangle_count(); ++t) {
        map.triangle.push_back(table.degenerate(TriangleId{t}) ? kNullTriangle : TriangleId{t});
    }
    map.start.assign(map.triangle.size(), 0);
    return map;
}

/// Checks that stars and neighbors are in the order of swing, at a border from one border neighbor to the other.
template <class Ops>
void check_order(const Ops& ops) {
    for (std::uint32_t v = 0; v < ops.vertices; ++v) {
        CAPTURE(v);
        std::vector<CornerId> star;
        std::vector<VertexId> neighbors, expected;
        ops.star(VertexId{v}, [&](CornerId c) { star.push_back(c); });
        ops.neighbors(VertexId{v}, [&](VertexId u) { neighbors.push_back(u); });
        for (std::size_t i = 0; i < star.size(); ++i) {
            expected.push_back(ops.vertex(ops.next(star[i])));
            const CornerId after = i + 1 < star.size()          ? star[i + 1]
                                   : ops.is_border(VertexId{v}) ? kNullCorner
                                                                : star[0];
            REQUIRE_MESSAGE(ops.swing(star[i]) == after, "the star is in the order of swing");
        }
        if (star.empty()) continue;
        if (ops.is_border(VertexId{v})) {
            REQUIRE(ops.swing_back(star[0]).is_null());
            expected.push_back(ops.vertex(ops.previous(star.back())));
        } else {
            REQUIRE(star[0] == ops.corner(VertexId{v}));
        }
        REQUIRE_MESSAGE(neighbors == expected, "neighbors are in the order of swing");
    }
}

struct Counts {
    std::uint32_t triangles = 0, used_vertices = 0;
};
Counts count(const CornerTable& table) {
    Counts counts;
    std::vector<bool> used(table.vertex_count, false);
    for (std::uint32_t t = 0; t < table.triangle_count(); ++t) {
        if (table.degenerate(TriangleId{t})) continue;
        ++counts.triangles;
        for (std::uint32_t i = 0; i < 3; ++i) used[table.vertex(corner(TriangleId{t}, i)).value] = true;
    }
    for (const bool u : used) counts.used_vertices += std::uint32_t{u};
    return counts;
}

Squad check_squad(const CornerTable& table, const SquadOptions& options) {
    LrMap map;
    Result<Squad> squad = build_squad(table, options, &map);
    REQUIRE(squad);
    const SquadView view = squad->view();
    const SquadStatistics& s = squad->statistics;
    const Counts counts = count(table);
    const std::uint32_t records = s.quads + s.singles + s.extra_quads + s.extra_singles;
    CHECK(squad->matched == s.quads + s.singles);
    CHECK(squad->matched + s.unmatched == counts.used_vertices);
    CHECK(records + s.quads + s.extra_quads == counts.triangles);
    CHECK(view.references() == std::size_t{4} * records + s.unmatched);
    CHECK(view.triangle_numbers() == 2 * records);
    test::check_operators(table, view, map);
    check_order(view);
    return std::move(*squad);
}

void check_rivals(const Mesh& mesh) {
    const CornerTable table = pseudo_manifold(mesh);
    const CornerTableC with_c = build_corner_table_c(table);
    CHECK(with_c.view().references() == std::size_t{6} * table.triangle_count() + table.vertex_count);
    test::check_operators(table, with_c.view(), identity(table), 3);
    check_order(with_c.view());
    const WingedEdge winged = build_winged_edge(table);
    CHECK(winged.view().references() == std::size_t{9} * table.triangle_count() + table.vertex_count);
    test::check_operators(table, winged.view(), identity(table), 3);
    check_order(winged.view());
    const Squad squad = check_squad(table, {});
    const Squad greedy = check_squad(table, {.renumber = false, .reach = 0});
    CHECK(squad.view().references() <= greedy.view().references());
}

}  // namespace

TEST_CASE("corner table with C, winged edge and SQuad equal the corner table on named meshes") {
    for (const auto& [name, mesh] : test::named_meshes()) {
        CAPTURE_COPY(name);
        check_rivals(mesh);
    }
}

TEST_CASE("corner table with C, winged edge and SQuad equal the corner table on random soups") {
    for (std::uint64_t seed = 1; seed <= 400; ++seed) {
        CAPTURE(seed);
        check_rivals(test::random_soup(4 + static_cast<std::uint32_t>(seed % 29),
                                       1 + static_cast<std::uint32_t>(seed % 83), seed));
        check_rivals(test::random_gluing(10 + static_cast<std::uint32_t>(seed % 50), 150, seed));
    }
}

TEST_CASE("SQuad's references of a triangle, a quad and a tetrahedron") {
    const auto references = [](const Mesh& mesh, const SquadOptions& options = {}) {
        return check_squad(pseudo_manifold(mesh), options).view().references();
    };
    CHECK(references(test::make_mesh(std::vector<std::uint32_t>{}, 3)) == 0);
    CHECK_MESSAGE(references(test::make_mesh({0, 1, 2}, 3)) == 4 + 2, "two vertices without a record");
    CHECK_MESSAGE(references(test::make_mesh({0, 1, 2, 2, 1, 3}, 4)) == 2 * 4 + 2, "each triangle has a vertex");
    CHECK_MESSAGE(references(test::make_mesh({0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2}, 4)) == 4 * 4, "all records single");
    for (const char* const kind : {"sphere", "torus", "genus", "blob"}) {
        CAPTURE(kind);
        const Result<Mesh> mesh = generate(kind, 20000);
        REQUIRE(mesh);
        const auto triangles = static_cast<double>(mesh->triangle_count());
        CHECK(static_cast<double>(references(*mesh)) < 2.1 * triangles);
        CHECK(static_cast<double>(references(*mesh, {.reach = 0})) < 2.25 * triangles);
    }
}
