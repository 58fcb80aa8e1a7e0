#include <doctest/doctest.h>

#include "lacedring/ring.hpp"
#include "tests/support/capture.h"
#include "tests/support/meshes.h"

using namespace lacedring;

namespace {

void check_ring(const Mesh& mesh, const RingOptions& options) {
    const Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
    REQUIRE(table);
    const Rings rings = expand_rings(*table, options);
    CHECK(check_rings(*table, rings) == "");

    std::vector<bool> on_ring(mesh.vertex_count, false);
    for (const RingEdge& edge : rings.edges) on_ring[edge.start.value] = true;
    {
        INFO("no ring can grow: each right tip is on a ring");
        for (const RingEdge& edge : rings.edges) {
            if (!edge.right_tip.is_null()) CHECK(on_ring[edge.right_tip.value]);
        }
    }
    {
        INFO("no other ring can begin: each triangle has a vertex on a ring");
        for (std::uint32_t t = 0; t < table->triangle_count(); ++t) {
            if (table->degenerate(TriangleId{t})) continue;
            CHECK(
                (on_ring[mesh.indices[3 * t]] || on_ring[mesh.indices[3 * t + 1]] || on_ring[mesh.indices[3 * t + 2]]));
        }
    }
    INFO("the same options give the same rings");
    const Rings again = expand_rings(*table, options);
    CHECK(again.first == rings.first);
    for (std::size_t i = 0; i < rings.edges.size(); ++i) CHECK(again.edges[i].left == rings.edges[i].left);
}

}  // namespace

TEST_CASE("rings of named meshes are cycles that cannot grow") {
    for (const auto& [name, mesh] : test::named_meshes()) {
        CAPTURE_COPY(name);
        check_ring(mesh, {1, 1});
        check_ring(mesh, {5, 7});
        check_ring(mesh, {1, 1, 1});
        check_ring(mesh, {3, 1, 20});
    }
}

TEST_CASE("rings of random soups are cycles that cannot grow") {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        CAPTURE(seed);
        check_ring(test::random_soup(4 + static_cast<std::uint32_t>(seed % 23),
                                     1 + static_cast<std::uint32_t>(seed % 71), seed),
                   {3, seed});
        check_ring(test::random_gluing(40, 120, seed), {3, seed});
    }
}

TEST_CASE("check_rings refuses damaged rings") {
    const Mesh mesh = test::make_mesh({0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5}, 6);
    const Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
    REQUIRE(table);
    const Rings good = expand_rings(*table);
    REQUIRE(check_rings(*table, good) == "");
    Rings bad = good;
    std::swap(bad.edges[0], bad.edges[1]);
    CHECK(check_rings(*table, bad) != "");
    bad = good;
    bad.edges[1] = bad.edges[0];
    CHECK(check_rings(*table, bad) != "");
    bad = good;
    bad.edges[0].left = next(bad.edges[0].left);
    CHECK(check_rings(*table, bad) != "");
    bad = good;
    bad.first = {0, 2, static_cast<std::uint32_t>(bad.edges.size())};
    CHECK(check_rings(*table, bad) != "");
}

TEST_CASE("the octahedron's ring is Hamiltonian") {
    const Mesh mesh = test::make_mesh({0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5}, 6);
    const Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
    REQUIRE(table);
    const Rings rings = expand_rings(*table);
    REQUIRE(rings.count() == 1);
    CHECK(rings.edges.size() == 6);
}
