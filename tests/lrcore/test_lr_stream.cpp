#include <doctest/doctest.h>

#include <algorithm>
#include <memory>

#include "lacedring/lacedring.hpp"
#include "lacedring/operators.hpp"
#include "lacedring/streams.hpp"
#include "lacedring/topology.hpp"
#include "lrcore/base/crc32.h"
#include "tests/support/capture.h"
#include "tests/support/damage.h"
#include "tests/support/lr_consistency.h"
#include "tests/support/meshes.h"

using namespace lacedring;

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
    CHECK(test::inconsistency(stream->view) == "");
    std::vector<std::uint32_t> indices = decode_lr(*stream);
    for (std::uint32_t& v : indices) v = words.original[v];
    CHECK(test::oriented_triangles(indices) == test::oriented_triangles(mesh.indices));
}

std::vector<std::uint32_t> with_checksum(std::vector<std::uint32_t> words) {
    words[9] = crc32(std::as_bytes(std::span(words).subspan(10)), crc32(std::as_bytes(std::span(words).first(9))));
    return words;
}

/// Validates a damaged stream, and checks and decodes one that is accepted. Returns whether it was.
template <class Validate>
bool try_damaged(std::vector<std::uint32_t> bad, Validate validate) {
    if (bad.size() >= kLrHeaderWords) bad = with_checksum(std::move(bad));
    const auto exact = test::exact_copy(std::span<const std::uint32_t>(bad));
    const auto stream = validate(std::span<const std::uint32_t>(exact.get(), bad.size()));
    if (!stream) return false;
    CHECK(test::inconsistency(stream->view) == "");
    decode_lr(*stream);
    return true;
}

}  // namespace

TEST_CASE("LR streams decode to the triangles of named meshes") {
    for (const auto& [name, mesh] : test::named_meshes()) {
        CAPTURE_COPY(name);
        for (const std::uint32_t k : {0U, 5U}) {
            const Words words = make(mesh, k);
            check_decoded(mesh, words, validate_lr(words.standard));
            check_decoded(mesh, words, validate_compact_lr(words.compact));
        }
    }
}

TEST_CASE("LR streams decode to the triangles of random soups") {
    for (std::uint64_t seed = 1; seed <= 150; ++seed) {
        CAPTURE(seed);
        const Mesh mesh = test::random_gluing(10 + static_cast<std::uint32_t>(seed % 50), 150, seed);
        const Words words = make(mesh, static_cast<std::uint32_t>(seed % 4));
        check_decoded(mesh, words, validate_lr(words.standard));
        check_decoded(mesh, words, validate_compact_lr(words.compact));
    }
}

TEST_CASE("a used vertex without a corner is refused") {
    // A ring of three vertices with one triangle on both sides. The left slot of vertex 1 is a border, so its v.c is
    // null.
    const std::vector<std::uint32_t> kNullCorner =
        with_checksum({0x5443524c, 1, 4, 3, 0, 3, 0, 0, 0, 0, 2, 0x40000000, 0x5fffffff, 0, 0x90000000, 0x10000001, 2,
                       UINT32_MAX, UINT32_MAX});
    const auto refused = validate_lr(kNullCorner);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().message == "LR tables: vertex 1: no corner");
}

TEST_CASE("a vertex with two fans is refused") {
    // Two tetrahedra share vertex 0, and a copy of vertex 0 has the second fan. If the original replaces the copy, v.c
    // reaches the first fan only.
    const Mesh mesh = test::make_mesh({0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2, 0, 4, 5, 0, 5, 6, 0, 6, 4, 4, 6, 5}, 7);
    for (const std::uint32_t k : {0U, 2U}) {
        const Words words = make(mesh, k);
        REQUIRE(validate_lr(words.standard));
        REQUIRE(words.standard[7] == 1);
        const std::uint32_t copy = words.standard.end()[-2], original = words.standard.end()[-1];
        std::size_t replaced = 0;
        std::vector<std::uint32_t> joined = words.standard;
        for (std::size_t i = kLrHeaderWords; i + 2 < joined.size(); ++i) {
            if ((joined[i] & word::kTip) != copy) continue;
            joined[i] = (joined[i] & ~word::kTip) | original;
            ++replaced;
        }
        CHECK(replaced > 0);
        CHECK_FALSE(validate_lr(with_checksum(joined)));
    }
}

TEST_CASE("tables whose redundant T2 is not v.n.n, or whose VO* has other opposites, are refused") {
    const Mesh mesh = test::random_gluing(60, 200, 5);
    const Words words = make(mesh);
    const LrView view = view_lr(words.standard)->view;
    std::size_t redundant = 0, entries = 0;
    for (std::uint32_t slot = 0; slot < view.lr.size(); ++slot) {
        const std::uint32_t w = view.lr[slot];
        std::vector<std::uint32_t> bad = words.standard;
        if ((w & word::kKind) == word::kRedundant) {
            bad[kLrHeaderWords + slot] ^= (w & word::kTip) == 0 ? 1 : w & word::kTip;
            CHECK_FALSE(validate_lr(with_checksum(bad)));
            ++redundant;
        }
        if ((w & (word::kSpecial | word::kIrregular)) != word::kIrregular) continue;
        for (std::size_t end = 1; end <= 2; ++end) {
            bad = words.standard;
            std::uint32_t& entry = bad[kLrHeaderWords + view.lr.size() + view.vo.size() + (w & word::kTip) + end];
            entry = entry == UINT32_MAX ? 0 : UINT32_MAX;
            CHECK_FALSE(validate_lr(with_checksum(bad)));
            ++entries;
        }
    }
    CHECK(redundant > 5);
    CHECK(entries > 20);
}

TEST_CASE("a flag at a T0's second or third vertex, or a unit in standard tables, is refused") {
    const Words words = make(test::random_gluing(60, 200, 5));
    for (const std::vector<std::uint32_t>* tables : {&words.standard, &words.compact}) {
        const bool is_standard = tables == &words.standard;
        REQUIRE((*tables)[4] > 0);  // T0
        const std::size_t vo = kLrHeaderWords + std::size_t{(*tables)[3]} * (is_standard ? 2 : 1);
        for (const std::size_t k : {1U, 2U}) {
            std::vector<std::uint32_t> bad = *tables;
            bad[vo + k] |= word::kT0Flip;
            bad = with_checksum(bad);
            CHECK_FALSE((is_standard ? validate_lr(bad).has_value() : validate_compact_lr(bad).has_value()));
        }
    }
    std::vector<std::uint32_t> bad = words.standard;
    bad[8] = 2;
    CHECK_FALSE(validate_lr(with_checksum(bad)));
}

TEST_CASE("damaged LR streams are refused or have consistent operators") {
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
            test::for_each_cut(good, [&](auto cut) { CHECK_FALSE(run({cut.begin(), cut.end()})); });
            test::for_each_damage(good, shape, 1500,
                                  [&](const auto& bad, auto&) { ++(run(bad) ? accepted : refused); });
        }
    }
    CHECK(accepted > 10);
    CHECK(refused > 10000);
}

TEST_CASE("smallest_compact_lr returns the smallest tables of all k") {
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
