// Errors of views and validators name the kind of stream or file that they were given.

#include <doctest/doctest.h>

#include <array>

#include "lacedring/lacedring.hpp"
#include "lacedring/lr_file.hpp"
#include "lacedring/streams.hpp"
#include "lrcore/base/signature.h"
#include "tests/support/meshes.h"

using namespace lacedring;

namespace {

std::span<const std::byte> bytes_of(std::string_view text) {
    return std::as_bytes(std::span(text));
}

struct Kind {
    std::string name;    // in "this is NAME"
    std::string wanted;  // in "not WANTED"
    std::vector<std::uint32_t> words;
    std::string (*view)(std::span<const std::uint32_t>);
    std::string (*validate)(std::span<const std::uint32_t>);
};

/// The error message of function(words); empty if it accepts the words.
template <auto function>
std::string said(std::span<const std::uint32_t> words) {
    const auto result = function(words);
    return result ? "" : result.error().message;
}

std::array<Kind, 4> kinds() {
    const Mesh mesh = test::random_gluing(20, 40, 1);
    const CornerTable table = build_corner_table(mesh.indices, mesh.vertex_count).value();
    const Rings rings = expand_rings(table);
    const std::uint32_t period = 0;
    return {{{"a lean stream", "a lean stream", encode_lean(table, rings)->words, said<view_lean>, said<validate_lean>},
             {"a packed stream", "a packed stream", encode_packed(table, rings)->words, said<view_packed>,
              said<validate_packed>},
             {"LR tables", "standard LR tables", encode_lr(table, {})->words, said<view_lr>, said<validate_lr>},
             {"bit-efficient LR tables", "bit-efficient LR tables",
              encode_compact_lr(table, {}, std::span(&period, 1))->words, said<view_compact_lr>,
              said<validate_compact_lr>}}};
}

}  // namespace

TEST_CASE("an error names the kind of stream that was given") {
    const auto all = kinds();
    for (const Kind& wanted : all) {
        for (const Kind& given : all) {
            CAPTURE(wanted.name);
            CAPTURE(given.name);
            CHECK(wanted.view(given.words) == wanted.validate(given.words));
            if (&wanted == &given) {
                CHECK(wanted.view(given.words) == "");
                continue;
            }
            const std::string is = given.name.starts_with("a ") ? "this is " : "these are ";
            CHECK(wanted.view(given.words).ends_with(": " + is + given.name + ", not " + wanted.wanted));
        }
        std::vector<std::uint32_t> unknown = wanted.words;
        unknown[0] = 0x12345678;
        CHECK(wanted.view(unknown).ends_with(": wrong magic number"));
    }
    CHECK(all[1].validate(all[2].words) == "packed stream: these are LR tables, not a packed stream");
}

TEST_CASE(
    "an error names the kind of file that was given instead of words, and of words or meshes instead of an .lr file") {
    const auto all = kinds();
    LrFile file;
    file.words = all[0].words;
    std::vector<std::byte> bytes = serialize_lr(file);
    bytes.resize(bytes.size() / 4 * 4);
    const std::span<const std::uint32_t> words(reinterpret_cast<const std::uint32_t*>(bytes.data()), bytes.size() / 4);
    for (const Kind& wanted : all) CHECK(wanted.view(words).ends_with(": this is an .lr file, not " + wanted.wanted));
    const std::string_view ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nend_header\n";
    std::vector<std::uint32_t> text(ply.size() / 4);
    std::copy_n(ply.begin(), 4 * text.size(), reinterpret_cast<char*>(text.data()));
    CHECK(all[0].view(text) == "lean stream: this is a PLY file, not a lean stream");

    const auto parsed = [](std::span<const std::byte> given) { return parse_lr(given).error().message; };
    CHECK(parsed(bytes_of(ply)) == "not an .lr file: it looks like a PLY file");
    CHECK(parsed(std::as_bytes(std::span(all[2].words))) == "not an .lr file: it looks like LR tables");
    CHECK(parsed(bytes_of("hello\n")) == "not an .lr file");
    CHECK(parsed({}) == "not an .lr file");
    CHECK(parsed(bytes_of("LRFL")) == "lr file: shorter than its header");
    CHECK(view_lr_file(bytes_of("v 0 0 0\n")).error().message == "not an .lr file: it looks like an OBJ file");
}

TEST_CASE("the kind of a file is found by its first 4 KiB") {
    const auto kind = [](std::string_view text) { return kind_by_signature(bytes_of(text)); };
    CHECK(kind("glTF\2\0\0\0") == "a GLB file");
    CHECK(kind("  { \"asset\": {} }") == "a glTF file");
    CHECK(kind("ply\r\nformat") == "a PLY file");
    CHECK(kind("COFF\n3 1 0\n") == "an OFF file");
    CHECK(kind("# made by hand\n\nOFF\n") == "an OFF file");
    CHECK(kind("solid thing\n") == "an STL file");
    CHECK(kind("# a comment\n# another\nmtllib a.mtl\n") == "an OBJ file");
    CHECK(kind("vn 0 0 1") == "an OBJ file");
    CHECK(kind("# nothing else") == "");
    CHECK(kind("#") == "");
    CHECK(kind("") == "");
    CHECK(kind("PK\3\4") == "");
    std::string stl(84 + 2 * 50, '\1');
    stl[80] = 2;
    stl[81] = stl[82] = stl[83] = 0;
    CHECK(kind(stl) == "an STL file");
    CHECK_MESSAGE(kind(std::string(5000, '#') + "\nOFF\n") == "", "OFF beyond the first 4 KiB");
}
