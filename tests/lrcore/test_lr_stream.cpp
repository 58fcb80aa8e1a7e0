#include <doctest/doctest.h>

#include <algorithm>
#include <memory>

#include "lrcore/base/crc32.h"
#include "lrcore/corner_table/split.h"
#include "lrcore/lr/lr_stream.h"
#include "lrcore/lr/operators.h"
#include "lrcore/lr/search.h"
#include "tests/support/meshes.h"

using namespace lr;

namespace {

struct Words {
    std::vector<std::uint32_t> standard, compact;
    std::vector<std::uint32_t> original;  ///< LR vertex -> mesh vertex
};

Words make(const Mesh& mesh, std::uint32_t k = 0) {
    Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
    REQUIRE(table);
    const std::vector<VertexId> copied = split_fans(*table);
    LrMap map;
    const Rings rings = expand_rings(*table, {.k = k, .one_per_shell = true});
    const Result<LrTable> lr = build_lr(*table, rings, {}, &map);
    REQUIRE(lr);
    Words out;
    std::vector<std::uint32_t> number(table->vertex_count);
    for (std::uint32_t v = 0; v < map.vertex.size(); ++v) number[map.vertex[v].value] = v;
    std::vector<VertexCopy> copies;
    for (std::uint32_t v = 0; v < map.vertex.size(); ++v) {
        const std::uint32_t u = map.vertex[v].value;
        const std::uint32_t from = u < mesh.vertex_count ? u : copied[u - mesh.vertex_count].value;
        if (u >= mesh.vertex_count) copies.push_back({v, number[from]});
        out.original.push_back(from);
    }
    out.standard = serialize(*lr, copies);
    const Result<CompactLrTable> compact = build_compact_lr(lr->view());
    REQUIRE(compact);
    out.compact = serialize(*compact, copies);
    return out;
}

template <class Stream>
void check_decoded(const Mesh& mesh, const Words& words, const Result<Stream>& stream) {
    REQUIRE_MESSAGE(stream, stream.error().message);
    std::vector<std::uint32_t> indices = decode_lr(*stream);
    for (std::uint32_t& v : indices) v = words.original[v];
    CHECK(test::oriented_triangles(indices) == test::oriented_triangles(mesh.indices));
}

/// Every operator at every corner and vertex of tables that were found valid: in bounds, and every walk ends.
template <class View>
void walk(const View& view) {
    const LrOperators<View> ops(view);
    for (std::uint32_t t = 0; t < view.triangle_numbers(); ++t) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            const CornerId c{4 * t + k};
            ops.vertex(c);
            ops.opposite(c);
            ops.swing(c);
        }
    }
    for (std::uint32_t v = 0; v < view.used_vertices(); ++v) CHECK(ops.valence({v}) < 3 * view.triangle_numbers() + 3);
}

/// Refused, or harmless. Returns whether it was accepted.
template <class Validate>
bool try_damaged(std::vector<std::uint32_t> bad, Validate validate) {
    const auto exact = std::make_unique<std::uint32_t[]>(bad.size());
    if (bad.size() >= kLrHeaderWords) {  // with a checksum that fits
        bad[9] = crc32(std::as_bytes(std::span(bad).subspan(10)), crc32(std::as_bytes(std::span(bad).first(9))));
    }
    std::copy(bad.begin(), bad.end(), exact.get());
    const auto stream = validate(std::span<const std::uint32_t>(exact.get(), bad.size()));
    if (!stream) return false;
    walk(stream->view);
    decode_lr(*stream);
    return true;
}

}  // namespace

TEST_CASE("LR streams give back the triangles of named meshes") {
    for (const auto& [name, mesh] : test::named_meshes()) {
        CAPTURE(name);
        for (const std::uint32_t k : {0U, 5U}) {
            const Words words = make(mesh, k);
            check_decoded(mesh, words, validate_lr(words.standard));
            check_decoded(mesh, words, validate_compact_lr(words.compact));
        }
    }
}

TEST_CASE("LR streams give back the triangles of random soups") {
    for (std::uint64_t seed = 1; seed <= 150; ++seed) {
        CAPTURE(seed);
        const Mesh mesh = test::random_gluing(10 + static_cast<std::uint32_t>(seed % 50), 150, seed);
        const Words words = make(mesh, static_cast<std::uint32_t>(seed % 4));
        check_decoded(mesh, words, validate_lr(words.standard));
        check_decoded(mesh, words, validate_compact_lr(words.compact));
    }
}

TEST_CASE("damaged LR streams are refused or harmless") {
    const std::uint64_t seed = 20261123;
    INFO("seed ", seed);
    std::uint64_t state = seed;
    const auto random = [&](std::uint32_t below) {
        state = state * 6364136223846793005U + 1442695040888963407U;
        return static_cast<std::uint32_t>((state >> 33) % below);
    };
    const auto standard = [](std::span<const std::uint32_t> w) { return validate_lr(w); };
    const auto compact = [](std::span<const std::uint32_t> w) { return validate_compact_lr(w); };
    std::size_t accepted = 0, refused = 0;
    for (std::uint64_t shape = 1; shape <= 12; ++shape) {
        const Words words = make(test::random_gluing(40, 70, shape), shape % 2 == 0 ? 3 : 0);
        for (int which = 0; which < 2; ++which) {
            const std::vector<std::uint32_t>& good = which == 0 ? words.standard : words.compact;
            const auto run = [&](const std::vector<std::uint32_t>& bad) {
                return which == 0 ? try_damaged(bad, standard) : try_damaged(bad, compact);
            };
            CHECK(run(good));
            for (std::size_t size = 0; size < good.size(); ++size) {
                CHECK_FALSE(run({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)}));
            }
            for (int trial = 0; trial < 1500; ++trial) {
                std::vector<std::uint32_t> bad = good;
                for (std::uint32_t n = 0; n <= random(3); ++n) {
                    std::uint32_t& word = bad[random(static_cast<std::uint32_t>(bad.size()))];
                    switch (random(3)) {
                        case 0: word ^= 1U << random(32); break;
                        case 1: word = (word & 0xf0000000U) | random(80); break;
                        default: word = random(2) == 0 ? UINT32_MAX : random(400); break;
                    }
                }
                ++(run(bad) ? accepted : refused);
            }
        }
    }
    CHECK(accepted > 10);
    CHECK(refused > 10000);
}

TEST_CASE("the search for k keeps the smallest") {
    const Mesh mesh = test::random_gluing(3000, 6000, 3);
    Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
    REQUIRE(table);
    split_fans(*table);
    const std::vector<std::uint32_t> periods{0, 64, 8, 1};
    const Result<CompactChoice> best = smallest_compact_lr(*table, {}, periods);
    REQUIRE(best);
    for (const std::uint32_t k : periods) {
        const Result<CompactChoice> one = smallest_compact_lr(*table, {}, std::span(&k, 1));
        REQUIRE(one);
        CHECK(one->k == k);
        CHECK(best->compact.view().bytes() <= one->compact.view().bytes());
    }
    CHECK_FALSE(smallest_compact_lr(*table, {}, {}));
}
