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

/// Encodes and checks everything there is to check. Returns the stream.
EncodedLean check_lean(const Mesh& mesh, const RingOptions& ring_options, const LeanOptions& options) {
    const Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
    REQUIRE(table);
    Result<EncodedLean> encoded = encode_lean(*table, expand_rings(*table, ring_options), options);
    REQUIRE(encoded);
    EncodedLean& stream = *encoded;

    // The stream alone, in a buffer of exactly its size, so that a sanitizer sees any read beyond it.
    const auto exact = std::make_unique<std::uint32_t[]>(stream.words.size());
    std::copy(stream.words.begin(), stream.words.end(), exact.get());
    const std::span<const std::uint32_t> words(exact.get(), stream.words.size());
    const Result<LeanView> view = validate_lean(words);
    REQUIRE_MESSAGE(view, view.error().message);
    CHECK(view->bytes() == 4 * stream.words.size());
    CHECK(view->references() <= mesh.indices.size());  // never above three a triangle
    const auto indices = std::make_unique<std::uint32_t[]>(std::size_t{3} * view->slots());
    const std::span<std::uint32_t> decoded(indices.get(), std::size_t{3} * view->slots());
    decode_lean(*view, decoded);

    // vertex_order is a permutation.
    REQUIRE(stream.vertex_order.size() == mesh.vertex_count);
    std::vector<std::uint32_t> sorted = stream.vertex_order;
    std::sort(sorted.begin(), sorted.end());
    for (std::uint32_t v = 0; v < sorted.size(); ++v) REQUIRE(sorted[v] == v);

    // Every slot is the triangle that slot_triangle says, oriented as in the input; each triangle has one slot.
    REQUIRE(stream.slot_triangle.size() == view->slots());
    std::vector<std::uint32_t> slots_of(mesh.triangle_count(), 0);
    std::uint32_t degenerate_slots = 0;
    for (std::uint32_t slot = 0; slot < view->slots(); ++slot) {
        const auto one = decode_lean_slot(*view, slot);
        for (std::size_t k = 0; k < 3; ++k) {
            REQUIRE(one.v[k] == decoded[std::size_t{3} * slot + k]);
            REQUIRE(one.v[k] < mesh.vertex_count);
        }
        const std::uint32_t t = stream.slot_triangle[slot];
        CHECK(one.degenerate() == (t == UINT32_MAX));
        if (t == UINT32_MAX) {
            ++degenerate_slots;
            continue;
        }
        ++slots_of[t];
        const Triangle got{stream.vertex_order[one.v[0]], stream.vertex_order[one.v[1]], stream.vertex_order[one.v[2]]};
        const Triangle want{mesh.indices[std::size_t{3} * t], mesh.indices[std::size_t{3} * t + 1],
                            mesh.indices[std::size_t{3} * t + 2]};
        CHECK(leading_smallest(got) == leading_smallest(want));
    }
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
        CHECK(slots_of[t] == (table->degenerate(TriangleId{t}) ? 0 : 1));
    CHECK(view->triangles == view->slots() - degenerate_slots);

    // And once more without slot_triangle.
    std::vector<std::uint32_t> renumbered(decoded.begin(), decoded.end());
    for (std::uint32_t& v : renumbered) v = stream.vertex_order[v];
    CHECK(test::oriented_triangles(renumbered) == test::oriented_triangles(mesh.indices));

    const LeanStatistics& s = stream.statistics;
    CHECK(s.ring_vertices == view->rings2 + view->rings1);
    CHECK(s.t0 + s.unrung == view->verbatim);
    if (!options.wart_skipping) CHECK(s.t0_wart == 0);
    return std::move(*encoded);
}

void check_all(const Mesh& mesh) {
    const EncodedLean warts = check_lean(mesh, {1, 1}, {});
    const EncodedLean none = check_lean(mesh, {1, 1}, {.wart_skipping = false});
    CHECK(warts.words.size() <= none.words.size());
    check_lean(mesh, {4, 3}, {});
}

}  // namespace

TEST_CASE("lean streams of named meshes") {
    for (const auto& [name, mesh] : test::named_meshes()) {
        CAPTURE_COPY(name);
        check_all(mesh);
    }
}

TEST_CASE("lean streams of random soups") {
    for (std::uint64_t seed = 1; seed <= 400; ++seed) {
        CAPTURE(seed);
        check_all(test::random_soup(4 + static_cast<std::uint32_t>(seed % 29),
                                    1 + static_cast<std::uint32_t>(seed % 83), seed));
        check_all(test::random_gluing(10 + static_cast<std::uint32_t>(seed % 50), 150, seed));
    }
}

TEST_CASE("one side suffices for a strip of triangles") {
    // Eight triangles, ten vertices, all on the border: ten references, where an index list has 24.
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

TEST_CASE("damaged streams are refused or harmless") {
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
            CHECK_FALSE(validate_lean(bad));  // the checksum
            bad[LR_LEAN_WORD_CHECKSUM] = lean_checksum(bad);
            const auto exact = test::exact_copy(std::span<const std::uint32_t>(bad));
            const Result<LeanView> view = validate_lean(std::span<const std::uint32_t>(exact.get(), bad.size()));
            ++(view ? accepted : refused);
            if (!view) return;  // else another mesh: whatever it is, decoding stays in bounds
            std::vector<std::uint32_t> indices(std::size_t{3} * view->slots());
            decode_lean(*view, indices);
            for (const std::uint32_t v : indices) CHECK(v < view->vertices);
        });
    }
    CHECK(accepted > 100);
    CHECK(refused > 100);
}
