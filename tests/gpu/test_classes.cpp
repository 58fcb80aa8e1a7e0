// Compares the triangle classes, offsets and lines that pictures show with the encoder's counts.

#include <array>

#include "lacedring/lacedring.hpp"
#include "lacedring/streams.hpp"
#include "lrlab/paper/offsets.h"
#include "renderer/mesh/triangle_class.h"
#include "shaders/shared.h"
#include "tests/gpu/gpu_test.h"
#include "tests/support/meshes.h"

using namespace lacedring;
using namespace lacedring::test;

TEST_CASE("triangle classes add up to the encoder's statistics") {
    for (const char* kind : {"sphere", "torus", "genus", "blob", "terrain"}) {
        CAPTURE(kind);
        const Mesh mesh = generated(kind, 5000, 4);
        const gpu::Model model = model_of(mesh);
        const Result<LeanView> view = view_lean(model.lean.words);
        REQUIRE(view);
        std::array<std::uint32_t, 7> count{};
        for (const std::uint8_t c : gpu::slot_classes(*view)) ++count.at(c);
        const LeanStatistics& s = model.lean.statistics;
        REQUIRE(s.unrung == 0);
        CHECK(count[LR_CLASS_T0] == s.t0);
        CHECK(count[LR_CLASS_T0_WART] == s.t0_wart);
        CHECK(count[LR_CLASS_T2] + count[LR_CLASS_T2_WART] == s.t2);
        CHECK(count[LR_CLASS_T2_WART] == s.t0_wart);
        CHECK(count[LR_CLASS_NONE] == view->slots() - view->triangles);
    }
}

TEST_CASE("offsets in the picture are those of the ring's tips") {
    for (const std::uint32_t k : {0U, 32U}) {
        CAPTURE(k);
        const Mesh mesh = generated("blob", 5000, 4);
        const Result<gpu::Model> model = gpu::make_model(mesh, {.ring = {1, 1, k}});
        REQUIRE(model);
        const Result<LeanView> view = view_lean(model->lean.words);
        REQUIRE(view);
        const Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
        REQUIRE(table);
        const Result<LrTable> lr = build_lr(*table, expand_rings(*table, {1, 1, k, true}));
        REQUIRE(lr);
        REQUIRE(lr->ring_vertices == view->rings2);  // one ring: the lean stream has it from another start
        const OffsetCounts expected = count_offsets(lr->view());
        std::array<std::uint32_t, 256> count{};
        for (const std::uint8_t bits : gpu::slot_offset_bits(*view)) ++count[bits];
        CHECK(count[LR_OFFSET_T0] == expected.t0);
        CHECK(count[LR_OFFSET_NONE] == view->slots() - view->triangles + expected.off_ring);
        for (std::size_t b = 1; b < expected.bits.size(); ++b) CHECK(count[b] == expected.bits[b]);
    }
}

TEST_CASE("the ring's lines are closed loops over the ring vertices") {
    for (const NamedMesh& named : named_meshes()) {
        CAPTURE(named.name);
        const Result<gpu::Model> model = gpu::make_model(named.mesh);
        if (!model) continue;
        const Result<LeanView> view = view_lean(model->lean.words);
        REQUIRE(view);
        const std::vector<std::uint32_t> lines = gpu::ring_lines(*view);
        REQUIRE(lines.size() == 2 * (view->rings2 + view->rings1));
        std::vector<std::uint32_t> entered(lines.size() / 2, 0);
        for (std::size_t i = 0; i < lines.size(); i += 2) {
            REQUIRE(lines[i] == i / 2);
            REQUIRE(lines[i + 1] < entered.size());
            ++entered[lines[i + 1]];
        }
        for (const std::uint32_t n : entered) REQUIRE(n == 1);
    }
}

TEST_CASE("every edge is drawn once") {
    const std::vector<std::uint32_t> indices{0, 1, 2, 2, 1, 3, 3, 3, 0};
    CHECK(gpu::mesh_edges(indices) == std::vector<std::uint32_t>{0, 1, 0, 2, 0, 3, 1, 2, 1, 3, 2, 3});
    const Mesh sphere = generated("sphere", 2000);
    // 3T/2 edges of two ends each.
    CHECK(gpu::mesh_edges(sphere.indices).size() == sphere.indices.size());
}
