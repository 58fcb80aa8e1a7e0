#include <doctest/doctest.h>

#include <algorithm>
#include <map>

#include "lacedring/topology.hpp"
#include "tests/support/capture.h"
#include "tests/support/meshes.h"

using namespace lacedring;

namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// The corner table against maps over edges. Returns it for more checks.
CornerTable check_table(const Mesh& mesh) {
    Result<CornerTable> built = build_corner_table(mesh.indices, mesh.vertex_count);
    REQUIRE(built);
    const CornerTable& table = *built;
    CHECK(check_corner_table(table) == "");
    REQUIRE(table.triangle_count() == mesh.triangle_count());

    std::map<Edge, std::vector<CornerId>> edges;  // of the oriented table, undirected
    std::uint32_t degenerate = 0, flipped = 0;
    for (std::uint32_t t = 0; t < table.triangle_count(); ++t) {
        const std::uint32_t a = mesh.indices[3 * t], b = mesh.indices[3 * t + 1], c = mesh.indices[3 * t + 2];
        const bool turned = table.flipped(TriangleId{t});
        CHECK(table.vertex(corner(TriangleId{t}, 0)).value == a);
        CHECK(table.vertex(corner(TriangleId{t}, 1)).value == (turned ? c : b));
        CHECK(table.vertex(corner(TriangleId{t}, 2)).value == (turned ? b : c));
        flipped += turned ? 1 : 0;
        if (a == b || b == c || c == a) {
            ++degenerate;
            CHECK(table.degenerate(TriangleId{t}));
            continue;
        }
        for (std::uint32_t k = 0; k < 3; ++k) {
            const CornerId x = corner(TriangleId{t}, k);
            edges[std::minmax(table.vertex(next(x)).value, table.vertex(previous(x)).value)].push_back(x);
        }
    }
    CHECK(table.topology.degenerate == degenerate);
    CHECK(table.topology.flipped == flipped);

    std::uint32_t border = 0, nonmanifold = 0, cut = 0;
    for (const auto& [edge, corners] : edges) {
        std::size_t forward = 0, joined = 0;
        for (const CornerId c : corners) {
            forward += table.vertex(next(c)).value == edge.first ? 1 : 0;
            const CornerId o = table.opposite(c);
            if (o.is_null()) continue;
            ++joined;
            CHECK(std::find(corners.begin(), corners.end(), o) != corners.end());
        }
        border += corners.size() == 1 ? 1 : 0;
        nonmanifold += corners.size() > 2 ? 1 : 0;
        if (corners.size() == 2) cut += joined == 0 ? 1 : 0;
        if (corners.size() == 2 && joined == 0) CHECK(forward != 1);  // opposed half-edges are always joined
        if (corners.size() > 2) CHECK(joined == 2 * std::min(forward, corners.size() - forward));
    }
    CHECK(table.topology.border_edges == border);
    CHECK(table.topology.nonmanifold_edges == nonmanifold);
    CHECK(table.topology.cut_edges == cut);
    return std::move(*built);
}

}  // namespace

TEST_CASE("corner table equals the edges of named meshes") {
    for (const auto& [name, mesh] : test::named_meshes()) {
        CAPTURE_COPY(name);
        check_table(mesh);
    }
}

TEST_CASE("corner table equals the edges of random soups") {
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        CAPTURE(seed);
        check_table(test::random_soup(4 + static_cast<std::uint32_t>(seed % 17),
                                      1 + static_cast<std::uint32_t>(seed % 61), seed));
        check_table(test::random_gluing(30, 100, seed));
    }
}

TEST_CASE("operators around a vertex of an octahedron") {
    const Mesh mesh = test::make_mesh({0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5}, 6);
    const CornerTable table = check_table(mesh);
    for (std::uint32_t i = 0; i < table.corners.size(); ++i) {
        const CornerId c{i};
        CHECK(previous(next(c)) == c);
        CHECK(next(next(c)) == previous(c));
        CHECK(table.opposite(table.opposite(c)) == c);
        CornerId x = c;
        for (int k = 0; k < 4; ++k) {
            CHECK(table.vertex(x) == table.vertex(c));
            x = table.swing(x);
        }
        CHECK(x == c);  // valence four
    }
    const TopologyReport report = report_topology(table);
    CHECK(report.components == 1);
    CHECK(report.closed);
    CHECK(report.genus == 0);
    CHECK(report.euler_characteristic == 2);
    CHECK(report.max_valence == 4);
}

TEST_CASE("topology report") {
    const auto report = [](const Mesh& mesh) { return report_topology(check_table(mesh)); };
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
    SUBCASE("a triangle turned round is turned back") {
        const Mesh mesh = test::make_mesh({0, 1, 2, 1, 2, 3, 2, 4, 3}, 5);  // the middle one runs the wrong way
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

TEST_CASE("corner table refuses what it cannot number") {
    const std::vector<std::uint32_t> indices{0, 1, 2};
    CHECK_FALSE(build_corner_table(indices, 2));
    CHECK(build_corner_table(indices, 2).error().code == ErrorCode::malformed);
    CHECK_FALSE(build_corner_table({}, (1U << 29) + 1));
    CHECK(build_corner_table({}, 0));
}

TEST_CASE("a star of a hundred thousand triangles takes no quadratic time") {
    // Every edge at the hub has the hub as its smaller vertex; without sorting, 10^10 comparisons.
    std::vector<std::uint32_t> indices;
    constexpr std::uint32_t kRim = 100000;
    for (std::uint32_t i = 0; i < kRim; ++i) indices.insert(indices.end(), {0, 1 + i, 1 + (i + 1) % kRim});
    const Result<CornerTable> table = build_corner_table(indices, kRim + 1);
    REQUIRE(table);
    CHECK(check_corner_table(*table) == "");
    CHECK(table->topology.border_edges == kRim);
}
