#include <doctest/doctest.h>

#include <algorithm>
#include <memory>
#include <random>

#include "lacedring/lacedring.hpp"
#include "lacedring/streams.hpp"
#include "lrcore/codec/storage/packed_storage.h"
#include "lrcore/codec/storage/rans.h"
#include "lrlab/generate/generate.h"
#include "tests/support/damage.h"
#include "tests/support/meshes.h"
#include "tests/support/stored_in_c.h"

using namespace lacedring;
using storage::restore_packed;
using storage::store_packed;

namespace {

using Words = std::vector<std::uint32_t>;

Words encoded(const Mesh& mesh, PackedProfile profile = PackedProfile::small) {
    EncodeOptions options;
    options.profile = profile;
    Result<Encoded> out = encode(mesh.indices, mesh.vertex_count, options);
    REQUIRE_MESSAGE(out, out.error().message);
    return std::move(out->words);
}

storage::PackedLimits limits_of(const PackedView& view) {
    return {view.vertices, view.triangles};
}

/// Restores from a copy in a buffer of exactly its size.
Result<Words> restored(const Words& stored, const storage::PackedLimits& limits) {
    const auto exact = std::make_unique<std::uint32_t[]>(stored.size());
    std::ranges::copy(stored, exact.get());
    return restore_packed({exact.get(), stored.size()}, limits);
}

/// Returns whether the stream has a storage form, and checks that it restores the stream, and decodes in C.
bool round_trips(const Words& words) {
    const Result<PackedView> view = validate_packed(words);
    REQUIRE(view);
    const std::optional<Words> stored = store_packed(*view);
    if (!stored) return false;
    const Result<Words> back = restored(*stored, limits_of(*view));
    REQUIRE_MESSAGE(back, back.error().message);
    CHECK(*back == words);
    CHECK(test::triangles_in_c(*stored, view->vertices, view->triangles) == decode(*view_stream(words)));
    return true;
}

/// Decodes damaged words in C; if they restore to a valid stream, C must find its triangles.
void same_in_c(const Words& stored, const storage::PackedLimits& limits, const Result<Words>& back) {
    const auto triangles = test::triangles_in_c(stored, limits.vertices, limits.triangles);
    if (!back || !validate_packed(*back)) return;
    CHECK(triangles == decode(*view_stream(*back)));
}

}  // namespace

TEST_CASE("packed streams are restored from their storage form bit for bit") {
    std::size_t none = 0, all = 0;
    for (const test::NamedMesh& named : test::named_meshes()) {
        const auto& name = named.name;
        const Mesh& mesh = named.mesh;
        CAPTURE(name);
        ++all;
        const bool stored = round_trips(encoded(mesh));
        if (!stored) ++none;
        const Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
        REQUIRE(table);
        // With inconsistent orientations a stream may code turns in a way that has no storage form.
        if (table->topology.flipped == 0 && table->topology.nonmanifold_edges == 0) CHECK(stored);
    }
    MESSAGE(none << " of " << all << " streams stay resident");
    CHECK_MESSAGE(5 * none <= all, "at most a fifth have no storage form");
}

TEST_CASE("streams for the vertex cache and of random triangles are restored bit for bit, or have no storage form") {
    std::size_t stored = 0;
    for (const test::NamedMesh& named : test::named_meshes()) {
        const auto& name = named.name;
        const Mesh& mesh = named.mesh;
        CAPTURE(name);
        if (round_trips(encoded(mesh, PackedProfile::cache))) ++stored;
    }
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        CAPTURE(seed);
        for (const std::uint32_t size : {4U, 40U, 400U}) {
            if (round_trips(encoded(test::random_soup(size, 2 * size, seed)))) ++stored;
            if (round_trips(encoded(test::random_gluing(size, 2 * size, seed)))) ++stored;
        }
    }
    CHECK(stored > 0);
}

TEST_CASE("the storage form of a closed surface takes less than 90 % of its stream") {
    const Mesh blob = generate("blob", 20000, 7).value();
    const Words words = encoded(blob);
    const std::optional<Words> stored = store_packed(*validate_packed(words));
    REQUIRE(stored);
    const double before = 32.0 * static_cast<double>(words.size()) / static_cast<double>(blob.triangle_count());
    const double after = 32.0 * static_cast<double>(stored->size()) / static_cast<double>(blob.triangle_count());
    MESSAGE("bits per triangle: " << before << " resident, " << after << " stored");
    CHECK(after < 0.9 * before);
}

TEST_CASE("stored packed streams: cut or beyond their limits refused; damaged ones decode the same in C, if at all") {
    std::size_t same = 0, all = 0;
    for (const test::NamedMesh& named : test::named_meshes()) {
        const auto& name = named.name;
        const Mesh& mesh = named.mesh;
        if (mesh.triangle_count() > 300) continue;
        CAPTURE(name);
        const Words words = encoded(mesh);
        const Result<PackedView> view = validate_packed(words);
        REQUIRE(view);
        const std::optional<Words> stored = store_packed(*view);
        if (!stored) continue;
        test::for_each_cut(*stored, [&](auto cut) {
            CHECK_FALSE(restored({cut.begin(), cut.end()}, limits_of(*view)));
            CHECK_FALSE(test::triangles_in_c(cut, view->vertices, view->triangles).has_value());
        });
        if (view->vertices > 0) {
            CHECK_FALSE(restored(*stored, {view->vertices - 1, view->triangles}));
            CHECK_FALSE(test::triangles_in_c(*stored, view->vertices - 1, view->triangles).has_value());
        }
        if (view->triangles > 0)
            CHECK_FALSE(test::triangles_in_c(*stored, view->vertices, view->triangles - 1).has_value());
        if (view->own > 0) CHECK_FALSE(restored(*stored, {view->vertices, view->own - 1}));
        const auto use = [&](const Words& changed, std::size_t) {
            const Result<Words> back = restored(changed, limits_of(*view));
            same_in_c(changed, limits_of(*view), back);
            ++all;
            // A bit of a step whose edge has no triangle beyond it may make no difference.
            if (back && *back == words) ++same;
        };
        test::for_each_flip(*stored, use, test::kSanitized ? 5 : 32);
    }
    MESSAGE(same << " of " << all << " changed bits make no difference");
    CHECK(50 * same < all);
}

TEST_CASE("random words are refused as stored packed stream, or decode the same in C") {
    const auto seed = std::random_device()();
    CAPTURE(seed);
    std::mt19937 engine(seed);
    const auto random = [&] { return static_cast<std::uint32_t>(engine()); };
    for (int round = 0; round < (test::kSanitized ? 2000 : 20000); ++round) {
        Words words(random() % 40);
        for (std::uint32_t& w : words) w = random();
        if (words.size() > 7) {
            words[0] = random() % 1000;
            words[1] = random() % 1000;
            words[2] = random() % 4 == 0 ? random() : 0;
            words[3] = 4 + random() % static_cast<std::uint32_t>(words.size() - 7);
        }
        const Result<Words> back = restored(words, {1000, 1000});
        same_in_c(words, {1000, 1000}, back);
        if (!back) CHECK_FALSE(back.error().message.empty());
    }
}

TEST_CASE("an empty place on the stack of open edges counts until a step looks for an edge below it") {
    // The same words are in tests/independent/test_storage_reader.py; no encoder writes them.
    const Words words{16, 5, 0, 6, 0xc1ee17f8, 0, 0x984031fc, 0, 0xd6d3f968, 0x86a11b54, 0x2c940};
    const std::vector<std::uint32_t> triangles{0, 10, 5, 0, 5, 2, 2, 5, 3, 0, 2, 11, 5, 10, 7};
    CHECK(test::triangles_in_c(words, 16, 5) == triangles);
}

TEST_CASE("the entropy decoder returns the encoder's numbers, symbols and bits, and reads all words") {
    const auto seed = std::random_device()();
    CAPTURE(seed);
    std::mt19937 engine(seed);
    const auto random = [&] { return static_cast<std::uint32_t>(engine()); };
    for (const std::size_t count : {0U, 1U, 2U, 3U, 1000U, 30000U}) {
        Words values(count);
        for (std::uint32_t& v : values) v = random() >> random() % 32;
        // The same calls encode and decode: an encoder returns its argument, a decoder the decoded value.
        const auto code = [&](auto& coder) {
            storage::NumberModel number;
            storage::SymbolModel symbol;
            storage::BitModel bit;
            Words out;
            for (const std::uint32_t v : values) {
                const std::uint32_t given = std::decay_t<decltype(coder)>::kDecodes ? 0 : v;
                out.push_back(number.code(coder, given));
                out.push_back(coder.symbol(symbol, given % 16));
                out.push_back(coder.bit(bit, given % 7 == 1 ? 1 : 0));
                out.push_back(coder.raw(given, v % 33));
            }
            return out;
        };
        storage::Encoder encoder;
        const Words put = code(encoder), words = encoder.finish();
        storage::Decoder decoder(words);
        CHECK(code(decoder) == put);
        CHECK(decoder.is_at_end());
    }
}
