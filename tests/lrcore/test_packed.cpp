#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "lacedring/lacedring.hpp"
#include "lacedring/mesh_files.hpp"
#include "lacedring/streams.hpp"
#include "lrcore/codec/packed/packed_format.h"
#include "lrlab/generate/generate.h"
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

/// Encodes and checks everything there is to check.
EncodedPacked check(const Mesh& mesh, const RingOptions& ring, PackedProfile profile = PackedProfile::small,
                    std::uint32_t passes = 0) {
    const Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
    REQUIRE(table);
    Result<PackedChoice> encoded =
        encode_smallest_packed(*table, ring, {.cost = kPackedRingCost, .passes = passes}, profile);
    REQUIRE(encoded);
    EncodedPacked& stream = encoded->stream;

    // The stream alone, in a buffer of exactly its size, so that a sanitizer sees any read beyond it.
    const auto exact = std::make_unique<std::uint32_t[]>(stream.words.size());
    std::copy(stream.words.begin(), stream.words.end(), exact.get());
    const Result<PackedView> view = validate_packed(std::span<const std::uint32_t>(exact.get(), stream.words.size()));
    REQUIRE_MESSAGE(view, view.error().message);
    CHECK(view->triangles == table->triangle_count() - table->topology.degenerate);
    CHECK(view->bytes() <= std::size_t{12} * view->triangles + 72);  // never above a plain list and a fixed header

    const std::size_t size = std::size_t{3} * view->triangles;
    const auto indices = std::make_unique<std::uint32_t[]>(size);
    const std::span<std::uint32_t> decoded(indices.get(), size);
    decode_packed(*view, decoded);
    REQUIRE(stream.triangle_order.size() == view->triangles);
    REQUIRE(stream.vertex_order.size() == mesh.vertex_count);
    std::vector<std::uint32_t> sorted = stream.vertex_order;
    std::sort(sorted.begin(), sorted.end());
    for (std::uint32_t v = 0; v < sorted.size(); ++v) REQUIRE(sorted[v] == v);
    for (std::uint32_t i = 0; i < view->triangles; ++i) {
        const auto one = decode_packed_triangle(*view, i);
        Triangle got{}, want{};
        for (std::size_t k = 0; k < 3; ++k) {
            REQUIRE(one.v[k] == decoded[std::size_t{3} * i + k]);
            got[k] = stream.vertex_order[one.v[k]];
            want[k] = mesh.indices[std::size_t{3} * stream.triangle_order[i] + k];
        }
        REQUIRE(leading_smallest(got) == leading_smallest(want));
    }
    std::vector<std::uint32_t> threaded(size);
    decode_packed(*view, threaded, 3);
    CHECK(std::equal(threaded.begin(), threaded.end(), decoded.begin()));
    for (std::uint32_t block = 0; block < view->blocks(); ++block) {
        const std::size_t first = std::size_t{3} * LR_PACKED_BLOCK * block;
        const auto part = std::make_unique<std::uint32_t[]>(std::min<std::size_t>(3 * LR_PACKED_BLOCK, size - first));
        decode_packed_block(*view, block, {part.get(), std::min<std::size_t>(3 * LR_PACKED_BLOCK, size - first)});
        CHECK(std::equal(part.get(), part.get() + std::min<std::size_t>(3 * LR_PACKED_BLOCK, size - first),
                         decoded.begin() + static_cast<std::ptrdiff_t>(first)));
    }
    for (std::uint32_t& v : threaded) v = stream.vertex_order[v];
    CHECK(test::oriented_triangles(threaded) == test::oriented_triangles(mesh.indices));
    return std::move(stream);
}

std::uint32_t own_triangle(const PackedView& view, std::uint32_t triangle) {
    const std::span<const std::uint32_t> runs = view.words.subspan(view.doubles_word() + LR_PACKED_DOUBLES_WORDS);
    std::size_t run = 0;
    while (run + 1 < view.runs && runs[2 * (run + 1)] <= triangle) ++run;
    return (runs[2 * run + 1] & ~LR_PACKED_DOUBLES) + triangle - runs[2 * run];
}

/// Decodes every triangle from a copy of the stream in which all is poison but what is said of doubles, its block's
/// turns and its group.
void check_random_access(const EncodedPacked& stream) {
    const Result<PackedView> view = view_packed(stream.words);
    REQUIRE(view);
    std::vector<std::uint32_t> indices(std::size_t{3} * view->triangles);
    decode_packed(*view, indices);
    const auto group_begin = [&](std::uint32_t group) -> std::size_t {  // in bytes
        const std::size_t word = view->table_word() + group - 1;
        const std::size_t groups = view->doubles_word() - view->table_word() + 1;
        if (group >= groups) return 4 * (stream.words.size() - view->groups_word());
        return group == 0 ? 0 : 4 * std::size_t{stream.words[word]};
    };
    for (std::uint32_t block = 0; block * LR_PACKED_BLOCK < view->own; ++block) {
        std::vector<std::uint32_t> poisoned(stream.words.size(), 0xa5c3f10fU);
        const auto keep = [&](std::size_t first, std::size_t count) {
            count = std::min(count, stream.words.size() - first);
            std::copy_n(stream.words.begin() + static_cast<std::ptrdiff_t>(first), count,
                        poisoned.begin() + static_cast<std::ptrdiff_t>(first));
        };
        keep(0, LR_PACKED_HEADER_WORDS);
        keep(LR_PACKED_HEADER_WORDS + std::size_t{block} * LR_PACKED_BLOCK_WORDS, LR_PACKED_BLOCK_WORDS);
        const std::uint32_t group = block / LR_PACKED_GROUP;
        if (group > 0) keep(view->table_word() + group - 1, 1);
        keep(view->doubles_word(), view->groups_word() - view->doubles_word());
        const auto* groups = reinterpret_cast<const std::uint8_t*>(stream.words.data() + view->groups_word());
        std::copy(groups + group_begin(group), groups + group_begin(group + 1),
                  reinterpret_cast<std::uint8_t*>(poisoned.data() + view->groups_word()) + group_begin(group));

        const Result<PackedView> far = view_packed(poisoned);
        REQUIRE(far);
        const std::uint32_t first = block * LR_PACKED_BLOCK;
        for (std::uint32_t t = 0; t < view->triangles; ++t) {
            // A double's block is that of its own triangle, which comes behind it in no run.
            const std::uint32_t of = t < view->own ? t : own_triangle(*view, t);
            if (of < first || of >= first + LR_PACKED_BLOCK) continue;
            const auto got = decode_packed_triangle(*far, t);
            for (std::size_t k = 0; k < 3; ++k) REQUIRE(got.v[k] == indices[std::size_t{3} * t + k]);
        }
    }
}

}  // namespace

TEST_CASE("packed streams of named meshes") {
    for (const auto& [name, mesh] : test::named_meshes()) {
        CAPTURE_COPY(name);
        check_random_access(check(mesh, {}));
        check(mesh, {.seeds = 3, .random_seed = 2, .k = 7}, PackedProfile::small, 4);
        check_random_access(check(mesh, {}, PackedProfile::cache));
        check(mesh, {.k = 5}, PackedProfile::cache, 3);
    }
}

TEST_CASE("a doubled triangle is told by its number") {
    const Mesh sheet = generate("blob", 20000, 1).value();
    const auto doubled = [&](std::uint32_t begin, std::uint32_t end, bool turned) {
        Mesh mesh = sheet;
        for (std::uint32_t t = begin; t < end; ++t) {
            const std::uint32_t* v = &sheet.indices[std::size_t{3} * t];
            for (const std::uint32_t i : {v[1], turned ? v[0] : v[2], turned ? v[2] : v[0]}) mesh.indices.push_back(i);
        }
        return mesh;
    };
    const auto all = static_cast<std::uint32_t>(sheet.triangle_count());
    const EncodedPacked once = check(sheet, {}), both = check(doubled(0, all, true), {});
    CHECK(both.statistics.doubles == all);
    CHECK(both.words.size() == once.words.size() + LR_PACKED_DOUBLES_WORDS + LR_PACKED_RUN_WORDS);
    CHECK(check(doubled(0, all, false), {}, PackedProfile::cache).statistics.doubles == all);
    CHECK(check(doubled(100, 164, true), {}).statistics.doubles == 64);
    CHECK(check(doubled(100, 116, true), {}).statistics.doubles == 0);  // too few
    check_random_access(check(doubled(100, 3000, true), {}, PackedProfile::small, 2));

    // Runs that say something impossible.
    const std::size_t at = view_packed(both.words)->doubles_word();
    const auto refused = [&](std::size_t word, std::uint32_t value) {
        std::vector<std::uint32_t> bad = both.words;
        bad[word] = value;
        bad[LR_PACKED_WORD_CHECKSUM] = packed_checksum(bad);
        return !validate_packed(bad);
    };
    REQUIRE_FALSE(refused(at, all));  // how many
    CHECK(refused(at, 0));
    CHECK(refused(at, all + 1));
    CHECK(refused(at, UINT32_MAX));
    CHECK(refused(at + 1, 0));  // runs
    CHECK(refused(at + 1, 2));
    CHECK(refused(at + 1, UINT32_MAX));
    CHECK(refused(at + 2, all - 1));  // where the first begins
    CHECK(refused(at + 2, all + 1));
    CHECK(refused(at + 3, 1));        // beyond the last own triangle
    CHECK_FALSE(refused(at + 3, 0));  // the same way round, then
    CHECK(refused(at + 3, all));
}

TEST_CASE("packed streams of random soups") {
    std::uint32_t parted = 0, plain = 0;
    for (std::uint64_t seed = 1; seed <= 400; ++seed) {
        CAPTURE(seed);
        const auto n = static_cast<std::uint32_t>(seed);
        const EncodedPacked soup = check(test::random_soup(4 + n % 29, 1 + n % 83, seed), {});
        const EncodedPacked glued = check(test::random_gluing(10 + n % 50, 150 + 10 * (n % 30), seed), {.k = n % 3});
        check_random_access(glued);
        check(test::random_gluing(10 + n % 50, 150 + 10 * (n % 30), seed), {}, PackedProfile::cache, n % 2);
        const EncodedPacked dense = check(test::random_soup(300, 300, seed, false), {});
        parted += soup.statistics.parted_blocks + glued.statistics.parted_blocks + dense.statistics.parted_blocks;
        plain += soup.statistics.plain_blocks + glued.statistics.plain_blocks + dense.statistics.plain_blocks;
    }
    CHECK(parted > 10);  // both kinds of crowded blocks occur
    CHECK(plain > 10);
}

TEST_CASE("packed streams of real meshes, LACEDRING_MESHES") {
    const auto checked = test::for_each_real_mesh([&](const std::string& path, const Result<Mesh>& mesh) {
        REQUIRE(mesh);
        CAPTURE(path);
        for (const Weld mode : {Weld::none, Weld::position}) {
            check_random_access(check(weld(*mesh, mode), {}));
            check_random_access(check(weld(*mesh, mode), {}, PackedProfile::cache, 2));
        }
    });
    CHECK(checked.value_or(1) > 0);  // where the variable is set
}

TEST_CASE("damaged packed streams are refused or harmless") {
    std::size_t accepted = 0, refused = 0;
    for (std::uint64_t shape = 1; shape <= 30; ++shape) {
        const Mesh mesh = test::random_gluing(60, 80 + 30 * static_cast<std::uint32_t>(shape), shape);
        const Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
        REQUIRE(table);
        const Result<EncodedPacked> encoded =
            encode_packed(*table, expand_rings(*table), shape % 2 == 0 ? PackedProfile::small : PackedProfile::cache);
        REQUIRE(encoded);
        const std::vector<std::uint32_t>& good = encoded->words;
        test::for_each_cut(good, [](auto cut) { CHECK_FALSE(validate_packed(cut)); });
        std::vector<std::uint32_t> longer = good;
        longer.push_back(0);
        CHECK_FALSE(validate_packed(longer));
        test::for_each_damage(good, shape, 1000, [&](std::vector<std::uint32_t>& bad, auto&) {
            CHECK_FALSE(validate_packed(bad));  // the checksum
            bad[LR_PACKED_WORD_CHECKSUM] = packed_checksum(bad);
            const auto exact = test::exact_copy(std::span<const std::uint32_t>(bad));
            const Result<PackedView> view = validate_packed(std::span<const std::uint32_t>(exact.get(), bad.size()));
            ++(view ? accepted : refused);
            if (!view) return;  // else another mesh: whatever it is, decoding stays in bounds
            std::vector<std::uint32_t> indices(std::size_t{3} * view->triangles);
            decode_packed(*view, indices);
            for (const std::uint32_t v : indices) CHECK(v < view->vertices);
        });
    }
    CHECK(accepted > 100);
    CHECK(refused > 100);
}
