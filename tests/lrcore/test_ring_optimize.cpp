#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>

#include "lacedring/lacedring.hpp"
#include "lacedring/mesh_files.hpp"
#include "lacedring/ring.hpp"
#include "lacedring/streams.hpp"
#include "lacedring/topology.hpp"
#include "lrcore/base/bits.h"
#include "lrcore/ring/ring_walk.h"
#include "lrlab/generate/generate.h"
#include "tests/support/capture.h"
#include "tests/support/meshes.h"

using namespace lacedring;

namespace {

/// The cost of rings, counted independently of optimize_rings.
std::int64_t cost_of(const CornerTable& table, const Rings& rings, const RingCost& cost) {
    BitVector rung(table.triangle_count()), wart(table.triangle_count()), on_ring(table.vertex_count);
    for (const RingEdge& edge : rings.edges) {
        on_ring.set(edge.start.value);
        rung.set(triangle(edge.left).value);
        if (!edge.right.is_null()) rung.set(triangle(edge.right).value);
    }
    for (std::size_t r = 0; r < rings.count(); ++r) {
        const RingWalk walk(rings.ring(r));
        for (std::uint32_t side = 0; side < 2; ++side) {
            for (std::size_t i = 0; i < walk.size(); ++i) {
                if (!walk.repeats(side, i) || walk.is_t3(side)) continue;
                const CornerId y = walk.across_t2(table, side, i);
                if (!y.is_null()) wart.set(triangle(y).value);
            }
        }
    }
    std::int64_t sum = 0;
    for (std::uint32_t t = 0; t < table.triangle_count(); ++t) {
        if (!rung.test(t) && !table.degenerate(TriangleId{t})) sum += wart.test(t) ? cost.t0_wart : cost.t0;
    }
    for (std::uint32_t v = 0; v < table.vertex_count; ++v) sum += on_ring.test(v) ? 0 : cost.isolated;
    return sum;
}

bool same(const Rings& a, const Rings& b) {
    const auto equal = [](const RingEdge& x, const RingEdge& y) { return x.left == y.left; };
    return a.first == b.first && std::equal(a.edges.begin(), a.edges.end(), b.edges.begin(), b.edges.end(), equal);
}

void check_lean_of(const Mesh& mesh, const CornerTable& table, const Rings& rings) {
    const EncodedLean stream = encode_lean(table, rings).value();
    const Result<LeanView> view = validate_lean(stream.words);
    REQUIRE(view);
    std::vector<std::uint32_t> decoded(std::size_t{3} * view->slots());
    decode_lean(*view, decoded);
    for (std::uint32_t& v : decoded) v = stream.vertex_order[v];
    CHECK(test::oriented_triangles(decoded) == test::oriented_triangles(mesh.indices));
}

void check_optimized(const Mesh& mesh, const RingOptions& ring_options, const OptimizeOptions& options) {
    Result<CornerTable> made = build_corner_table(mesh.indices, mesh.vertex_count);
    REQUIRE(made);
    CornerTable& table = *made;
    if (ring_options.one_per_shell) split_fans(table);
    const Rings before = expand_rings(table, ring_options);
    const Rings after = optimize_rings(table, before, options);
    CHECK_MESSAGE(check_rings(table, after) == "", "optimized rings are valid");
    CHECK_MESSAGE(after.count() == before.count(), "optimizing keeps the number of rings");
    CHECK_MESSAGE(cost_of(table, after, options.cost) <= cost_of(table, before, options.cost),
                  "optimizing does not raise the cost");
    CHECK_MESSAGE(same(after, optimize_rings(table, before, options)), "optimizing is deterministic");
    if (ring_options.one_per_shell) {
        CHECK(build_lr(table, after));
    } else {
        check_lean_of(mesh, table, after);
    }
}

OptimizeOptions options_of(const RingCost& cost, std::uint32_t passes, std::uint64_t seed, bool anneal = true) {
    OptimizeOptions options;
    options.cost = cost;
    options.passes = passes;
    options.random_seed = seed;
    options.anneal = anneal;
    return options;
}

constexpr RingCost kCosts[] = {kLeanRingCost, kLrRingCost, kPackedRingCost, {1, 0, -5}, {2, 2, 0}};

}  // namespace

TEST_CASE("optimized rings of named meshes are valid, cost no more and can be encoded") {
    for (const auto& [name, mesh] : test::named_meshes()) {
        CAPTURE_COPY(name);
        if (test::kSanitized && mesh.triangle_count() > 1500) continue;
        for (const RingCost& cost : kCosts) check_optimized(mesh, {}, options_of(cost, 12, 1));
        check_optimized(mesh, {}, options_of(kLeanRingCost, 5, 2, false));
        RingOptions per_shell;
        per_shell.one_per_shell = true;
        check_optimized(mesh, per_shell, options_of(kLrRingCost, 12, 3));
    }
}

TEST_CASE("optimized rings of random soups are valid, cost no more and can be encoded") {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        CAPTURE(seed);
        const RingCost& cost = kCosts[seed % std::size(kCosts)];
        const auto n = static_cast<std::uint32_t>(seed);
        RingOptions ring;
        ring.k = n % 4;
        ring.one_per_shell = seed % 3 == 0;
        check_optimized(test::random_soup(4 + n % 23, 1 + n % 71, seed), ring, options_of(cost, 20, seed));
        check_optimized(test::random_gluing(5 + n % 40, 120, seed), ring, options_of(cost, 20, seed));
    }
}

TEST_CASE("rings and words are the same for any number of threads") {
    for (const char* kind : {"blob", "terrain", "genus", "parts", "moebius"}) {
        CAPTURE(kind);
        const Result<Mesh> mesh = generate(kind, test::kSanitized ? 8000 : 60000, 3);
        REQUIRE(mesh);
        const Result<CornerTable> table = build_corner_table(mesh->indices, mesh->vertex_count);
        REQUIRE(table);
        for (const RingCost& cost : {kLeanRingCost, kPackedRingCost, RingCost{1, 0, -5}}) {
            OptimizeOptions optimize = options_of(cost, 6, 1);
            RingOptions ring{.seeds = 9};
            const Rings found = expand_rings(*table, ring), one = optimize_rings(*table, found, optimize);
            CHECK(check_rings(*table, one) == "");
            CHECK(one.count() == found.count());
            CHECK(cost_of(*table, one, cost) < cost_of(*table, found, cost));
            for (const unsigned threads : {0U, 2U, 3U, 8U}) {
                CAPTURE(threads);
                optimize.threads = ring.threads = threads;
                CHECK(same(expand_rings(*table, ring), found));
                CHECK(same(optimize_rings(*table, found, optimize), one));
            }
        }
        for (const Format format : {Format::packed, Format::lean, Format::lr}) {
            EncodeOptions options{.format = format, .effort = 2};
            const std::vector<std::uint32_t> words = encode(*table, options).value().words;
            for (const unsigned threads : {2U, 3U, 8U}) {
                CAPTURE(threads);
                options.threads = threads;
                CHECK(encode(*table, options).value().words == words);
            }
        }
    }
}

TEST_CASE("optimizing stops when progress returns false, with rings that cost no more") {
    const Mesh mesh = test::random_gluing(300, 600, 5);
    const Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
    REQUIRE(table);
    const Rings before = expand_rings(*table);
    CHECK(same(optimize_rings(*table, before, options_of(kLeanRingCost, 0, 1)), before));
    std::int64_t last = cost_of(*table, before, kLeanRingCost);
    for (std::uint32_t stop = 1; stop <= 20; ++stop) {
        std::uint32_t calls = 0;
        OptimizeOptions options = options_of(kLeanRingCost, 20, 1);
        options.progress = [&](std::uint32_t done) {
            CHECK(done == ++calls);
            return done < stop;
        };
        const Rings after = optimize_rings(*table, before, options);
        CHECK(calls == stop);
        CHECK(check_rings(*table, after) == "");
        const std::int64_t cost = cost_of(*table, after, kLeanRingCost);
        CHECK(cost <= last);
        last = cost;
    }
    CHECK(last < cost_of(*table, before, kLeanRingCost));
}

TEST_CASE("optimizing halves the T0 that wart skipping leaves") {
    for (const char* kind : {"blob", "terrain"}) {
        CAPTURE(kind);
        const Result<Mesh> mesh = generate(kind, 20000, 3);
        REQUIRE(mesh);
        const Result<CornerTable> table = build_corner_table(mesh->indices, mesh->vertex_count);
        REQUIRE(table);
        Rings rings = expand_rings(*table);
        const std::uint32_t before = encode_lean(*table, rings)->statistics.t0;
        const std::uint32_t after = encode_lean(*table, optimize_rings(*table, std::move(rings)))->statistics.t0;
        CAPTURE(before);
        CAPTURE(after);
        CHECK(2 * after <= before);
    }
}

TEST_CASE("optimized rings of the meshes of LACEDRING_MESHES, where it is set") {
    const auto checked = test::for_each_real_mesh([&](const std::string& path, const Result<Mesh>& mesh) {
        CAPTURE(path);
        REQUIRE(mesh);
        check_optimized(weld(*mesh, Weld::none), {}, options_of(kPackedRingCost, 4, 1));
        RingOptions per_shell;
        per_shell.one_per_shell = true;
        check_optimized(weld(*mesh, Weld::position), per_shell, options_of(kLrRingCost, 4, 1));
    });
    CHECK_MESSAGE(checked.value_or(1) > 0, "the folder has meshes");
}
