// Compares the bytes of every format with tests/golden: a format must not change without a new version number.
// test_lr_file.cpp does so for .lr files.
//
// Each file holds the words and the vertex order of a stream. After an intended change of a format,
// LACEDRING_WRITE_GOLDEN=1 test_core -tc='golden*' rewrites the files.

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>

#include "lacedring/lacedring.hpp"
#include "lacedring/streams.hpp"
#include "lrlab/generate/generate.h"
#include "tests/support/meshes.h"

using namespace lacedring;

namespace {

using Words = std::vector<std::uint32_t>;

struct Stream {
    Words words, vertex_order;
    bool operator==(const Stream&) const = default;
};

struct GoldenFormat {
    const char* name;
    Stream (*encode)(const CornerTable&);
    Words (*decode)(const Words&);  // validates; returns indices by the stream's vertex numbers
};

template <class Made>
Stream stream_of(Result<Made> encoded) {
    REQUIRE(encoded);
    return {std::move(encoded->words), std::move(encoded->vertex_order)};
}

Words decode_lean(const Words& words) {
    const Result<LeanView> view = validate_lean(words);
    REQUIRE_MESSAGE(view, view.error().message);
    Words out(std::size_t{3} * view->slots());
    lacedring::decode_lean(*view, out);
    return out;
}

Words decode_packed(const Words& words) {
    const Result<PackedView> view = validate_packed(words);
    REQUIRE_MESSAGE(view, view.error().message);
    Words out(std::size_t{3} * view->triangles);
    lacedring::decode_packed(*view, out);
    return out;
}

template <auto validate>
Words decode_tables(const Words& words) {
    const auto stream = validate(words);
    REQUIRE_MESSAGE(stream, stream.error().message);
    return decode_lr(*stream);
}

constexpr std::uint32_t kPeriods[] = {0, 7};

template <PackedProfile profile>
Stream packed_of(const CornerTable& table) {
    Result<PackedChoice> encoded = encode_smallest_packed(table, {}, {.passes = 0}, profile);
    REQUIRE(encoded);
    return {std::move(encoded->stream.words), std::move(encoded->stream.vertex_order)};
}

const GoldenFormat kFormats[] = {
    {"lean", [](const CornerTable& t) { return stream_of(encode_lean(t, expand_rings(t))); }, decode_lean},
    {"lean-no-warts",
     [](const CornerTable& t) { return stream_of(encode_lean(t, expand_rings(t), {.wart_skipping = false})); },
     decode_lean},
    {"packed-small", packed_of<PackedProfile::small>, decode_packed},
    {"packed-cache", packed_of<PackedProfile::cache>, decode_packed},
    {"lr", [](const CornerTable& t) { return stream_of(encode_lr(t, {})); }, decode_tables<validate_lr>},
    {"lr-compact", [](const CornerTable& t) { return stream_of(encode_compact_lr(t, {}, kPeriods)); },
     decode_tables<validate_compact_lr>},
};

struct Sample {
    const char* name;
    Mesh mesh;
};

Mesh both_sides(Mesh mesh) {
    for (std::size_t i = 0, end = mesh.indices.size(); i < end; i += 3) {
        const auto [a, b, c] = std::array{mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]};
        mesh.indices.insert(mesh.indices.end(), {b, a, c});
    }
    return mesh;
}

std::vector<Sample> samples() {
    // A closed mesh of two blocks; borders, non-manifold edges and turned triangles; a soup with degenerate triangles;
    // doubled triangles.
    return {{"blob", generate("blob", 300, 7).value()},
            {"glued", test::random_gluing(40, 120, 11)},
            {"soup", test::random_soup(60, 90, 3)},
            {"sheet", both_sides(generate("blob", 300, 8).value())}};
}

std::filesystem::path path_of(const Sample& sample, const GoldenFormat& format) {
    return std::filesystem::path(GOLDEN_FOLDER) / (std::string(sample.name) + "-" + format.name + ".hex");
}

void write_words(std::ostream& out, const char* title, const Words& words) {
    out << title << ' ' << std::dec << words.size() << std::hex << std::setfill('0');
    for (std::size_t i = 0; i < words.size(); ++i) out << (i % 12 == 0 ? '\n' : ' ') << std::setw(8) << words[i];
    out << '\n';
}

/// Reads the section `title`; a malformed file fails a check.
Words read_words(std::istream& in, const std::string& title) {
    std::string name;
    std::size_t size = 0;
    in >> name >> std::dec >> size >> std::hex;
    CHECK(name == title);
    REQUIRE(size < 100000);
    Words words(size);
    for (std::uint32_t& word : words) in >> word;
    CHECK(in);
    return words;
}

Stream read_golden(const std::filesystem::path& path) {
    std::ifstream file(path);
    REQUIRE(file);
    Stream out;
    out.words = read_words(file, "words");
    out.vertex_order = read_words(file, "vertex_order");
    return out;
}

}  // namespace

TEST_CASE("golden bytes: encoding gives the stored words, and these decode to the stored triangles") {
    const bool write = std::getenv("LACEDRING_WRITE_GOLDEN") != nullptr;
    for (const Sample& sample : samples()) {
        const CornerTable table = build_corner_table(sample.mesh.indices, sample.mesh.vertex_count).value();
        for (const GoldenFormat& format : kFormats) {
            const std::filesystem::path path = path_of(sample, format);
            CAPTURE(path.filename().string());
            const Stream now = format.encode(table);
            if (write) {
                std::ofstream file(path);
                write_words(file, "words", now.words);
                write_words(file, "vertex_order", now.vertex_order);
            }
            const Stream golden = read_golden(path);
            CHECK(now.words == golden.words);
            CHECK(now.vertex_order == golden.vertex_order);
            Words triangles = format.decode(golden.words);
            for (std::uint32_t& v : triangles) v = golden.vertex_order.at(v);
            CHECK(test::oriented_triangles(triangles) == test::oriented_triangles(sample.mesh.indices));
        }
    }
}
