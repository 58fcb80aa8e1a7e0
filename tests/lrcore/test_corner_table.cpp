#include <doctest/doctest.h>

#include <algorithm>
#include <map>

#include "lacedring/topology.hpp"
#include "tests/support/capture.h"
#include "tests/support/meshes.h"

using namespace lacedring;

namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;
/// The corners opposite to each undirected edge.
using EdgeCorners = std::map<Edge, std::vector<CornerId>>;

EdgeCorners edge_corners(const CornerTable& table) {
    EdgeCorners out;
    for (std::uint32_t i = 0; i < table.corners.size(); ++i) {
        const CornerId c{i};
        if (table.degenerate(triangle(c))) continue;
        out[std::minmax(table.vertex(next(c)).value, table.vertex(previous(c)).value)].push_back(c);
    }
    return out;
}

void check_table_triangles(const CornerTable& table, const Mesh& mesh) {
    INFO("each triangle has the mesh's vertices, the last two swapped where it is flipped");
    REQUIRE(table.triangle_count() == mesh.triangle_count());
    std::uint32_t degenerate = 0, flipped = 0;
    for (std::uint32_t t = 0; t < table.triangle_count(); ++t) {
        CAPTURE(t);
        const std::uint32_t a = mesh.indices[3 * t], b = mesh.indices[3 * t + 1], c = mesh.indices[3 * t + 2];
        const bool turned = table.flipped(TriangleId{t});
        CHECK(table.vertex(corner(TriangleId{t}, 0)).value == a);
        CHECK(table.vertex(corner(TriangleId{t}, 1)).value == (turned ? c : b));
        CHECK(table.vertex(corner(TriangleId{t}, 2)).value == (turned ? b : c));
        flipped += turned ? 1 : 0;
        if (a != b && b != c && c != a) continue;
        ++degenerate;
        CHECK(table.degenerate(TriangleId{t}));
    }
    CHECK(table.topology.degenerate == degenerate);
    CHECK(table.topology.flipped == flipped);
}

std::size_t count_joined(const CornerTable& table, const std::vector<CornerId>& corners) {
    return static_cast<std::size_t>(
        std::ranges::count_if(corners, [&](CornerId c) { return !table.opposite(c).is_null(); }));
}

/// How many of the corners' half-edges start at `start`.
std::size_t count_forward(const CornerTable& table, const std::vector<CornerId>& corners, std::uint32_t start) {
    return static_cast<std::size_t>(
        std::ranges::count_if(corners, [&](CornerId c) { return table.vertex(next(c)).value == start; }));
}

void check_opposites(const CornerTable& table, const EdgeCorners& edges) {
    INFO("opposite corners are of the same edge");
    for (const auto& [edge, corners] : edges) {
        for (const CornerId c : corners) {
            const CornerId o = table.opposite(c);
            if (!o.is_null()) CHECK(std::find(corners.begin(), corners.end(), o) != corners.end());
        }
    }
}

void check_joined_edges(const CornerTable& table, const EdgeCorners& edges) {
    for (const auto& [edge, corners] : edges) {
        const std::size_t forward = count_forward(table, corners, edge.first), joined = count_joined(table, corners);
        if (corners.size() == 2 && joined == 0) {
            INFO("two triangles that run along their edge in opposite directions are joined");
            CHECK(forward != 1);
        }
        if (corners.size() > 2) {
            INFO("at a non-manifold edge, as many pairs are joined as there are opposed half-edges");
            CHECK(joined == 2 * std::min(forward, corners.size() - forward));
        }
    }
}

void check_edge_counts(const CornerTable& table, const EdgeCorners& edges) {
    INFO("the topology counts border, non-manifold and cut edges");
    std::uint32_t border = 0, nonmanifold = 0, cut = 0;
    for (const auto& [edge, corners] : edges) {
        border += corners.size() == 1 ? 1 : 0;
        nonmanifold += corners.size() > 2 ? 1 : 0;
        cut += corners.size() == 2 && count_joined(table, corners) == 0 ? 1 : 0;
    }
    CHECK(table.topology.border_edges == border);
    CHECK(table.topology.nonmanifold_edges == nonmanifold);
    CHECK(table.topology.cut_edges == cut);
}

/// Builds the corner table of a mesh and compares it with the mesh's edges.
CornerTable check_table(const Mesh& mesh) {
    Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
    REQUIRE(table);
    CHECK(check_corner_table(*table) == "");
    check_table_triangles(*table, mesh);
    const EdgeCorners edges = edge_corners(*table);
    check_opposites(*table, edges);
    check_joined_edges(*table, edges);
    check_edge_counts(*table, edges);
    return std::move(*table);
}

}  // namespace

TEST_CASE("a corner table has the edges of named meshes") {
    for (const auto& [name, mesh] : test::named_meshes()) {
        CAPTURE_COPY(name);
        check_table(mesh);
    }
}

TEST_CASE("a corner table has the edges of random soups") {
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        CAPTURE(seed);
        check_table(test::random_soup(4 + static_cast<std::uint32_t>(seed % 17),
                                      1 + static_cast<std::uint32_t>(seed % 61), seed));
        check_table(test::random_gluing(30, 100, seed));
    }
}

TEST_CASE("corner operators on an octahedron") {
    const Mesh mesh = test::make_mesh({0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5}, 6);
    const CornerTable table = check_table(mesh);
    const auto for_each_corner = [&](auto check) {
        for (std::uint32_t i = 0; i < table.corners.size(); ++i) {
            CAPTURE(i);
            check(CornerId{i});
        }
    };
    SUBCASE("previous is the inverse of next") {
        for_each_corner([](CornerId c) { CHECK(previous(next(c)) == c); });
    }
    SUBCASE("previous is next twice") {
        for_each_corner([](CornerId c) { CHECK(next(next(c)) == previous(c)); });
    }
    SUBCASE("the opposite of the opposite is the corner itself") {
        for_each_corner([&](CornerId c) { CHECK(table.opposite(table.opposite(c)) == c); });
    }
    SUBCASE("four swings visit corners of one vertex and return to the first") {
        for_each_corner([&](CornerId c) {
            CornerId x = c;
            for (int k = 0; k < 4; ++k) {
                CHECK(table.vertex(x) == table.vertex(c));
                x = table.swing(x);
            }
            CHECK(x == c);
        });
    }
}

TEST_CASE("topology report") {
    const auto report = [](const Mesh& mesh) { return report_topology(check_table(mesh)); };
    SUBCASE("an octahedron is closed, of genus 0 and of valence 4") {
        const TopologyReport r =
            report(test::make_mesh({0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5}, 6));
        CHECK(r.components == 1);
        CHECK(r.closed);
        CHECK(r.genus == 0);
        CHECK(r.euler_characteristic == 2);
        CHECK(r.max_valence == 4);
    }
    SUBCASE("two triangles at one vertex: one vertex, two fans") {
        const TopologyReport r = report(test::make_mesh({0, 1, 2, 0, 3, 4}, 5));
        CHECK(r.components == 1);
        CHECK(r.shells == 2);
        CHECK(r.nonmanifold_vertices == 1);
        CHECK(r.fans == 6);
        CHECK(r.border_loops == 2);
        CHECK(r.genus == 0);
    }
    SUBCASE("a Moebius strip is not orientable") {
        const TopologyReport r = report(test::make_mesh({0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 5, 4, 4, 5, 1, 5, 0, 1}, 6));
        CHECK_FALSE(r.orientable);
        CHECK_FALSE(r.closed);
    }
    SUBCASE("a triangle of the wrong orientation is flipped") {
        const Mesh mesh = test::make_mesh({0, 1, 2, 1, 2, 3, 2, 4, 3}, 5);  // the second is clockwise
        const CornerTable table = check_table(mesh);
        CHECK(table.topology.flipped == 1);
        CHECK(table.topology.cut_edges == 0);
        CHECK(report_topology(table).components == 1);
    }
    SUBCASE("unused vertices do not count") {
        const TopologyReport r = report(test::make_mesh({0, 1, 2}, 10));
        CHECK(r.used_vertices == 3);
        CHECK(r.triangles == 1);
    }
}

TEST_CASE("a corner table refuses indices beyond the vertex count, and vertices beyond 2^29") {
    const std::vector<std::uint32_t> indices{0, 1, 2};
    CHECK_FALSE(build_corner_table(indices, 2));
    CHECK(build_corner_table(indices, 2).error().code == ErrorCode::malformed);
    CHECK_FALSE(build_corner_table({}, (1U << 29) + 1));
    CHECK(build_corner_table({}, 0));
}

TEST_CASE("a vertex of a hundred thousand triangles takes no quadratic time") {
    // The hub is the smaller vertex of all its edges: comparing them pairwise takes 10^10 steps.
    std::vector<std::uint32_t> indices;
    constexpr std::uint32_t kRim = 100000;
    for (std::uint32_t i = 0; i < kRim; ++i) indices.insert(indices.end(), {0, 1 + i, 1 + (i + 1) % kRim});
    const Result<CornerTable> table = build_corner_table(indices, kRim + 1);
    REQUIRE(table);
    CHECK(check_corner_table(*table) == "");
    CHECK(table->topology.border_edges == kRim);
}
