// Normals in storage form are differences from normals of the surface, for which .lr files must have positions.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>

#include "lrlab/generate/generate.h"
#include "tests/lrio/lr_files.h"

using namespace lacedring;
using test::Part;

namespace {

/// A unit sphere around the origin, whose normals are its positions.
LrFile sphere(const AttributeBits& bits, bool compressed) {
    Mesh mesh = generate("sphere", 2000).value();
    mesh.attributes.push_back({"NORMAL", ComponentType::f32, 3, false, mesh.attributes[0].data});
    LrFile file = make_lr_file(mesh, test::encode_as(Format::packed, mesh), false);
    if (compressed) REQUIRE(compress_attributes(file, bits));
    return file;
}

/// `file` with the section of positions of `other`.
std::vector<std::byte> with_positions(std::span<const std::byte> file, std::span<const std::byte> other) {
    Part positions;
    test::with_parts(other, [&](detail::FileHeader&, std::vector<Part>& parts) { positions = parts[1]; });
    return test::with_parts(file, [&](detail::FileHeader&, std::vector<Part>& parts) { parts[1] = positions; });
}

}  // namespace

TEST_CASE("stored normals are restored from positions on a lattice, stored or resident") {
    const LrFile file = sphere({.positions = 14, .normals = 10}, true);
    const std::vector<std::byte> stored = serialize_lr(file, LrForm::stored), resident = serialize_lr(file);
    CHECK(4 * stored.size() < 3 * resident.size());
    const auto same_words = [&](const std::vector<std::byte>& bytes) {
        const Result<LrFile> back = parse_lr(bytes);
        REQUIRE_MESSAGE(back, back.error().message);
        REQUIRE(back->attributes.size() == 2);
        CHECK(back->attributes[0].words == file.attributes[0].words);
        CHECK(back->attributes[1].words == file.attributes[1].words);
    };
    same_words(stored);
    same_words(with_positions(stored, resident));
    SUBCASE("connectivity may be last") {
        same_words(test::with_parts(stored, [](detail::FileHeader&, std::vector<Part>& parts) {
            std::rotate(parts.begin(), parts.begin() + 1, parts.end());
        }));
    }
    SUBCASE("positions behind other attributes are refused, as in every file") {
        CHECK_FALSE(parse_lr(test::with_parts(
            stored, [](detail::FileHeader&, std::vector<Part>& parts) { std::swap(parts[1], parts[2]); })));
    }
    SUBCASE("positions without a lattice are refused") {
        for (const bool compressed : {false, true}) {
            const std::vector<std::byte> other = serialize_lr(sphere({}, compressed));
            const Result<LrFile> back = parse_lr(with_positions(stored, other));
            REQUIRE_FALSE(back);
            CHECK(back.error().code == ErrorCode::malformed);
            CHECK(back.error().message.find("positions") != std::string::npos);
        }
    }
    SUBCASE("other positions give other normals, or are refused") {
        const LrFile coarse = sphere({.positions = 6}, true);
        const Result<LrFile> back = parse_lr(with_positions(stored, serialize_lr(coarse, LrForm::stored)));
        if (back) CHECK(back->attributes[0].words == coarse.attributes[0].words);
    }
}
