// Tests the distribution of offsets (LR 2011, figure 8) and the count of long references of bit-efficient tables.

#include <doctest/doctest.h>

#include <numeric>

#include "lacedring/lacedring.hpp"
#include "lacedring/topology.hpp"
#include "lrlab/generate/generate.h"
#include "lrlab/paper/offsets.h"
#include "tests/support/meshes.h"

using namespace lacedring;

TEST_CASE("offset_bits counts the significant bits of the shorter offset around the rings") {
    CHECK(offset_bits(5, 5, 100) == 0);
    CHECK(offset_bits(5, 6, 100) == 1);
    CHECK(offset_bits(5, 4, 100) == 1);
    CHECK(offset_bits(5, 7, 100) == 2);
    CHECK(offset_bits(5, 8, 100) == 2);
    CHECK(offset_bits(5, 9, 100) == 3);
    CHECK(offset_bits(0, 99, 100) == 1);
    CHECK(offset_bits(99, 0, 100) == 1);
    CHECK(offset_bits(0, 50, 100) == 6);
    CHECK(offset_bits(0, (1U << 28) - 2, (1U << 28) - 1) == 1);
    CHECK(offset_bits(0, 1U << 27, (1U << 28) - 1) == 27);
}

TEST_CASE("every triangle is counted once, and the tables' bytes follow from the counts") {
    for (const test::NamedMesh& named : test::named_meshes()) {
        CAPTURE(named.name);
        Result<CornerTable> table = build_corner_table(named.mesh.indices, named.mesh.vertex_count);
        REQUIRE(table);
        split_fans(*table);
        for (const std::uint32_t k : {0U, 1U, 32U}) {
            CAPTURE(k);
            const Result<LrTable> lr = build_lr(*table, expand_rings(*table, {1, 1, k, true}));
            REQUIRE(lr);
            const OffsetCounts counts = count_offsets(lr->view());
            CHECK(counts.t0 == lr->statistics.t0);
            CHECK(counts.off_ring <= lr->statistics.t0_wart);
            CHECK(std::accumulate(counts.bits.begin(), counts.bits.end(), counts.off_ring + counts.t0) ==
                  named.mesh.triangle_count() - table->topology.degenerate);

            const Result<CompactLrTable> compact = build_compact_lr(lr->view());
            REQUIRE(compact);
            const std::uint32_t n_l = count_long_tips(compact->view());
            CHECK(n_l == compact->long_tips);
            CHECK(compact->view().bytes() == 4 * (std::size_t{lr->ring_vertices} + 6 * std::size_t{counts.t0} +
                                                  3 * std::size_t{compact->irregular} + n_l + lr->c.size()));
        }
    }
}

TEST_CASE("the more breadth first, the shorter the offsets and the more T0") {
    const Result<Mesh> mesh = generate("blob", 20000, 3);
    REQUIRE(mesh);
    Result<CornerTable> table = build_corner_table(mesh->indices, mesh->vertex_count);
    REQUIRE(table);
    double bits_before = 0;
    std::uint32_t t0_before = UINT32_MAX;
    for (const std::uint32_t k : {1U, 32U, 0U}) {
        const Result<LrTable> lr = build_lr(*table, expand_rings(*table, {1, 1, k, true}));
        REQUIRE(lr);
        const OffsetCounts counts = count_offsets(lr->view());
        double bits = 0;
        for (std::size_t b = 0; b < counts.bits.size(); ++b) bits += static_cast<double>(b) * counts.bits[b];
        CHECK(bits > bits_before);
        CHECK(counts.t0 < t0_before);
        bits_before = bits;
        t0_before = counts.t0;
    }
}
