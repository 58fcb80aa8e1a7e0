// The storage form of seams restores every section bit for bit; damaged words are refused or restore to valid sections.
#include <doctest/doctest.h>

#include <algorithm>
#include <memory>
#include <random>

#include "lacedring/lacedring.hpp"
#include "lacedring/lacedring_seams.h"
#include "lacedring/seams.hpp"
#include "lrcore/base/crc32.h"
#include "lrcore/codec/storage/seam_storage.h"
#include "lrlab/generate/generate.h"
#include "tests/support/cuts.h"
#include "tests/support/damage.h"
#include "tests/support/meshes.h"
#include "tests/support/shapes.h"
#include "tests/support/stored_in_c.h"

using namespace lacedring;
using test::cut;
using test::CutSurface;
using test::kCuts;

namespace {

using Words = std::vector<std::uint32_t>;

Words section_of(const CutSurface& mesh) {
    Result<EncodedSeams> out = encode_seams(mesh.triangles, mesh.vertices, mesh.copies);
    REQUIRE_MESSAGE(out, out.error().message);
    return std::move(out->words);
}

SeamView view_of(const Words& section, const CutSurface& mesh) {
    const Result<SeamView> view = validate_seams(section, mesh.triangles, mesh.vertices);
    REQUIRE_MESSAGE(view, view.error().message);
    return *view;
}

/// Restores a section from a buffer of exactly its size. Checks that a restored section is valid and decodes to the
/// restored copies, and that C accepts the same words and decodes the same copies.
Result<Words> restored_seams(std::span<const std::uint32_t> stored, const CutSurface& mesh) {
    const auto exact = std::make_unique<std::uint32_t[]>(stored.size());
    std::ranges::copy(stored, exact.get());
    auto out = storage::restore_seams({exact.get(), stored.size()}, mesh.triangles, mesh.vertices);
    const auto corners = static_cast<std::uint32_t>(mesh.triangles.size());
    const auto in_c = [&](std::uint32_t most) { return test::seams_in_c(stored, mesh.triangles, mesh.vertices, most); };
    const auto any = in_c(mesh.vertices + corners);
    REQUIRE_MESSAGE(any.has_value() == static_cast<bool>(out), "C and C++ accept the same words");
    if (!out) {
        CHECK_FALSE(out.error().message.empty());
        return out.error();
    }
    REQUIRE_MESSAGE(any->copies == out->copies, "C decodes the same copies");
    REQUIRE_MESSAGE(any->vertices == out->vertices, "C decodes the same vertices of copies");
    const auto count = static_cast<std::uint32_t>(out->vertices.size());
    const auto exact_in_c = in_c(count);
    REQUIRE(exact_in_c);
    REQUIRE(exact_in_c->vertices == out->vertices);
    if (count > 0) CHECK_MESSAGE(!in_c(count - 1), "C refuses more copies than its limit");
    Words copies(mesh.triangles.size()), vertices;
    const auto view = decode_seams_checked(out->words, mesh.triangles, mesh.vertices, copies, vertices);
    REQUIRE_MESSAGE(view, view.error().message);
    REQUIRE_MESSAGE(out->copies == copies, "the restored section decodes to the restored copies");
    REQUIRE_MESSAGE(out->vertices == vertices, "the restored section decodes to the restored vertices of copies");
    return std::move(out->words);
}

/// Returns the stored form of a section, and checks that it restores the section.
Words stored_seams(const Words& section, const CutSurface& mesh) {
    const auto stored = storage::store_seams(view_of(section, mesh), mesh.triangles);
    REQUIRE(stored);
    const Result<Words> back = restored_seams(*stored, mesh);
    REQUIRE_MESSAGE(back, back.error().message);
    CHECK(*back == section);
    return *stored;
}

CutSurface in_packed_order(const Mesh& mesh, std::uint32_t how, std::uint64_t seed) {
    const Result<Encoded> encoded = encode(mesh.indices, mesh.vertex_count, {.effort = 0});
    REQUIRE_MESSAGE(encoded, encoded.error().message);
    const StreamView view = view_stream(encoded->words).value();
    return cut(slot_triangles(view), view.vertices(), how, seed);
}

}  // namespace

TEST_CASE("seams of named meshes, cut in every way, are restored from their storage form") {
    std::size_t resident = 0, stored = 0;
    for (const test::NamedMesh& named : test::named_meshes()) {
        const auto& name = named.name;
        CAPTURE(name);
        for (std::uint32_t how = 0; how < kCuts; ++how) {
            CAPTURE(how);
            const CutSurface mesh = in_packed_order(named.mesh, how, 5);
            const Words section = section_of(mesh);
            resident += section.size();
            stored += stored_seams(section, mesh).size();
        }
    }
    MESSAGE(4 * resident << " bytes resident, " << 4 * stored << " stored");
    CHECK(10 * stored < 6 * resident);
}

TEST_CASE("stored seams of slots without triangles, of random triangles and of blocks without copies") {
    for (const Format format : {Format::lean, Format::lr, Format::lr_compact}) {
        const Mesh mesh = generate("parts", 900).value();
        const Encoded encoded = encode(mesh.indices, mesh.vertex_count, {.format = format, .effort = 0}).value();
        const StreamView view = view_stream(encoded.words).value();
        for (std::uint32_t how = 0; how < kCuts; ++how) {
            const CutSurface surface = cut(slot_triangles(view), view.vertices(), how, 3);
            stored_seams(section_of(surface), surface);
        }
    }
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        CAPTURE(seed);
        const Mesh soup = test::random_soup(200, 300, seed), gluing = test::random_gluing(100, 150, seed);
        for (const Mesh* mesh : {&soup, &gluing}) {
            const CutSurface surface = in_packed_order(*mesh, static_cast<std::uint32_t>(seed) % kCuts, seed);
            stored_seams(section_of(surface), surface);
        }
    }
    const Mesh blob = generate("blob", 20000).value();
    CutSurface surface = in_packed_order(blob, 0, 1);
    const std::size_t none = stored_seams(section_of(surface), surface).size();
    CHECK(none <= 12);
    for (std::size_t c = 0; c < 900; ++c)
        surface.copies[c] += surface.vertices * (1 + static_cast<std::uint32_t>(c / 3 % 2));
    CHECK(stored_seams(section_of(surface), surface).size() > none);
}

TEST_CASE("seams of a vertex with 200,000 triangles and copies are stored in linear time") {
    CutSurface fan;  // each triangle has a copy of the hub
    const std::uint32_t count = test::kSanitized ? 20000 : 200000;
    fan.vertices = count + 2;
    for (std::uint32_t i = 0; i < count; ++i) {
        fan.triangles.insert(fan.triangles.end(), {0, i + 1, i + 2});
        fan.copies.insert(fan.copies.end(), {fan.vertices + i, i + 1, i + 2});
    }
    stored_seams(section_of(fan), fan);
}

TEST_CASE("a valid section with another table is restored from its storage form, or has none") {
    const CutSurface mesh = in_packed_order(generate("blob", 2000).value(), 1, 2);
    const Words section = section_of(mesh);
    std::size_t stored = 0, resident = 0;
    // Flips each bit of the table; most make the section invalid.
    for (std::uint32_t bit = 0; bit < 128; ++bit) {
        Words other = section;
        other[4 + bit / 32] ^= 1U << bit % 32;
        other[1] = crc32(std::as_bytes(std::span(other).subspan(2)));
        const Result<SeamView> view = validate_seams(other, mesh.triangles, mesh.vertices);
        if (!view) continue;
        const auto made = storage::store_seams(*view, mesh.triangles);
        ++(made ? stored : resident);
        if (!made) continue;
        const Result<Words> back = restored_seams(*made, mesh);
        CHECK((back && *back == other));
    }
    CAPTURE(resident);
    CHECK(stored > 0);
}

TEST_CASE("stored seams that are cut, longer or of other triangles are refused or restore to another section") {
    const Mesh blob = generate("blob", 1500).value();
    const CutSurface mesh = in_packed_order(blob, 1, 4), other = in_packed_order(generate("genus", 1400).value(), 1, 4);
    const Words section = section_of(mesh), stored = stored_seams(section, mesh);
    test::for_each_cut(stored, [&](auto cut) {
        const Result<Words> back = restored_seams(cut, mesh);
        CHECK_FALSE((back && *back == section));
    });
    Words longer = stored;
    longer.push_back(0);
    CHECK_FALSE(restored_seams(longer, mesh));
    (void)restored_seams(stored, other);
    CHECK_FALSE(storage::restore_seams(stored, std::span(mesh.triangles).first(4), mesh.vertices));
    CHECK_FALSE(storage::restore_seams(stored, mesh.triangles, mesh.vertices - 1));
    CHECK_FALSE(storage::restore_seams(stored, mesh.triangles, UINT32_MAX));
    const Words twice{1, 2, 1};
    CHECK_FALSE(storage::restore_seams(stored, twice, 3));
    CHECK_FALSE(test::seams_in_c(stored, mesh.triangles, mesh.vertices - 1, UINT32_MAX));
    CHECK_FALSE(test::seams_in_c(stored, mesh.triangles, UINT32_MAX, UINT32_MAX));
    CHECK_FALSE(test::seams_in_c(stored, twice, 3, UINT32_MAX));
}

TEST_CASE("damaged and random words are refused as stored seams, or restore to a valid section") {
    const auto seed = std::random_device()();
    CAPTURE(seed);
    std::mt19937 engine(seed);
    const auto random = [&] { return static_cast<std::uint32_t>(engine()); };
    const std::uint32_t rounds = test::kSanitized ? 40 : 300;
    for (const test::NamedMesh& named : test::named_meshes()) {
        if (named.mesh.triangle_count() > 200) continue;
        const auto& name = named.name;
        CAPTURE(name);
        const CutSurface mesh = in_packed_order(named.mesh, 1 + random() % (kCuts - 1), random());
        const Words stored = stored_seams(section_of(mesh), mesh);
        test::for_each_damage(stored, random(), rounds,
                              [&](const Words& words, auto&) { (void)restored_seams(words, mesh); });
        for (std::uint32_t round = 0; round < rounds / 2; ++round) {
            Words words(1 + random() % (2 * stored.size()));
            for (std::uint32_t& w : words) w = random() % 4 == 0 ? UINT32_MAX * (random() % 2) : random();
            (void)restored_seams(words, mesh);
        }
    }
}
