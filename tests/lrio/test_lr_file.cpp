#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "lrlab/generate/generate.h"
#include "tests/lrio/lr_files.h"
#include "tests/support/capture.h"
#include "tests/support/damage.h"

using namespace lacedring;

namespace {

LrFile make(const Mesh& mesh, bool keep_order, Format format = Format::lean) {
    return make_lr_file(mesh, test::encode_as(format, mesh), keep_order);
}

/// A mesh with attributes of several types, whose values all differ.
Mesh with_attributes() {
    Mesh mesh = test::random_gluing(40, 80, 5);
    Attribute color{"COLOR_0", ComponentType::u8, 3, true, {}};  // rows of three bytes have no padding
    Attribute weight{"weight", ComponentType::f64, 1, false, {}};
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        for (std::uint32_t k = 0; k < 3; ++k) color.data.push_back(static_cast<std::byte>(v * 3 + k));
        const double w = 0.1 * v;
        const auto* bytes = reinterpret_cast<const std::byte*>(&w);
        weight.data.insert(weight.data.end(), bytes, bytes + sizeof w);
    }
    mesh.attributes.push_back(std::move(color));
    weight.v_up = true;
    mesh.attributes.push_back(std::move(weight));
    return mesh;
}

}  // namespace

TEST_CASE("lr files of every format decode to the mesh") {
    for (const auto& [name, mesh] : test::named_meshes()) {
        CAPTURE_COPY(name);
        for (const Format format : test::kFormats) {
            CAPTURE(static_cast<int>(format));
            const Result<LrFile> file = parse_lr(serialize_lr(make(mesh, true, format)));
            REQUIRE_MESSAGE(file, file.error().message);
            test::check_same_mesh(decode_lr_original_order(*file), mesh);
            CHECK(decode_lr(*file)->vertex_count == mesh.vertex_count);
        }
    }
}

TEST_CASE("attributes of every type are decoded bit for bit") {
    const Mesh mesh = with_attributes();
    const Result<LrFile> file = parse_lr(serialize_lr(make(mesh, true)));
    REQUIRE(file);
    test::check_same_mesh(decode_lr_original_order(*file), mesh);
    CHECK_FALSE(decode_lr_original_order(make(mesh, false)));
}

namespace {

/// with_attributes() and normals.
Mesh with_normals() {
    Mesh mesh = with_attributes();
    Attribute normal{"NORMAL", ComponentType::f32, 3, false, {}};
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        const float values[3] = {0.6F, v % 2 == 0 ? 0.8F : -0.8F, 0};
        const auto bytes = std::as_bytes(std::span(values));
        normal.data.insert(normal.data.end(), bytes.begin(), bytes.end());
    }
    mesh.attributes.push_back(std::move(normal));
    return mesh;
}

void check_compress_report(LrFile& file) {
    INFO("the report has the error of quantized attributes and the reason why others are exact");
    const auto report = compress_attributes(file, {.positions = 12, .normals = 8, .colors = 4});
    REQUIRE_MESSAGE(report, report.error().message);
    REQUIRE(report->size() == 4);
    CHECK((*report)[0].largest_error > 0);
    CHECK((*report)[1].exact == "its values are integers");
    CHECK((*report)[2].exact.empty());
    CHECK((*report)[3].largest_error < 0.02);
}

void check_compressed_attributes(const Mesh& mesh, const Mesh& decoded, const LrFileView& view) {
    REQUIRE(decoded.attributes.size() == 4);
    for (std::size_t a = 0; a < 4; ++a) {
        const Attribute &attribute = decoded.attributes[a], &original = mesh.attributes[a];
        INFO("attribute ", original.name);
        CHECK(attribute.name == original.name);
        CHECK(attribute.type == original.type);
        CHECK(attribute.normalized == original.normalized);
        CHECK(attribute.v_up == original.v_up);
        CHECK(view.attributes[a].type == original.type);
        const Result<VertexView> stream = view_vertices(view.attributes[a].words);
        REQUIRE(stream);
        if (stream->largest_error == 0) CHECK_MESSAGE(attribute.data == original.data, "exact values bit for bit");
    }
}

/// Checks a file of compressed attributes: its contents, its mesh, and that flipped bits are refused.
void check_compressed_file(const Mesh& mesh, const std::vector<std::byte>& bytes) {
    const Result<LrFile> read = parse_lr(bytes);
    REQUIRE_MESSAGE(read, read.error().message);
    CHECK_MESSAGE(serialize_lr(*read) == bytes, "a parsed file is written unchanged");
    const Result<LrContents> listed = list_lr(bytes);
    REQUIRE(listed);
    CHECK(std::ranges::count(listed->sections, "vertices", &LrSection::kind) == 4);
    const Result<LrFileView> view = view_lr_file(bytes);
    REQUIRE(view);
    CHECK_MESSAGE(view->positions().size() == 0, "compressed positions are not viewed in place");
    const Result<Mesh> back = decode_lr_original_order(*read);
    REQUIRE(back);
    CHECK(back->indices == test::indices_of_kept(mesh));
    check_compressed_attributes(mesh, *back, *view);
    test::for_each_flip(
        bytes, [](const auto& bad, std::size_t) { CHECK_FALSE(parse_lr(bad)); }, 1);
}

}  // namespace

TEST_CASE("compressed attributes are decoded, bit for bit where they were not quantized") {
    for (std::size_t f = 0; f < 2 * std::size(test::kFormats); ++f) {
        const Format format = test::kFormats[f / 2];
        const bool quantized = f % 2 != 0;
        CAPTURE(static_cast<int>(format));
        CAPTURE(quantized);
        const Mesh mesh = with_normals();
        LrFile file = make(mesh, true, format);
        const std::size_t raw = serialize_lr(file).size();
        if (quantized) {
            check_compress_report(file);
        } else {
            REQUIRE(compress_attributes(file));
        }
        const std::vector<std::byte> bytes = serialize_lr(file);
        // The headers of vertex streams are larger than the savings of so small a mesh.
        CHECK(bytes.size() < raw + 300);
        check_compressed_file(mesh, bytes);
    }
}

namespace {

void check_viewed_attribute(const AttributeView& viewed, const Attribute& attribute, std::span<const std::byte> file) {
    INFO("attribute ", attribute.name);
    CHECK(viewed.name == attribute.name);
    CHECK(viewed.type == attribute.type);
    CHECK(viewed.components == attribute.components);
    CHECK(viewed.normalized == attribute.normalized);
    CHECK(viewed.v_up == attribute.v_up);
    CHECK(std::ranges::equal(viewed.data, attribute.data));
    INFO("its values are in the file's memory");
    CHECK(viewed.data.data() >= file.data());
    CHECK(viewed.data.data() + viewed.data.size() <= file.data() + file.size());
}

}  // namespace

TEST_CASE("a view of a file in memory equals the parsed file, without a copy") {
    for (const Format format : test::kFormats) {
        CAPTURE(static_cast<int>(format));
        const LrFile file = make(with_attributes(), true, format);
        const std::vector<std::byte> bytes = serialize_lr(file);
        const Result<LrFileView> view = view_lr_file(bytes);
        REQUIRE(view);
        CHECK(view->format == format);
        CHECK(view->vertex_count == file.vertex_count);
        CHECK(view->input_triangles == file.input_triangles);
        CHECK(std::ranges::equal(view->words, file.words));
        CHECK(std::ranges::equal(view->vertex_order, file.vertex_order));
        CHECK(std::ranges::equal(view->corner_order, file.corner_order));
        REQUIRE(view->attributes.size() == file.attributes.size());
        for (std::size_t i = 0; i < file.attributes.size(); ++i) {
            check_viewed_attribute(view->attributes[i], file.attributes[i], bytes);
        }
        CHECK(view->validate());
        CHECK(view->positions().size() == file.vertex_count);
        // The allocation is aligned to 8 bytes, and so the copy is not.
        std::vector<std::byte> moved(bytes.size() + 4);
        std::ranges::copy(bytes, moved.begin() + 4);
        CHECK_MESSAGE(view_lr_file(std::span(moved).subspan(4)).error().code == ErrorCode::invalid_argument,
                      "bytes that are not aligned to 8 are refused");
    }
}

TEST_CASE("every truncation and every flipped bit of an lr file is refused") {
    Format format = Format::lean;
    SUBCASE("lean") {}
    SUBCASE("lr") {
        format = Format::lr;
    }
    SUBCASE("lr-compact") {
        format = Format::lr_compact;
    }
    const std::vector<std::byte> good = serialize_lr(make(with_attributes(), true, format));
    REQUIRE(parse_lr(good));
    const Result<LrFileView> words = view_lr_file(good);
    REQUIRE(words);
    CHECK(words->format == format);
    CHECK(std::ranges::equal(words->words, make(with_attributes(), true, format).words));
    test::for_each_cut(good, [](auto cut) { CHECK_FALSE(parse_lr(cut)); });
    std::vector<std::byte> bad = good;
    bad.push_back(std::byte{0});
    CHECK_FALSE(parse_lr(bad));
    test::for_each_flip(
        good, [](const auto& flipped, std::size_t) { CHECK_FALSE(parse_lr(flipped)); }, 1);
}

TEST_CASE("golden bytes: lr files have the stored bytes, and these decode to the mesh") {
    const Mesh mesh = with_attributes();
    const char* names[] = {"lean", "lr", "lr-compact", "packed"};
    for (std::size_t f = 0; f < std::size(names); ++f) {
        const std::vector<std::byte> bytes =
            test::check_golden(std::string(GOLDEN_FOLDER) + "/file-" + names[f] + ".hex",
                               serialize_lr(make(mesh, true, test::kFormats[f])));
        const Result<LrFile> read = parse_lr(bytes);
        REQUIRE_MESSAGE(read, read.error().message);
        test::check_same_mesh(decode_lr_original_order(*read), mesh);
    }
}

TEST_CASE("lr files with bad contents and valid checksums are refused") {
    LrFile file = make(with_attributes(), true);
    SUBCASE("a position that is not finite") {
        const float nan = std::numeric_limits<float>::quiet_NaN();
        std::memcpy(file.attributes[0].data.data() + 8, &nan, sizeof nan);
    }
    SUBCASE("no positions") {
        file.attributes.erase(file.attributes.begin());
    }
    SUBCASE("an attribute too short") {
        file.attributes[1].data.pop_back();
    }
    SUBCASE("a vertex twice in the order") {
        file.vertex_order[0] = file.vertex_order[1];
    }
    SUBCASE("a triangle twice in the order") {
        file.corner_order[0] = (file.corner_order[1] + 1) % 3 + file.corner_order[1] / 3 * 3;
    }
    SUBCASE("a triangle number beyond the input's triangles") {
        file.corner_order[0] = 3 * file.input_triangles;
    }
    SUBCASE("four billion input triangles, and a triangle twice in the order") {
        file.input_triangles = UINT32_MAX;
        file.corner_order[0] = (file.corner_order[1] + 1) % 3 + file.corner_order[1] / 3 * 3;
    }
    SUBCASE("more triangles than the input") {
        file.input_triangles = 3;
    }
    SUBCASE("another vertex count") {
        ++file.vertex_count;
    }
    SUBCASE("no connectivity stream") {
        file.words.clear();
    }
    SUBCASE("another format's words") {
        file.format = Format::lr;
    }
    CHECK_FALSE(parse_lr(serialize_lr(file)));
}

TEST_CASE("files in storage form are restored bit for bit; a file that parse_lr would refuse has no storage form") {
    LrFile file = make(generate("blob", 2000).value(), true, Format::packed);
    REQUIRE(compress_attributes(file, {.positions = 14}));
    const std::vector<std::byte> resident = serialize_lr(file), stored = serialize_lr(file, LrForm::stored);
    CHECK(stored.size() < resident.size());
    CHECK(view_lr_file(resident));
    CHECK(view_lr_file(stored).error().code == ErrorCode::unsupported);
    CHECK(serialize_lr(parse_lr(stored).value()) == resident);
    CHECK(parse_lr(stored, 1000).error().code == ErrorCode::memory_limit);

    // Most of the input's triangles were degenerate.
    file.input_triangles = 10'000'000;
    CHECK(serialize_lr(file, LrForm::stored) == serialize_lr(file));
    CHECK(parse_lr(serialize_lr(file, LrForm::stored)));
    file.input_triangles = 8'000'000;
    CHECK(parse_lr(serialize_lr(file, LrForm::stored)));
    CHECK(serialize_lr(file, LrForm::stored).size() == stored.size());
}
