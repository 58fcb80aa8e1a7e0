#include <doctest/doctest.h>

#include <algorithm>
#include <memory>

#include "lacedring/lacedring.hpp"
#include "lacedring/streams.hpp"
#include "lrcore/codec/lean/lean_format.h"
#include "tests/support/capture.h"
#include "tests/support/damage.h"
#include "tests/support/meshes.h"

using namespace lacedring;

namespace {

using Triangle = std::array<std::uint32_t, 3>;

Triangle leading_smallest(Triangle t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
}

void check_lean_vertex_order(const Mesh& mesh, const EncodedLean& stream) {
    INFO("vertex_order is a permutation");
    REQUIRE(stream.vertex_order.size() == mesh.vertex_count);
    std::vector<std::uint32_t> sorted = stream.vertex_order;
    std::sort(sorted.begin(), sorted.end());
    for (std::uint32_t v = 0; v < sorted.size(); ++v) REQUIRE(sorted[v] == v);
}

void check_lean_slots(const LeanView& view, std::span<const std::uint32_t> decoded) {
    INFO("a slot decoded alone has the vertices that it has in the decoded stream");
    for (std::uint32_t slot = 0; slot < view.slots(); ++slot) {
        CAPTURE(slot);
        const auto one = decode_lean_slot(view, slot);
        for (std::size_t k = 0; k < 3; ++k) {
            REQUIRE(one.v[k] == decoded[std::size_t{3} * slot + k]);
            REQUIRE(one.v[k] < view.vertices);
        }
    }
}

void check_lean_slot_triangles(const Mesh& mesh, const EncodedLean& stream, const LeanView& view) {
    INFO("each slot has the triangle that slot_triangle names, oriented as in the mesh");
    REQUIRE(stream.slot_triangle.size() == view.slots());
    std::uint32_t triangles = 0;
    for (std::uint32_t slot = 0; slot < view.slots(); ++slot) {
        CAPTURE(slot);
        const auto one = decode_lean_slot(view, slot);
        const std::uint32_t t = stream.slot_triangle[slot];
        CHECK(one.degenerate() == (t == UINT32_MAX));
        if (t == UINT32_MAX) continue;
        ++triangles;
        const Triangle got{stream.vertex_order[one.v[0]], stream.vertex_order[one.v[1]], stream.vertex_order[one.v[2]]};
        const Triangle want{mesh.indices[std::size_t{3} * t], mesh.indices[std::size_t{3} * t + 1],
                            mesh.indices[std::size_t{3} * t + 2]};
        CHECK(leading_smallest(got) == leading_smallest(want));
    }
    CHECK(view.triangles == triangles);
}

void check_lean_triangle_slots(const CornerTable& table, const EncodedLean& stream) {
    INFO("each triangle that is not degenerate has one slot");
    std::vector<std::uint32_t> slots_of(table.triangle_count(), 0);
    for (const std::uint32_t t : stream.slot_triangle) {
        if (t != UINT32_MAX) ++slots_of[t];
    }
    for (std::uint32_t t = 0; t < slots_of.size(); ++t) CHECK(slots_of[t] == (table.degenerate(TriangleId{t}) ? 0 : 1));
}

void check_lean_triangles(const Mesh& mesh, const EncodedLean& stream, std::span<const std::uint32_t> decoded) {
    INFO("the decoded stream holds the mesh's triangles");
    std::vector<std::uint32_t> renumbered(decoded.begin(), decoded.end());
    for (std::uint32_t& v : renumbered) v = stream.vertex_order[v];
    CHECK(test::oriented_triangles(renumbered) == test::oriented_triangles(mesh.indices));
}

void check_lean_statistics(const LeanStatistics& statistics, const LeanView& view, const LeanOptions& options) {
    INFO("the statistics count what the header counts");
    CHECK(statistics.ring_vertices == view.rings2 + view.rings1);
    CHECK(statistics.t0 + statistics.unrung == view.verbatim);
    if (!options.wart_skipping) CHECK(statistics.t0_wart == 0);
}

/// Encodes a mesh, checks the stream and its decoding, and returns the stream.
EncodedLean check_lean(const Mesh& mesh, const RingOptions& ring_options, const LeanOptions& options) {
    const Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
    REQUIRE(table);
    Result<EncodedLean> encoded = encode_lean(*table, expand_rings(*table, ring_options), options);
    REQUIRE(encoded);
    const EncodedLean& stream = *encoded;

    // Buffers of exactly the stream's size: a sanitizer reports accesses past the end.
    const auto exact = test::exact_copy(std::span<const std::uint32_t>(stream.words));
    const Result<LeanView> view = validate_lean(std::span<const std::uint32_t>(exact.get(), stream.words.size()));
    REQUIRE_MESSAGE(view, view.error().message);
    CHECK(view->bytes() == 4 * stream.words.size());
    CHECK_MESSAGE(view->references() <= mesh.indices.size(), "at most three references per triangle");
    const auto indices = std::make_unique<std::uint32_t[]>(std::size_t{3} * view->slots());
    const std::span<std::uint32_t> decoded(indices.get(), std::size_t{3} * view->slots());
    decode_lean(*view, decoded);

    check_lean_vertex_order(mesh, stream);
    check_lean_slots(*view, decoded);
    check_lean_slot_triangles(mesh, stream, *view);
    check_lean_triangle_slots(*table, stream);
    check_lean_triangles(mesh, stream, decoded);
    check_lean_statistics(stream.statistics, *view, options);
    return std::move(*encoded);
}

void check_lean_options(const Mesh& mesh) {
    const EncodedLean warts = check_lean(mesh, {1, 1}, {});
    const EncodedLean none = check_lean(mesh, {1, 1}, {.wart_skipping = false});
    CHECK_MESSAGE(warts.words.size() <= none.words.size(), "wart skipping makes no stream larger");
    check_lean(mesh, {4, 3}, {});
}

}  // namespace

TEST_CASE("lean streams of named meshes decode to the mesh's triangles") {
    for (const auto& [name, mesh] : test::named_meshes()) {
        CAPTURE_COPY(name);
        check_lean_options(mesh);
    }
}

TEST_CASE("lean streams of random soups decode to the soup's triangles") {
    for (std::uint64_t seed = 1; seed <= 400; ++seed) {
        CAPTURE(seed);
        check_lean_options(test::random_soup(4 + static_cast<std::uint32_t>(seed % 29),
                                             1 + static_cast<std::uint32_t>(seed % 83), seed));
        check_lean_options(test::random_gluing(10 + static_cast<std::uint32_t>(seed % 50), 150, seed));
    }
}

TEST_CASE("a strip of triangles takes one reference per vertex") {
    // Eight triangles and ten vertices, all on the border: an index list has 24 references.
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i < 8; ++i) {
        indices.insert(indices.end(), {i, i + 1 + i % 2, i + 2 - i % 2});
    }
    const EncodedLean stream = check_lean(test::make_mesh(indices, 10), {}, {});
    const Result<LeanView> view = view_lean(stream.words);
    REQUIRE(view);
    CHECK(view->references() == 10);
    CHECK(view->rings1 == 10);
}

TEST_CASE("damaged lean streams are refused or decode to vertices in range") {
    std::size_t accepted = 0, refused = 0;
    for (std::uint64_t shape = 1; shape <= 20; ++shape) {
        const Mesh mesh = test::random_gluing(30, 60, shape);
        const Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
        REQUIRE(table);
        const std::vector<std::uint32_t> good = encode_lean(*table, expand_rings(*table))->words;
        test::for_each_cut(good, [](auto cut) { CHECK_FALSE(validate_lean(cut)); });
        std::vector<std::uint32_t> longer = good;
        longer.push_back(0);
        CHECK_FALSE(validate_lean(longer));
        test::for_each_damage(good, shape, 300, [&](std::vector<std::uint32_t>& bad, auto&) {
            CHECK_MESSAGE(!validate_lean(bad), "the checksum differs");
            bad[LR_LEAN_WORD_CHECKSUM] = lean_checksum(bad);
            const auto exact = test::exact_copy(std::span<const std::uint32_t>(bad));
            const Result<LeanView> view = validate_lean(std::span<const std::uint32_t>(exact.get(), bad.size()));
            ++(view ? accepted : refused);
            if (!view) return;
            INFO("an accepted stream decodes within bounds");
            std::vector<std::uint32_t> indices(std::size_t{3} * view->slots());
            decode_lean(*view, indices);
            for (const std::uint32_t v : indices) CHECK(v < view->vertices);
        });
    }
    CHECK(accepted > 100);
    CHECK(refused > 100);
}
