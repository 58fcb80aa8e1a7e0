#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "lacedring/lacedring.hpp"
#include "lacedring/mesh_files.hpp"
#include "lacedring/operators.hpp"
#include "lacedring/ring.hpp"
#include "lacedring/streams.hpp"
#include "lacedring/topology.hpp"
#include "tests/support/capture.h"
#include "tests/support/fast_require.h"
#include "tests/support/meshes.h"
#include "tests/support/operator_oracle.h"

using namespace lacedring;

namespace {

/// Checks that star() and neighbors() of a border vertex begin at the border and continue in the order of swing.
template <class Operators>
void check_border_order(const CornerTable& table, const Operators& ops, const LrMap& map) {
    // For each vertex, the corner that is not the swing of another corner.
    std::vector<CornerId> begin(table.vertex_count, kNullCorner);
    for (std::uint32_t i = 0; i < table.corners.size(); ++i) {
        const CornerId c{i};
        if (!table.degenerate(triangle(c)) && table.right(c).is_null()) begin[table.vertex(c).value] = c;
    }
    for (std::uint32_t v = 0; v < map.vertex.size(); ++v) {
        CornerId c = begin[map.vertex[v].value];
        if (c.is_null()) continue;
        CAPTURE(v);
        std::vector<CornerId> star, expected_star;
        std::vector<VertexId> neighbors, expected_neighbors;
        for (CornerId last; !c.is_null(); c = table.swing(last)) {
            last = c;
            expected_star.push_back(c);
            expected_neighbors.push_back(table.vertex(next(c)));
            if (table.left(c).is_null()) expected_neighbors.push_back(table.vertex(previous(c)));
        }
        ops.star(VertexId{v}, [&](CornerId x) {
            star.push_back(corner(map.triangle[x.value / 4], (map.start[x.value / 4] + x.value % 4) % 3));
        });
        ops.neighbors(VertexId{v}, [&](VertexId u) { neighbors.push_back(map.vertex[u.value]); });
        REQUIRE_FAST(star == expected_star);
        REQUIRE_FAST(neighbors == expected_neighbors);
    }
}

/// Builds standard and bit-efficient LR tables of a mesh and compares their operators with the corner table's.
void check_lr(const Mesh& mesh, const RingOptions& rings_options, const LrOptions& options,
              const OptimizeOptions& optimize = {.passes = 0}) {
    Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
    REQUIRE(table);
    split_fans(*table);
    CHECK(check_corner_table(*table) == "");
    RingOptions one = rings_options;
    one.one_per_shell = true;
    const Rings rings = optimize_rings(*table, expand_rings(*table, one), optimize);
    REQUIRE(check_rings(*table, rings) == "");
    LrMap map;
    const Result<LrTable> lr = build_lr(*table, rings, options, &map);
    REQUIRE(lr);
    const LrStatistics& s = lr->statistics;
    CHECK(lr->view().references() == std::size_t{2} * lr->ring_vertices + std::size_t{6} * s.t0 +
                                         std::size_t{3} * (s.t1_irregular + s.t2_irregular) + s.isolated);
    const auto valid = validate_lr(serialize(*lr, {}));
    CHECK_MESSAGE(valid, (valid ? "" : valid.error().message));
    test::check_operators(*table, Operators<LrView>(lr->view()), map);
    check_border_order(*table, Operators<LrView>(lr->view()), map);

    const Result<CompactLrTable> compact = build_compact_lr(lr->view());
    REQUIRE(compact);
    CHECK(compact->view().bytes() == 4 * (std::size_t{compact->ring_vertices} + std::size_t{6} * s.t0 +
                                          std::size_t{3} * compact->irregular + compact->long_tips + s.isolated));
    const auto valid_compact = validate_compact_lr(serialize(*compact, {}));
    CHECK_MESSAGE(valid_compact, (valid_compact ? "" : valid_compact.error().message));
    test::check_operators(*table, Operators<CompactLrView>(compact->view()), map);
    check_border_order(*table, Operators<CompactLrView>(compact->view()), map);
}

}  // namespace

TEST_CASE("LR operators equal the corner table's on named meshes") {
    for (const auto& [name, mesh] : test::named_meshes()) {
        CAPTURE_COPY(name);
        check_lr(mesh, {1, 1}, {});
        check_lr(mesh, {1, 1}, {.wart_skipping = false});
        check_lr(mesh, {4, 9}, {});
        check_lr(mesh, {1, 1, 1}, {});
        check_lr(mesh, {2, 5, 32}, {});
    }
}

TEST_CASE("LR operators equal the corner table's on optimized rings") {
    for (const auto& [name, mesh] : test::named_meshes()) {
        CAPTURE_COPY(name);
        check_lr(mesh, {}, {}, {.cost = kLrRingCost, .passes = 6});
        check_lr(mesh, {.k = 9}, {.wart_skipping = false}, {.cost = kLeanRingCost, .passes = 3});
    }
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        CAPTURE(seed);
        const auto n = static_cast<std::uint32_t>(seed);
        check_lr(test::random_gluing(10 + n % 50, 150, seed), {}, {.wart_skipping = n % 3 != 0},
                 {.cost = n % 2 == 0 ? kLeanRingCost : kPackedRingCost, .passes = 5, .random_seed = seed});
    }
}

TEST_CASE("LR operators equal the corner table's on random soups") {
    for (std::uint64_t seed = 1; seed <= 400; ++seed) {
        CAPTURE(seed);
        const bool warts = seed % 3 != 0;
        check_lr(test::random_soup(4 + static_cast<std::uint32_t>(seed % 29), 1 + static_cast<std::uint32_t>(seed % 83),
                                   seed),
                 {2, seed}, {warts});
        check_lr(test::random_gluing(10 + static_cast<std::uint32_t>(seed % 50), 150, seed),
                 {1, seed, static_cast<std::uint32_t>(seed % 7)}, {warts});
    }
}

TEST_CASE("LR operators equal the corner table's on the meshes of LACEDRING_MESHES, where that is set") {
    const auto checked = test::for_each_real_mesh([&](const std::string& path, const Result<Mesh>& mesh) {
        CAPTURE(path);
        REQUIRE(mesh);
        for (const Weld mode : {Weld::none, Weld::position}) {
            const Mesh welded = weld(*mesh, mode);
            check_lr(welded, {1, 1}, {});
            check_lr(welded, {1, 1, 50}, {.wart_skipping = false});
            check_lr(welded, {}, {}, {.cost = kLrRingCost, .passes = 4});
        }
    });
    CHECK_MESSAGE(checked.value_or(1) > 0, "the folder has meshes");
}
