#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "lacedring/lacedring.hpp"
#include "lacedring/lacedring_seams.h"
#include "lacedring/seams.hpp"
#include "lrcore/base/crc32.h"
#include "lrlab/generate/generate.h"
#include "tests/support/capture.h"
#include "tests/support/cuts.h"
#include "tests/support/damage.h"
#include "tests/support/meshes.h"
#include "tests/support/named_streams.h"
#include "tests/support/shapes.h"

using namespace lacedring;
using test::cut;
using test::CutSurface;
using test::kCuts;

namespace {

using Words = std::vector<std::uint32_t>;

/// A mesh's triangles in the order and vertex numbers of its packed stream, cut in the way `how` (cuts.h).
CutSurface in_stream_order(const Mesh& mesh, std::uint32_t how, std::uint64_t seed) {
    const Result<Encoded> encoded = encode(mesh.indices, mesh.vertex_count, {.effort = 0});
    REQUIRE_MESSAGE(encoded, encoded.error().message);
    const Result<PackedView> view = validate_packed(encoded->words);
    Words triangles(std::size_t{3} * view->triangles);
    decode_packed(*view, triangles);
    return cut(triangles, view->vertices, how, seed);
}

Words without_degenerate(const Words& triangles) {
    Words out;
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        const std::uint32_t a = triangles[i], b = triangles[i + 1], c = triangles[i + 2];
        if (a != b && b != c && c != a) out.insert(out.end(), {a, b, c});
    }
    return out;
}

EncodedSeams encoded(const CutSurface& mesh) {
    Result<EncodedSeams> out = encode_seams(mesh.triangles, mesh.vertices, mesh.copies);
    REQUIRE_MESSAGE(out, out.error().message);
    return std::move(*out);
}

std::span<const std::uint32_t> block_of(std::span<const std::uint32_t> corners, std::uint32_t block) {
    const std::size_t first = std::size_t{3} * kSeamBlock * block;
    return corners.subspan(first, std::min<std::size_t>(corners.size() - first, 3 * kSeamBlock));
}

/// Validates and decodes a section in buffers of exactly its size. Checks that decoding while validating and decoding
/// by block, last to first, give the same copies.
Words decoded(const Words& words, const CutSurface& mesh) {
    const auto exact = std::make_unique<std::uint32_t[]>(words.size());
    std::ranges::copy(words, exact.get());
    const std::span<const std::uint32_t> section(exact.get(), words.size());
    const Result<SeamView> view = validate_seams(section, mesh.triangles, mesh.vertices);
    REQUIRE_MESSAGE(view, view.error().message);
    Words out(mesh.triangles.size());
    decode_seams(*view, mesh.triangles, out);
    Words at_once(out.size()), vertices(view->copies), vertices_at_once;
    copy_vertices(*view, mesh.triangles, vertices);
    REQUIRE(decode_seams_checked(section, mesh.triangles, mesh.vertices, at_once, vertices_at_once));
    REQUIRE_MESSAGE(at_once == out, "decoding while validating gives the same copies");
    REQUIRE_MESSAGE(vertices_at_once == vertices, "decoding while validating gives the same vertices of copies");
    for (std::uint32_t b = view->blocks(); b-- > 0;) {
        Words alone(block_of(out, b).size());
        decode_seam_block(*view, b, block_of(mesh.triangles, b), alone);
        REQUIRE_MESSAGE(std::ranges::equal(alone, block_of(out, b)), "a block alone has the same copies");
    }
    return out;
}

void check_home_ranges(const SeamView& view, std::span<const std::uint32_t> first) {
    INFO("each vertex has a range of home copies, and the ranges follow each other without gaps");
    REQUIRE(first.front() == 0);
    REQUIRE(first.back() == view.homes);
    REQUIRE(std::ranges::adjacent_find(first, std::greater_equal()) == first.end());
}

/// Returns the copies that corners have.
std::vector<bool> check_corner_copies(const CutSurface& mesh, const EncodedSeams& seams, const SeamView& view,
                                      const Words& corners, const Words& first) {
    INFO("each corner has its encoded copy; a home copy is in the range of the corner's vertex");
    std::vector<bool> used(view.copies);
    bool right = true;
    for (std::size_t c = 0; c < corners.size() && right; ++c) {
        const std::uint32_t v = mesh.triangles[c], copy = corners[c];
        if (v == UINT32_MAX) {
            right = copy == UINT32_MAX;
            continue;
        }
        right = copy < view.copies && seams.copy_order[copy] == mesh.copies[c] &&
                (copy >= view.homes || (first[v] <= copy && copy < first[v + 1]));
        if (right) used[copy] = true;
    }
    REQUIRE(right);
    return used;
}

/// Marks the copies of vertices without corners as used.
void check_vertices_without_corners(const CutSurface& mesh, const EncodedSeams& seams, const Words& first,
                                    std::vector<bool>& used) {
    INFO("a vertex without corners has one copy, which was none in the input");
    std::vector<bool> has_corners(mesh.vertices);
    for (const std::uint32_t v : mesh.triangles) {
        if (v != UINT32_MAX) has_corners[v] = true;
    }
    bool right = true;
    for (std::uint32_t v = 0; v < mesh.vertices; ++v) {
        if (has_corners[v]) continue;
        right &= first[v + 1] == first[v] + 1 && seams.copy_order[first[v]] == UINT32_MAX;
        used[first[v]] = true;
    }
    REQUIRE(right);
}

void check_distinct_copies(const EncodedSeams& seams) {
    INFO("no two copies are the same copy of the input");
    Words order = seams.copy_order;
    std::erase(order, UINT32_MAX);
    std::ranges::sort(order);
    REQUIRE(std::ranges::adjacent_find(order) == order.end());
}

/// Encodes and decodes the copies of a surface's corners, and checks their numbers.
void check(const CutSurface& mesh) {
    const EncodedSeams seams = encoded(mesh);
    const Words corners = decoded(seams.words, mesh);
    const Result<SeamView> view =
        view_seams(seams.words, static_cast<std::uint32_t>(corners.size() / 3), mesh.vertices);
    REQUIRE(view);
    REQUIRE(view->copies == seams.copy_order.size());
    Words first(std::size_t{mesh.vertices} + 1);
    first_copies(*view, first);
    check_home_ranges(*view, first);
    std::vector<bool> used = check_corner_copies(mesh, seams, *view, corners, first);
    check_vertices_without_corners(mesh, seams, first, used);
    REQUIRE_MESSAGE(std::ranges::find(used, false) == used.end(), "every copy has a corner or is of such a vertex");
    check_distinct_copies(seams);
}

void mend(Words& words) {
    words[1] = crc32(std::as_bytes(std::span(words).subspan(2)));
}

CutSurface blob(std::uint32_t triangles, std::uint32_t how) {
    return in_stream_order(generate("blob", triangles).value(), how, 5);
}

}  // namespace

TEST_CASE("seams of small named meshes, cut in every way, decode to the encoded copies") {
    std::uint64_t seed = 1;
    for (const test::NamedMesh& named : test::named_meshes()) {
        if (named.mesh.triangle_count() > (test::kSanitized ? 300 : 1000)) continue;
        CAPTURE(named.name);
        for (std::uint32_t how = 0; how < kCuts; ++how) {
            CAPTURE(how);
            check(in_stream_order(named.mesh, how, ++seed));
        }
    }
}

TEST_CASE("seams of triangles in random order decode to the encoded copies") {
    for (std::uint32_t n = 0; n < 30; ++n) {
        CAPTURE(n);
        const Mesh soup = test::random_soup(3 + 17 * n, 40 * n, n + 1),
                   glued = test::random_gluing(40 + 9 * n, 30 * n, n);
        check(cut(without_degenerate(soup.indices), soup.vertex_count, n % kCuts, n));
        check(cut(without_degenerate(glued.indices), glued.vertex_count, (n + 1) % kCuts, n));
    }
}

TEST_CASE("seams of flipped, doubled and pinched surfaces decode to the encoded copies") {
    const test::Shape grid = test::grid(20, 20, true, false, false);
    for (const test::Shape& shape :
         {test::turn_some(grid, 3), test::double_some(grid, 2, false), test::double_some(grid, 5, true),
          test::pinch(grid, 3, 300), test::fan(700, true), test::shuffle(grid, 3)}) {
        const Mesh mesh = test::make_mesh(shape.triangles, shape.vertices);
        for (std::uint32_t how = 0; how < kCuts; ++how) {
            check(in_stream_order(mesh, how, how));
            check(cut(mesh.indices, mesh.vertex_count, how, how));
        }
    }
}

TEST_CASE("seams of all formats' slots decode to the encoded copies; slots without a triangle have none") {
    std::uint64_t seed = 1;
    test::for_each_named_stream([&](const StreamView& view) {
        const Words slots = slot_triangles(view);
        Words triangles = slots;
        std::erase(triangles, UINT32_MAX);
        CHECK(triangles == decode(view));
        ++seed;
        check(cut(slots, view.vertices(), static_cast<std::uint32_t>(seed % kCuts), seed));
    });
    Words none(3000, UINT32_MAX);
    check(cut(none, 0, 0, 0));
    check(cut(none, 10, 0, 0));
}

TEST_CASE("seams of sizes around a block and a group of blocks decode to the encoded copies") {
    for (const std::uint32_t around : {0U, 512U, 1024U, 16384U}) {
        for (std::uint32_t k = 0; k < 5; ++k) {
            const std::uint32_t triangles = around + k - (around > 0 ? 2 : 0);
            CAPTURE(triangles);
            const test::Shape strip = test::strip(triangles);
            const Mesh mesh = test::make_mesh(strip.triangles, strip.vertices);
            check(cut(mesh.indices, strip.vertices, 2, k));
            check(cut(mesh.indices, strip.vertices + 700, 3, k));  // 700 vertices without corners
        }
    }
    check(cut({}, 513, 0, 0));
    check(cut({}, 0, 0, 0));
}

TEST_CASE("a section without seams takes at most 30 words besides its header") {
    const CutSurface mesh = blob(20000, 0);
    CHECK(encoded(mesh).words.size() < 8 + 30);
}

TEST_CASE("five striped charts take less than half a bit per triangle") {
    const CutSurface stripes = blob(20000, 1);
    const double bits = 32.0 * static_cast<double>(encoded(stripes).words.size()) / 20000;
    CHECK(bits < 0.5);
}

TEST_CASE("encode_seams refuses bad copies, vertices and triangles") {
    const Words two{0, 1, 2, 2, 1, 3};
    const auto code = [](const Words& triangles, std::uint32_t vertices, const Words& copies) {
        const Result<EncodedSeams> out = encode_seams(triangles, vertices, copies);
        REQUIRE(!out);
        CHECK(!out.error().message.empty());
        return out.error().code;
    };
    CHECK(encode_seams(two, 4, Words{5, 6, 7, 7, 8, 9}));
    CHECK(encode_seams(two, 4, Words{0, UINT32_MAX, 7, 7, 8, 9}));
    constexpr ErrorCode kInvalid = ErrorCode::invalid_argument;
    CHECK_MESSAGE(code(two, 4, {5, 6, 7, 7, 8, 5}) == kInvalid, "a copy of two vertices");
    CHECK_MESSAGE(code(two, 3, {5, 6, 7, 7, 8, 9}) == kInvalid, "an index beyond the vertices");
    CHECK_MESSAGE(code(two, 4, {5, 6, 7}) == kInvalid, "fewer copies than corners");
    CHECK_MESSAGE(code({0, 1}, 4, {5, 6}) == kInvalid, "two corners");
    CHECK_MESSAGE(code({0, 1, 1}, 4, {5, 6, 6}) == kInvalid, "a degenerate triangle");
    CHECK_MESSAGE(code(two, UINT32_MAX, {5, 6, 7, 7, 8, 9}) == ErrorCode::too_large, "2^32 - 1 vertices");
}

TEST_CASE("seam sections that are cut, longer, damaged or of other triangles are refused") {
    for (const std::uint32_t how : {1U, 4U}) {
        const CutSurface mesh = blob(1500, how);
        const Words words = encoded(mesh).words;
        test::for_each_cut(words, [&](auto cut) { CHECK(!validate_seams(cut, mesh.triangles, mesh.vertices)); });
        test::for_each_flip(words, [&](const Words& changed, std::size_t) {
            const Result<SeamView> view = validate_seams(changed, mesh.triangles, mesh.vertices);
            REQUIRE(!view);
            REQUIRE(!view.error().message.empty());
        });
        Words longer = words;
        longer.push_back(0);
        mend(longer);
        CHECK_MESSAGE(!validate_seams(longer, mesh.triangles, mesh.vertices), "a word too many");
        INFO("other numbers of triangles, corners and vertices");
        CHECK(!validate_seams(words, std::span(mesh.triangles).first(1500), mesh.vertices));
        CHECK(!validate_seams(words, mesh.triangles, mesh.vertices - 1));
        CHECK(!validate_seams(words, mesh.triangles, mesh.vertices + 1));
        CHECK(!validate_seams(words, mesh.triangles, UINT32_MAX));
        CHECK(!validate_seams(words, std::span(mesh.triangles).first(mesh.triangles.size() - 1), mesh.vertices));
        Words other = mesh.triangles;
        other[100] = mesh.vertices;
        CHECK_MESSAGE(!validate_seams(words, other, mesh.vertices), "an index beyond the vertices");
        other[100] = other[99];
        CHECK_MESSAGE(!validate_seams(words, other, mesh.vertices), "a degenerate triangle");
    }
}

TEST_CASE("a damaged section that is accepted decodes to copies of one vertex each") {
    std::uint32_t accepted = 0;
    for (const std::uint32_t how : {0U, 1U, 2U, 4U}) {
        const CutSurface mesh = blob(1500, how);
        test::for_each_damage(encoded(mesh).words, 9 + how, 200, [&](Words& changed, auto&) {
            mend(changed);
            const Result<SeamView> view = validate_seams(changed, mesh.triangles, mesh.vertices);
            if (!view) return;
            ++accepted;
            const CutSurface again{mesh.triangles, decoded(changed, mesh), mesh.vertices};
            REQUIRE(*std::ranges::max_element(again.copies) < view->copies);
            check(again);
        });
    }
    CHECK(accepted > 20);
}

TEST_CASE("a block is decoded from its bits, its vertices' blocks and their directory groups alone") {
    const CutSurface mesh = blob(20000, 4);  // two groups of blocks
    const Words words = encoded(mesh).words, copies = decoded(words, mesh);
    const Result<SeamView> view = validate_seams(words, mesh.triangles, mesh.vertices);
    REQUIRE(view);
    lacedring_seams opened{};
    REQUIRE(lacedring_seams_open(words.data(), words.size(), mesh.vertices, view->triangles, &opened, nullptr) ==
            LACEDRING_STATUS_OK);
    std::size_t at = 256;
    const auto take = [&](std::size_t count) {
        std::uint64_t value = 0;
        for (std::size_t k = 0; k < count; ++k, ++at) value |= std::uint64_t{words[at / 32] >> at % 32 & 1} << k;
        return static_cast<std::size_t>(value);
    };
    // For vertices and for triangles, in bits: the starts of the directory's groups and of the blocks, and their ends.
    std::vector<std::size_t> groups[2], begins[2];
    for (std::uint32_t kind = 0; kind < 2; ++kind) {
        const std::uint32_t length = words[3] >> 16 * kind & 255, count = words[3] >> (16 * kind + 8) & 255;
        const std::uint32_t elements = kind == 0 ? mesh.vertices : view->triangles;
        begins[kind] = {0};
        for (std::uint32_t b = 0; b < (elements + kSeamBlock - 1) / kSeamBlock; ++b) {
            if (b % LACEDRING_SEAMS_GROUP == 0) groups[kind].push_back(at);
            if (b > 0 && b % LACEDRING_SEAMS_GROUP == 0) at += 64;
            begins[kind].push_back(begins[kind].back() + take(length));
            at += count;
        }
        groups[kind].push_back(at);
    }
    REQUIRE(groups[1].size() == 3);
    const std::size_t parts[] = {at, at + begins[0].back()};
    for (const std::uint32_t block : {0U, 1U, 31U, 32U, view->blocks() - 1}) {
        CAPTURE(block);
        std::vector<bool> kept(32 * words.size());
        const auto keep = [&](std::size_t begin, std::size_t end) {
            std::fill(kept.begin() + static_cast<std::ptrdiff_t>(begin),
                      kept.begin() + static_cast<std::ptrdiff_t>(end), true);
        };
        const auto keep_block = [&](std::uint32_t kind, std::size_t b) {
            const std::size_t group = b / LACEDRING_SEAMS_GROUP;
            keep(groups[kind][group], groups[kind][group + 1]);
            keep(parts[kind] + begins[kind][b], parts[kind] + begins[kind][b + 1]);
        };
        keep(0, 256);
        keep_block(1, block);
        const auto triangles = block_of(mesh.triangles, block);
        for (const std::uint32_t v : triangles) keep_block(0, v / kSeamBlock);
        Words poisoned = words;
        for (std::size_t bit = 0; bit < kept.size(); ++bit) {
            if (!kept[bit]) poisoned[bit / 32] ^= 1U << bit % 32;
        }
        CHECK(poisoned != words);
        opened.words = poisoned.data();
        Words alone(triangles.size());
        lacedring_seams_block(&opened, block, triangles.data(), alone.data());
        CHECK(std::ranges::equal(alone, block_of(copies, block)));
    }
}

TEST_CASE("golden bytes: seam sections have the stored checksum") {
    std::uint32_t sum = 0;
    for (std::uint32_t how = 0; how < kCuts; ++how) {
        const test::Shape grid = test::turn_some(test::grid(60, 30, true, false, false), 50);
        const Mesh mesh = test::make_mesh(grid.triangles, grid.vertices);
        const EncodedSeams seams = encoded(cut(mesh.indices, mesh.vertex_count, how, 3));
        sum = crc32(std::as_bytes(std::span(seams.words)), sum);
        sum = crc32(std::as_bytes(std::span(seams.copy_order)), sum);
    }
    CHECK(sum == 0x1bc16740U);
}
