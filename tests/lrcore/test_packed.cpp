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

void check_packed_vertex_order(const Mesh& mesh, const EncodedPacked& stream) {
    INFO("vertex_order is a permutation");
    REQUIRE(stream.vertex_order.size() == mesh.vertex_count);
    std::vector<std::uint32_t> sorted = stream.vertex_order;
    std::sort(sorted.begin(), sorted.end());
    for (std::uint32_t v = 0; v < sorted.size(); ++v) REQUIRE(sorted[v] == v);
}

void check_packed_triangles(const Mesh& mesh, const EncodedPacked& stream, const PackedView& view,
                            std::span<const std::uint32_t> decoded) {
    INFO("a triangle decoded alone has its decoded vertices, and is the one that triangle_order names");
    REQUIRE(stream.triangle_order.size() == view.triangles);
    for (std::uint32_t i = 0; i < view.triangles; ++i) {
        const auto one = decode_packed_triangle(view, i);
        Triangle got{}, want{};
        for (std::size_t k = 0; k < 3; ++k) {
            REQUIRE(one.v[k] == decoded[std::size_t{3} * i + k]);
            got[k] = stream.vertex_order[one.v[k]];
            want[k] = mesh.indices[std::size_t{3} * stream.triangle_order[i] + k];
        }
        REQUIRE(leading_smallest(got) == leading_smallest(want));
    }
}

void check_packed_threads(const PackedView& view, std::span<const std::uint32_t> decoded) {
    INFO("three threads decode the same indices");
    std::vector<std::uint32_t> threaded(decoded.size());
    decode_packed(view, threaded, 3);
    CHECK(std::ranges::equal(threaded, decoded));
}

void check_packed_blocks(const PackedView& view, std::span<const std::uint32_t> decoded) {
    INFO("a block decoded alone has its decoded indices");
    for (std::uint32_t block = 0; block < view.blocks(); ++block) {
        CAPTURE(block);
        const std::size_t first = std::size_t{3} * LR_PACKED_BLOCK * block;
        const std::size_t size = std::min<std::size_t>(3 * LR_PACKED_BLOCK, decoded.size() - first);
        const auto part = std::make_unique<std::uint32_t[]>(size);
        decode_packed_block(view, block, {part.get(), size});
        CHECK(std::ranges::equal(std::span(part.get(), size), decoded.subspan(first, size)));
    }
}

void check_packed_mesh(const Mesh& mesh, const EncodedPacked& stream, std::span<const std::uint32_t> decoded) {
    INFO("the stream holds the mesh's triangles");
    std::vector<std::uint32_t> indices(decoded.begin(), decoded.end());
    for (std::uint32_t& v : indices) v = stream.vertex_order[v];
    CHECK(test::oriented_triangles(indices) == test::oriented_triangles(mesh.indices));
}

/// Encodes a mesh, checks the stream and its decoding, and returns the stream.
EncodedPacked check(const Mesh& mesh, const RingOptions& ring, PackedProfile profile = PackedProfile::small,
                    std::uint32_t passes = 0) {
    const Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
    REQUIRE(table);
    Result<PackedChoice> encoded =
        encode_smallest_packed(*table, ring, {.cost = kPackedRingCost, .passes = passes}, profile);
    REQUIRE(encoded);
    const EncodedPacked& stream = encoded->stream;

    // Buffers of exactly the stream's size: a sanitizer reports accesses past the end.
    const auto exact = test::exact_copy(std::span<const std::uint32_t>(stream.words));
    const Result<PackedView> view = validate_packed(std::span<const std::uint32_t>(exact.get(), stream.words.size()));
    REQUIRE_MESSAGE(view, view.error().message);
    CHECK(view->triangles == table->triangle_count() - table->topology.degenerate);
    CHECK_MESSAGE(view->bytes() <= std::size_t{12} * view->triangles + 72,
                  "at most the bytes of an index list and a fixed header");
    const std::size_t size = std::size_t{3} * view->triangles;
    const auto indices = std::make_unique<std::uint32_t[]>(size);
    const std::span<std::uint32_t> decoded(indices.get(), size);
    decode_packed(*view, decoded);

    check_packed_vertex_order(mesh, stream);
    check_packed_triangles(mesh, stream, *view, decoded);
    check_packed_threads(*view, decoded);
    check_packed_blocks(*view, decoded);
    check_packed_mesh(mesh, stream, decoded);
    return std::move(encoded->stream);
}

std::uint32_t own_triangle(const PackedView& view, std::uint32_t triangle) {
    const std::span<const std::uint32_t> runs = view.words.subspan(view.doubles_word() + LR_PACKED_DOUBLES_WORDS);
    std::size_t run = 0;
    while (run + 1 < view.runs && runs[2 * (run + 1)] <= triangle) ++run;
    return (runs[2 * run + 1] & ~LR_PACKED_DOUBLES) + triangle - runs[2 * run];
}

/// Decodes every triangle from a copy of the stream in which all words are overwritten, except the header, the table of
/// doubles, and the block record and group of the triangle.
void check_random_access(const EncodedPacked& stream) {
    INFO("a triangle is decoded from its block and group alone");
    const Result<PackedView> view = view_packed(stream.words);
    REQUIRE(view);
    std::vector<std::uint32_t> indices(std::size_t{3} * view->triangles);
    decode_packed(*view, indices);
    // In bytes from the first group.
    const auto group_begin = [&](std::uint32_t group) -> std::size_t {
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
            // A double is decoded from the block of the triangle that it repeats.
            const std::uint32_t of = t < view->own ? t : own_triangle(*view, t);
            if (of < first || of >= first + LR_PACKED_BLOCK) continue;
            const auto got = decode_packed_triangle(*far, t);
            for (std::size_t k = 0; k < 3; ++k) REQUIRE(got.v[k] == indices[std::size_t{3} * t + k]);
        }
    }
}

/// Returns `sheet` with a second copy of its triangles [begin, end), reversed if `turned`.
Mesh doubled(const Mesh& sheet, std::uint32_t begin, std::uint32_t end, bool turned) {
    Mesh mesh = sheet;
    for (std::uint32_t t = begin; t < end; ++t) {
        const std::uint32_t* v = &sheet.indices[std::size_t{3} * t];
        for (const std::uint32_t i : {v[1], turned ? v[0] : v[2], turned ? v[2] : v[0]}) mesh.indices.push_back(i);
    }
    return mesh;
}

}  // namespace

TEST_CASE("packed streams of named meshes decode to the mesh's triangles") {
    for (const auto& [name, mesh] : test::named_meshes()) {
        CAPTURE_COPY(name);
        check_random_access(check(mesh, {}));
        check(mesh, {.seeds = 3, .random_seed = 2, .k = 7}, PackedProfile::small, 4);
        check_random_access(check(mesh, {}, PackedProfile::cache));
        check(mesh, {.k = 5}, PackedProfile::cache, 3);
    }
}

TEST_CASE("doubled triangles are stored as runs of triangle numbers") {
    const Mesh sheet = generate("blob", 20000, 1).value();
    const auto all = static_cast<std::uint32_t>(sheet.triangle_count());
    SUBCASE("one run doubles the whole mesh, turned") {
        const EncodedPacked once = check(sheet, {}), both = check(doubled(sheet, 0, all, true), {});
        CHECK(both.statistics.doubles == all);
        CHECK(both.words.size() == once.words.size() + LR_PACKED_DOUBLES_WORDS + LR_PACKED_RUN_WORDS);
    }
    SUBCASE("doubles may have the same orientation") {
        CHECK(check(doubled(sheet, 0, all, false), {}, PackedProfile::cache).statistics.doubles == all);
    }
    SUBCASE("64 doubles are a run, 16 are too few") {
        CHECK(check(doubled(sheet, 100, 164, true), {}).statistics.doubles == 64);
        CHECK(check(doubled(sheet, 100, 116, true), {}).statistics.doubles == 0);
    }
    SUBCASE("doubles are decoded at random access") {
        check_random_access(check(doubled(sheet, 100, 3000, true), {}, PackedProfile::small, 2));
    }
}

TEST_CASE("runs of doubled triangles that are impossible are refused") {
    const Mesh sheet = generate("blob", 20000, 1).value();
    const auto all = static_cast<std::uint32_t>(sheet.triangle_count());
    const EncodedPacked both = check(doubled(sheet, 0, all, true), {});
    const std::size_t at = view_packed(both.words)->doubles_word();
    const auto refused = [&](std::size_t word, std::uint32_t value) {
        std::vector<std::uint32_t> bad = both.words;
        bad[word] = value;
        bad[LR_PACKED_WORD_CHECKSUM] = packed_checksum(bad);
        return !validate_packed(bad);
    };
    SUBCASE("the number of doubles") {
        REQUIRE_FALSE(refused(at, all));
        CHECK(refused(at, 0));
        CHECK(refused(at, all + 1));
        CHECK(refused(at, UINT32_MAX));
    }
    SUBCASE("the number of runs") {
        CHECK(refused(at + 1, 0));
        CHECK(refused(at + 1, 2));
        CHECK(refused(at + 1, UINT32_MAX));
    }
    SUBCASE("the first double of a run") {
        CHECK(refused(at + 2, all - 1));
        CHECK(refused(at + 2, all + 1));
    }
    SUBCASE("the first own triangle of a run") {
        CHECK_MESSAGE(refused(at + 3, 1), "the run ends beyond the last own triangle");
        CHECK_MESSAGE(!refused(at + 3, 0), "the same run without the turned bit is valid");
        CHECK(refused(at + 3, all));
    }
}

TEST_CASE("packed streams of random soups decode to the soup's triangles") {
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
    INFO("both kinds of crowded blocks occur");
    CHECK(parted > 10);
    CHECK(plain > 10);
}

TEST_CASE("packed streams of the meshes of LACEDRING_MESHES, where it is set, decode to the mesh's triangles") {
    const auto checked = test::for_each_real_mesh([&](const std::string& path, const Result<Mesh>& mesh) {
        REQUIRE(mesh);
        CAPTURE(path);
        for (const Weld mode : {Weld::none, Weld::position}) {
            check_random_access(check(weld(*mesh, mode), {}));
            check_random_access(check(weld(*mesh, mode), {}, PackedProfile::cache, 2));
        }
    });
    CHECK_MESSAGE(checked.value_or(1) > 0, "the folder has meshes");
}

TEST_CASE("damaged packed streams are refused or decode to vertices in range") {
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
            CHECK_MESSAGE(!validate_packed(bad), "the checksum differs");
            bad[LR_PACKED_WORD_CHECKSUM] = packed_checksum(bad);
            const auto exact = test::exact_copy(std::span<const std::uint32_t>(bad));
            const Result<PackedView> view = validate_packed(std::span<const std::uint32_t>(exact.get(), bad.size()));
            ++(view ? accepted : refused);
            if (!view) return;
            INFO("an accepted stream decodes within bounds");
            std::vector<std::uint32_t> indices(std::size_t{3} * view->triangles);
            decode_packed(*view, indices);
            for (const std::uint32_t v : indices) CHECK(v < view->vertices);
        });
    }
    CHECK(accepted > 100);
    CHECK(refused > 100);
}
