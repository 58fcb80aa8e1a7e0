// Normals in storage form are differences from those of the surface: .lr files have to have its positions.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>

#include "lrlab/generate/generate.h"
#include "tests/lrio/lr_files.h"

using namespace lacedring;
using test::Part;

namespace {

/// A sphere around the origin: a position is a normal.
LrFile sphere(const AttributeBits& bits, bool compressed) {
    Mesh mesh = generate("sphere", 2000).value();
    mesh.attributes.push_back({"NORMAL", ComponentType::f32, 3, false, mesh.attributes[0].data});
    LrFile file = make_lr_file(mesh, test::encode_as(Format::packed, mesh), false);
    if (compressed) REQUIRE(compress_attributes(file, bits));
    return file;
}

/// The file with other positions, by the section that `other` has of them.
std::vector<std::byte> with_positions(std::span<const std::byte> file, std::span<const std::byte> other) {
    Part positions;
    test::with_parts(other, [&](detail::FileHeader&, std::vector<Part>& parts) { positions = parts[1]; });
    return test::with_parts(file, [&](detail::FileHeader&, std::vector<Part>& parts) { parts[1] = positions; });
}

}  // namespace

TEST_CASE("stored normals need positions on a lattice, in any form") {
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
    SUBCASE("connectivity last") {
        same_words(test::with_parts(stored, [](detail::FileHeader&, std::vector<Part>& parts) {
            std::rotate(parts.begin(), parts.begin() + 1, parts.end());
        }));
    }
    SUBCASE("positions last: an error, as in every file") {
        CHECK_FALSE(parse_lr(test::with_parts(
            stored, [](detail::FileHeader&, std::vector<Part>& parts) { std::swap(parts[1], parts[2]); })));
    }
    SUBCASE("positions that are no integers of a common scale") {
        for (const bool compressed : {false, true}) {
            const std::vector<std::byte> other = serialize_lr(sphere({}, compressed));
            const Result<LrFile> back = parse_lr(with_positions(stored, other));
            REQUIRE_FALSE(back);
            CHECK(back.error().code == ErrorCode::malformed);
            CHECK(back.error().message.find("positions") != std::string::npos);
        }
    }
    SUBCASE("other positions: other normals, or an error") {
        const LrFile coarse = sphere({.positions = 6}, true);
        const Result<LrFile> back = parse_lr(with_positions(stored, serialize_lr(coarse, LrForm::stored)));
        if (back) CHECK(back->attributes[0].words == coarse.attributes[0].words);
    }
}
