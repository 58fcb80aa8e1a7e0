// Compares encode, validate, decode, decode_block and decode_triangle of every format with the mesh's triangles.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>

#include "lacedring/lacedring.hpp"
#include "lrlab/generate/generate.h"
#include "tests/support/meshes.h"

using namespace lacedring;

namespace {

constexpr Format kEveryFormat[] = {Format::lean, Format::packed, Format::lr, Format::lr_compact};

Triangle turned(Triangle t) {
    std::rotate(t.v, std::min_element(t.v, t.v + 3), t.v + 3);
    return t;
}

void check_view_counts(const Mesh& mesh, const Encoded& encoded, const StreamView& view) {
    INFO("the view counts what the report counts");
    CHECK(view.format() == encoded.format);
    CHECK(view.triangles() == encoded.report.triangles);
    CHECK(view.triangles() == mesh.triangle_count() - encoded.report.topology.degenerate);
    CHECK(view.vertices() == mesh.vertex_count + encoded.report.copies);
    CHECK(encoded.vertex_order.size() == view.vertices());
    const Result<StreamView> trusted = view_stream(encoded.words);
    REQUIRE(trusted);
    CHECK(trusted->triangles() == view.triangles());
}

void check_decoded_triangles(const Mesh& mesh, const Encoded& encoded, std::span<const std::uint32_t> indices) {
    INFO("the decoded triangles are the mesh's, in the order and orientation of triangle_order and vertex_order");
    REQUIRE(3 * encoded.triangle_order.size() == indices.size());
    bool right = true;
    for (std::size_t i = 0; i < encoded.triangle_order.size(); ++i) {
        Triangle got{}, wanted{};
        for (std::size_t k = 0; k < 3; ++k) {
            got.v[k] = encoded.vertex_order[indices[3 * i + k]];
            wanted.v[k] = mesh.indices[std::size_t{3} * encoded.triangle_order[i] + k];
        }
        right &= turned(got) == turned(wanted);
    }
    CHECK(right);
}

void check_distinct_order(const Encoded& encoded) {
    INFO("triangle_order names no triangle twice");
    std::vector<std::uint32_t> sorted = encoded.triangle_order;
    std::ranges::sort(sorted);
    CHECK(std::ranges::adjacent_find(sorted) == sorted.end());
}

/// Does nothing for null, which is a stream of another format.
template <class Tables>
void check_copies_of_tables(const Encoded& encoded, const Tables* tables) {
    if (tables == nullptr) return;
    INFO("a vertex copy has the mesh vertex of its original");
    const Operators ops(tables->view, tables->copies);
    std::uint32_t copies = 0;
    for (std::uint32_t v = 0; v < encoded.vertex_order.size(); ++v) {
        const std::uint32_t original = ops.original(VertexId{v}).value;
        copies += original != v ? 1 : 0;
        CHECK(encoded.vertex_order[original] == encoded.vertex_order[v]);
    }
    CHECK(copies == encoded.report.copies);
}

void check_threaded_decode(const StreamView& view, const std::vector<std::uint32_t>& indices) {
    INFO("three threads decode the same indices");
    std::vector<std::uint32_t> threaded(indices.size());
    CHECK(decode(view, threaded, 3));
    CHECK(threaded == indices);
}

void check_block_decode(const StreamView& view, const std::vector<std::uint32_t>& indices) {
    INFO("the blocks, one after another, decode to the same indices");
    std::vector<std::uint32_t> blocks;
    std::array<std::uint32_t, std::size_t{3} * StreamView::kBlock> block{};
    for (std::uint32_t b = 0; b < view.blocks(); ++b) {
        const Result<std::uint32_t> triangles = decode_block(view, b, block);
        REQUIRE(triangles);
        blocks.insert(blocks.end(), block.begin(), block.begin() + std::ptrdiff_t{3} * *triangles);
    }
    CHECK(blocks == indices);
}

void check_slot_decode(const StreamView& view, const std::vector<std::uint32_t>& indices) {
    INFO("the slots, decoded one by one, hold the same triangles");
    std::vector<std::uint32_t> slots;
    for (std::uint32_t slot = 0; slot < view.slots(); ++slot) {
        if (const std::optional<Triangle> t = decode_triangle(view, slot)) slots.insert(slots.end(), t->v, t->v + 3);
    }
    CHECK(slots == indices);
}

void check_16_bit_decode(const StreamView& view, const std::vector<std::uint32_t>& indices) {
    INFO("16-bit indices are the same up to 65,536 vertices, and refused beyond");
    std::vector<std::uint16_t> narrow(indices.size());
    if (view.vertices() <= 65536) {
        CHECK(decode(view, narrow));
        CHECK(std::ranges::equal(narrow, indices));
    } else {
        CHECK(decode(view, narrow).error().code == ErrorCode::invalid_argument);
    }
}

void check_refused_arguments(const StreamView& view) {
    INFO("slots and blocks beyond the end, and buffers of another size, are refused");
    std::array<std::uint32_t, std::size_t{3} * StreamView::kBlock> block{};
    CHECK_FALSE(decode_triangle(view, view.slots()));
    CHECK(decode_block(view, view.blocks(), block).error().code == ErrorCode::invalid_argument);
    if (view.blocks() > 0) CHECK_FALSE(decode_block(view, 0, std::span(block).first(2)));
    std::vector<std::uint32_t> longer(std::size_t{3} * view.triangles() + 1);
    CHECK(decode(view, longer).error().code == ErrorCode::invalid_argument);
}

/// Decodes a stream in every way and compares the triangles with the mesh's.
void check_stream(const Mesh& mesh, const Encoded& encoded) {
    const Result<StreamView> view = validate(encoded.bytes());
    REQUIRE_MESSAGE(view, view.error().message);
    check_view_counts(mesh, encoded, *view);
    const std::vector<std::uint32_t> indices = decode(*view);
    REQUIRE(indices.size() == std::size_t{3} * view->triangles());
    check_decoded_triangles(mesh, encoded, indices);
    check_distinct_order(encoded);
    check_copies_of_tables(encoded, view->get<LrStreamView<LrView>>());
    check_copies_of_tables(encoded, view->get<LrStreamView<CompactLrView>>());
    check_threaded_decode(*view, indices);
    check_block_decode(*view, indices);
    check_slot_decode(*view, indices);
    check_16_bit_decode(*view, indices);
    check_refused_arguments(*view);
}

}  // namespace

TEST_CASE("every format decodes to the mesh's triangles: whole, by block and by triangle") {
    for (const test::NamedMesh& named : test::named_meshes()) {
        CAPTURE(named.name);
        for (const Format format : kEveryFormat) {
            CAPTURE(name_of(format));
            const Result<Encoded> encoded =
                encode(named.mesh.indices, named.mesh.vertex_count, {.format = format, .effort = 2});
            REQUIRE_MESSAGE(encoded, encoded.error().message);
            check_stream(named.mesh, *encoded);
        }
    }
}

TEST_CASE("16-bit indices of a mesh of 65,537 vertices are refused") {
    const Mesh mesh = test::random_soup(65537, 3000, 7);
    for (const Format format : kEveryFormat) {
        check_stream(mesh, encode(mesh.indices, mesh.vertex_count, {.format = format, .effort = 0}).value());
    }
}

TEST_CASE("more effort makes no stream larger by over 1 %, and equals the options that it stands for") {
    const Mesh mesh = generate("blob", 20000, 7).value();
    for (const Format format : kEveryFormat) {
        CAPTURE(name_of(format));
        std::size_t before = SIZE_MAX / 101;
        for (const std::uint32_t effort : {0U, 6U, 9U}) {
            const Encoded encoded =
                encode(mesh.indices, mesh.vertex_count, {.format = format, .effort = effort}).value();
            CHECK(100 * encoded.words.size() <= 101 * before);
            before = std::min(before, encoded.words.size());
        }
        const std::size_t triangles = mesh.triangle_count() * (format == Format::packed ? 6 : 1);
        EncodeOptions six{.format = format, .seeds = recommended_seeds(triangles), .passes = passes_at(6, format)};
        if (format == Format::lr_compact) {
            six.seeds = 1;
            six.periods = recommended_periods(mesh.triangle_count());
        }
        six.effort = 1;
        CHECK(encode(mesh.indices, mesh.vertex_count, six)->words ==
              encode(mesh.indices, mesh.vertex_count, {.format = format})->words);
    }
}

TEST_CASE("encode refuses bad arguments, and validate words that are no stream") {
    const std::vector<std::uint32_t> indices{0, 1, 2, 0, 2, 3, 1};
    const auto code = [&](std::size_t count, std::uint32_t vertices, const EncodeOptions& options) {
        return encode(std::span(indices).first(count), vertices, options).error().code;
    };
    CHECK(code(7, 4, {}) == ErrorCode::invalid_argument);
    CHECK(code(6, 3, {}) == ErrorCode::malformed);
    CHECK(code(6, 4, {.effort = 10}) == ErrorCode::invalid_argument);
    CHECK(code(6, 4, {.periods = {1, 2}}) == ErrorCode::invalid_argument);
    CHECK(validate(std::span<const std::uint32_t>{}).error().code == ErrorCode::malformed);
    const Encoded encoded = encode(std::span(indices).first(6), 4).value();
    std::vector<std::byte> bytes(encoded.bytes().begin(), encoded.bytes().end());
    bytes.insert(bytes.begin(), std::byte{0});
    CHECK(validate(std::span(bytes).subspan(1)).error().code == ErrorCode::invalid_argument);
    CHECK(validate(encoded.bytes().first(encoded.bytes().size() - 1)).error().code == ErrorCode::malformed);
}
