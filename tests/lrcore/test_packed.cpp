#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "lacedring/lacedring.hpp"
#include "lacedring/mesh_files.hpp"
#include "lacedring/streams.hpp"
#include "lrcore/codec/packed/packed_format.h"
#include "tests/support/capture.h"
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
    const Rings rings = optimize_rings(*table, expand_rings(*table, ring), {.cost = kPackedRingCost, .passes = passes});
    Result<EncodedPacked> encoded = encode_packed(*table, rings, profile);
    REQUIRE(encoded);
    EncodedPacked& stream = *encoded;

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
    return std::move(*encoded);
}

/// Decodes every triangle from a copy of the stream in which all is poison but its block's turns and its group.
void check_random_access(const EncodedPacked& stream) {
    const Result<PackedView> view = view_packed(stream.words);
    REQUIRE(view);
    std::vector<std::uint32_t> indices(std::size_t{3} * view->triangles);
    decode_packed(*view, indices);
    const auto group_begin = [&](std::uint32_t group) -> std::size_t {  // in bytes
        const std::size_t word = view->table_word() + group - 1;
        const std::size_t groups = view->groups_word() - view->table_word() + 1;
        if (group >= groups) return 4 * (stream.words.size() - view->groups_word());
        return group == 0 ? 0 : stream.words[word];
    };
    for (std::uint32_t block = 0; block < view->blocks(); ++block) {
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
        const auto* groups = reinterpret_cast<const std::uint8_t*>(stream.words.data() + view->groups_word());
        std::copy(groups + group_begin(group), groups + group_begin(group + 1),
                  reinterpret_cast<std::uint8_t*>(poisoned.data() + view->groups_word()) + group_begin(group));

        const Result<PackedView> far = view_packed(poisoned);
        REQUIRE(far);
        for (std::uint32_t t = block * LR_PACKED_BLOCK; t < std::min((block + 1) * LR_PACKED_BLOCK, view->triangles);
             ++t) {
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
    const std::uint64_t seed = 20261124;
    INFO("seed ", seed);
    std::uint64_t state = seed;
    const auto random = [&](std::uint32_t below) {
        state = state * 6364136223846793005U + 1442695040888963407U;
        return static_cast<std::uint32_t>((state >> 33) % below);
    };
    std::size_t accepted = 0, refused = 0;
    for (std::uint64_t shape = 1; shape <= 30; ++shape) {
        const Mesh mesh = test::random_gluing(60, 80 + 30 * static_cast<std::uint32_t>(shape), shape);
        const Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
        REQUIRE(table);
        const Result<EncodedPacked> encoded =
            encode_packed(*table, expand_rings(*table), shape % 2 == 0 ? PackedProfile::small : PackedProfile::cache);
        REQUIRE(encoded);
        const std::vector<std::uint32_t>& good = encoded->words;
        for (std::size_t size = 0; size < good.size(); ++size)
            CHECK_FALSE(validate_packed(std::span(good).first(size)));
        std::vector<std::uint32_t> longer = good;
        longer.push_back(0);
        CHECK_FALSE(validate_packed(longer));
        for (int trial = 0; trial < 1000; ++trial) {
            std::vector<std::uint32_t> bad = good;
            for (std::uint32_t k = 0; k <= random(3); ++k) {
                std::uint32_t& word = bad[random(static_cast<std::uint32_t>(bad.size()))];
                word = random(3) != 0 ? word ^ 1U << random(32) : static_cast<std::uint32_t>(state);
            }
            if (bad == good) continue;
            CHECK_FALSE(validate_packed(bad));  // the checksum
            bad[LR_PACKED_WORD_CHECKSUM] = packed_checksum(bad);
            const auto exact = std::make_unique<std::uint32_t[]>(bad.size());
            std::copy(bad.begin(), bad.end(), exact.get());
            const Result<PackedView> view = validate_packed(std::span<const std::uint32_t>(exact.get(), bad.size()));
            if (!view) {
                ++refused;
                continue;
            }
            ++accepted;  // another mesh, then: whatever it is, decoding stays in bounds
            std::vector<std::uint32_t> indices(std::size_t{3} * view->triangles);
            decode_packed(*view, indices);
            for (const std::uint32_t v : indices) CHECK(v < view->vertices);
        }
    }
    CHECK(accepted > 100);
    CHECK(refused > 100);
}
