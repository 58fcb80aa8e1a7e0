// Packs and unpacks small scenes.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/lrio/scene_files.h"
#include "tests/support/capture.h"

using namespace lacedring;
using nlohmann::json;
using test::GltfMaker;
using test::GridScene;

namespace {

/// The document without buffers and buffer views, and references to these.
json placeless(const std::string& glb) {
    json out = test::document_of(glb);
    out.erase("buffers");
    out.erase("bufferViews");
    for (json& accessor : out["accessors"]) {
        accessor.erase("bufferView");
        accessor.erase("byteOffset");
    }
    return out;
}

/// A scene with a fallback as a reader without the extension sees it.
std::string without_extension(const std::string& glb) {
    json document = test::document_of(glb);
    const std::string name = "LACEDRING_mesh_compression";
    std::uint32_t size = 0;
    std::memcpy(&size, glb.data() + 12, 4);
    document.erase("extensionsUsed");
    document["extensions"].erase(name);
    for (json& mesh : document["meshes"]) {
        for (json& primitive : mesh["primitives"]) {
            if (primitive.contains("extensions")) primitive["extensions"].erase(name);
        }
    }
    return test::glb(document.dump(), glb.substr(28 + size));
}

/// Packs and unpacks a scene with all lossless options, and checks that the triangles are the same, in order with
/// keep_order. `same_document`: the document must be the same, too.
void check_scene(const std::string& glb, std::size_t primitives, bool same_document = true) {
    const Mesh mesh = test::mesh_of_glb(glb);
    for (const auto& [name, options] : test::lossless_ways()) {
        CAPTURE_COPY(name);
        PackReport packed_report;
        const std::string packed = test::glb_of(test::must_pack(glb, options, &packed_report));
        CHECK(is_packed_scene(test::bytes_of(packed)));
        CHECK(packed_report.primitives == primitives);
        CHECK(packed_report.max_error.empty());
        const auto again = pack_scene(test::bytes_of(packed), {}, options);
        REQUIRE_MESSAGE(!again, "a packed scene is not packed again");
        CHECK(again.error().code == ErrorCode::unsupported);
        UnpackReport unpacked_report;
        const std::string unpacked = test::glb_of(test::must_unpack(packed, &unpacked_report));
        CHECK_FALSE(is_packed_scene(test::bytes_of(unpacked)));
        CHECK(unpacked_report.primitives == primitives);
        CHECK(unpacked_report.triangles == packed_report.triangles);
        const Mesh back = test::mesh_of_glb(unpacked);
        CHECK_MESSAGE(test::same_triangles(back, mesh), "the triangles are the same");
        if (options.keep_order) CHECK_MESSAGE(test::same(back, mesh), "keep_order keeps vertices and triangles");
        if (options.fallback) {
            CHECK_MESSAGE(test::same(test::mesh_of_glb(without_extension(packed)), back),
                          "the fallback is the unpacked mesh");
        }
        if (same_document) CHECK_MESSAGE(placeless(unpacked) == placeless(glb), "the document is the same");
        INFO("an unpacked scene is unpacked unchanged");
        const std::string once_more = test::glb_of(test::must_unpack(unpacked));
        CHECK(test::same(test::mesh_of_glb(once_more), back));
        CHECK(placeless(once_more) == placeless(unpacked));
    }
}

}  // namespace

TEST_CASE("scenes with indices of every type are unpacked as they were, with their document") {
    GltfMaker maker;
    const GridScene small(5, 0), middle(20, 10), large(6, 40);
    std::string primitives;
    const auto add = [&](const GridScene& grid, int component_type, const auto& indices) {
        const int positions = test::add_rows(maker, 5126, "VEC3", grid.positions, 3, 0, grid.bounds);
        const int texcoords = test::add_rows(maker, 5126, "VEC2", grid.texcoords, 2);
        const int list = test::add_rows(maker, component_type, "SCALAR", indices, 1);
        primitives += fmt::format(R"({}{{"attributes":{{"TEXCOORD_0":{},"POSITION":{}}},"indices":{},"extras":[1e2]}})",
                                  primitives.empty() ? "" : ",", texcoords, positions, list);
    };
    add(small, 5121, small.indices_as<std::uint8_t>());
    add(middle, 5123, middle.indices_as<std::uint16_t>());
    add(large, 5125, large.indices);
    check_scene(maker.glb_file(test::mesh_of(primitives, test::one_node) + R"(,"extras":{"a":1.50,"b":"\u00e9"})"), 3);
}

TEST_CASE("integer positions are unpacked as integers") {
    for (const bool normalized : {false, true}) {
        CAPTURE(normalized);
        GltfMaker maker;
        const GridScene grid(9, 0);
        std::vector<std::int16_t> positions;
        for (const float x : grid.positions) positions.push_back(static_cast<std::int16_t>(1000 * x - 4000));
        const std::string more = normalized ? R"(,"normalized":true)" : "";
        const int at = test::add_rows(maker, 5122, "VEC3", positions, 3, 8, more);
        const int list = test::add_rows(maker, 5123, "SCALAR", grid.indices_as<std::uint16_t>(), 1);
        const std::string rest = test::mesh_of(
            fmt::format(R"({{"attributes":{{"POSITION":{}}},"indices":{}}})", at, list),
            R"("extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"],)"
            R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"scale":[0.5,0.5,0.5],"translation":[1,2,3]}],)");
        const std::string glb = maker.glb_file(rest);
        check_scene(glb, 1, false);
        const json accessor = test::document_of(test::glb_of(test::must_unpack(
            test::glb_of(test::must_pack(glb, test::lossless())))))["accessors"][static_cast<std::size_t>(at)];
        CHECK(accessor["componentType"] == 5122);
        CHECK(accessor.value("normalized", false) == normalized);
    }
}

TEST_CASE("attributes with padding between rows are unpacked without it") {
    GltfMaker maker;
    const GridScene grid(8, -3);
    const std::vector<std::uint8_t> colors = grid.indices_as<std::uint8_t>();
    const int positions = test::add_rows(maker, 5126, "VEC3", grid.positions, 3, 20, grid.bounds);
    const int texcoords = test::add_rows(maker, 5126, "VEC2", grid.texcoords, 2, 12);
    const int color = test::add_rows(maker, 5121, "VEC3", std::vector(colors.begin(), colors.begin() + 192), 3, 4,
                                     R"(,"normalized":true)");
    const int list = test::add_rows(maker, 5121, "SCALAR", grid.indices_as<std::uint8_t>(), 1);
    check_scene(maker.glb_file(test::mesh_of(
                    fmt::format(R"({{"attributes":{{"POSITION":{},"TEXCOORD_0":{},"COLOR_0":{}}},"indices":{}}})",
                                positions, texcoords, color, list),
                    test::one_node)),
                1);
}

TEST_CASE("primitives without indices, strips and fans are unpacked as triangles") {
    GltfMaker maker;
    const GridScene grid(7, 0);
    std::vector<float> corners;  // three positions per triangle
    for (const std::uint32_t v : grid.indices) {
        corners.insert(corners.end(), grid.positions.begin() + 3 * v, grid.positions.begin() + 3 * v + 3);
    }
    const int plain = test::add_rows(maker, 5126, "VEC3", corners, 3);
    const int vertices = test::add_rows(maker, 5126, "VEC3", grid.positions, 3);
    const int strip = test::add_rows(maker, 5123, "SCALAR", std::vector<std::uint16_t>{0, 7, 1, 8, 2, 9, 9, 10, 3}, 1);
    const int fan = test::add_rows(maker, 5121, "SCALAR", std::vector<std::uint8_t>{24, 30, 31, 32, 25, 18}, 1);
    const std::string primitives =
        fmt::format(R"({{"attributes":{{"POSITION":{}}}}},{{"attributes":{{"POSITION":{}}},"indices":{},"mode":5}},)"
                    R"({{"attributes":{{"POSITION":{}}},"indices":{},"mode":6}})",
                    plain, vertices, strip, vertices, fan);
    const std::string glb = maker.glb_file(test::mesh_of(primitives, test::one_node));
    const Mesh mesh = test::mesh_of_glb(glb);
    for (const auto& [name, options] : test::lossless_ways()) {
        CAPTURE_COPY(name);
        PackReport report;
        const std::string packed = test::glb_of(test::must_pack(glb, options, &report));
        CHECK(report.primitives == 3);
        const std::string unpacked = test::glb_of(test::must_unpack(packed));
        CHECK(test::same_triangles(test::mesh_of_glb(unpacked), mesh));
        const json document = test::document_of(unpacked);
        for (const json& primitive : document["meshes"][0]["primitives"]) {
            CHECK(primitive.value("mode", 4) == 4);
            CHECK(primitive.contains("indices"));
        }
    }
}

TEST_CASE("primitives still share vertices after unpacking, and morph targets keep their vertices") {
    GltfMaker maker;
    const GridScene grid(12, 0);
    std::vector<float> moved;
    for (std::size_t i = 0; i < grid.positions.size(); ++i) moved.push_back(static_cast<float>(i % 7) * 0.125F);
    const int positions = test::add_rows(maker, 5126, "VEC3", grid.positions, 3, 0, grid.bounds);
    const int target = test::add_rows(maker, 5126, "VEC3", moved, 3, 0, R"(,"min":[0,0,0],"max":[0.75,0.75,0.75])");
    const std::vector<std::uint16_t> all = grid.indices_as<std::uint16_t>();
    std::string primitives;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto begin = all.begin() + static_cast<std::ptrdiff_t>(i * all.size() / 3 / 3 * 3);
        const auto end = all.begin() + static_cast<std::ptrdiff_t>((i + 1) * all.size() / 3 / 3 * 3);
        const int list = test::add_rows(maker, 5123, "SCALAR", std::vector<std::uint16_t>(begin, end), 1);
        primitives += fmt::format(
            R"({}{{"attributes":{{"POSITION":{}}},"targets":[{{"POSITION":{}}}],"indices":{},"material":{}}})",
            i == 0 ? "" : ",", positions, target, list, i);
    }
    check_scene(maker.glb_file(test::mesh_of(primitives, R"("materials":[{},{},{"name":"c"}],)" + test::one_node)), 3);
}

TEST_CASE("a scene with nothing to compress is unpacked as it was") {
    GltfMaker maker;
    const GridScene grid(4, 0);
    const int positions = test::add_rows(maker, 5126, "VEC3", grid.positions, 3, 0, grid.bounds);
    const std::string points = maker.glb_file(
        test::mesh_of(fmt::format(R"({{"attributes":{{"POSITION":{}}},"mode":0}})", positions), test::one_node));
    const std::string empty = test::glb(R"({"asset":{"version":"2.0"},"scenes":[{}],"scene":0})", "");
    for (const std::string& glb : {points, empty}) {
        for (const auto& [name, options] : test::lossless_ways()) {
            CAPTURE_COPY(name);
            PackReport report;
            const std::string packed = test::glb_of(test::must_pack(glb, options, &report));
            CHECK(report.primitives == 0);
            CHECK(report.triangles == 0);
            const std::string unpacked = test::glb_of(test::must_unpack(packed));
            CHECK(placeless(unpacked) == placeless(glb));
            if (glb == empty) continue;
            const json document = test::document_of(unpacked);
            const json& view = document["bufferViews"][document["accessors"][0]["bufferView"].get<std::size_t>()];
            const std::string bin = unpacked.substr(unpacked.find(std::string("BIN\0", 4)) + 4);
            CHECK(std::memcmp(bin.data() + view.value("byteOffset", 0), grid.positions.data(),
                              4 * grid.positions.size()) == 0);
        }
    }
}

TEST_CASE("packing loses at most the error that it reports") {
    GltfMaker maker;
    const GridScene grid(15, 100);
    std::vector<float> normals;
    for (std::size_t i = 0; i < grid.positions.size() / 3; ++i) {
        const double a = 0.1 * static_cast<double>(i);
        normals.insert(normals.end(), {static_cast<float>(std::sin(a)), 0, static_cast<float>(std::cos(a))});
    }
    const int positions = test::add_rows(maker, 5126, "VEC3", grid.positions, 3, 0, grid.bounds);
    const int normal = test::add_rows(maker, 5126, "VEC3", normals, 3);
    const int texcoords = test::add_rows(maker, 5126, "VEC2", grid.texcoords, 2);
    const int list = test::add_rows(maker, 5125, "SCALAR", grid.indices, 1);
    const std::string glb = maker.glb_file(
        test::mesh_of(fmt::format(R"({{"attributes":{{"POSITION":{},"NORMAL":{},"TEXCOORD_0":{}}},"indices":{}}})",
                                  positions, normal, texcoords, list),
                      test::one_node));
    PackOptions options;
    options.keep_order = true;  // to compare values one by one
    PackReport report;
    const std::string packed = test::glb_of(test::must_pack(glb, options, &report));
    const Mesh before = test::mesh_of_glb(glb), after = test::mesh_of_glb(test::glb_of(test::must_unpack(packed)));
    CHECK(after.indices == before.indices);
    for (const char* name : {"POSITION", "NORMAL", "TEXCOORD_0"}) {
        CAPTURE(std::string(name));
        REQUIRE(report.max_error.contains(name));
        const auto x = test::values_of<float>(before, name), y = test::values_of<float>(after, name);
        REQUIRE(x.size() == y.size());
        double largest = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            largest = std::max(largest, std::abs(static_cast<double>(x[i]) - static_cast<double>(y[i])));
        }
        CHECK(largest > 0);
        CHECK(largest <= report.max_error[name] * (1 + 1e-6));
    }
    // Half a step of 14 bits along the extent, rounded up.
    CHECK(report.max_error["POSITION"] <= 14.0 / (1 << 14));
    INFO("packing the unpacked scene again loses nothing more");
    const std::string unpacked = test::glb_of(test::must_unpack(packed));
    CHECK(test::same(
        test::mesh_of_glb(test::glb_of(test::must_unpack(test::glb_of(test::must_pack(unpacked, options))))), after));
}

TEST_CASE("a packed scene in several files is unpacked") {
    GltfMaker maker;
    const GridScene grid(6, 0);
    const int positions = test::add_rows(maker, 5126, "VEC3", grid.positions, 3, 0, grid.bounds);
    const int list = test::add_rows(maker, 5125, "SCALAR", grid.indices, 1);
    const std::string glb = maker.glb_file(test::mesh_of(
        fmt::format(R"({{"attributes":{{"POSITION":{}}},"indices":{}}})", positions, list), test::one_node));
    PackOptions options = test::lossless();
    options.bin_uri = "scene.bin";
    options.fallback_uri = "scene.fallback.bin";
    options.fallback = true;
    const SceneFile packed = test::must_pack(glb, options);
    const auto text = [](const std::vector<std::byte>& bytes) {
        return std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    };
    const auto path = test::write_text("scene.gltf", packed.json);
    test::write_text("scene.bin", text(packed.bin));
    // The file of the fallback is not written: unpacking must not open it.
    CHECK_FALSE(packed.fallback.empty());
    const auto unpacked = unpack_scene(test::bytes_of(packed.json), path);
    REQUIRE_MESSAGE(unpacked, unpacked.error().message);
    CHECK(test::same_triangles(test::mesh_of_glb(test::glb_of(*unpacked)), test::mesh_of_glb(glb)));
    // Unpacking with and without a fallback gives the same bytes.
    options.fallback = false;
    options.json = SceneJson::plain;
    const auto bare = unpack_scene(test::bytes_of(test::must_pack(glb, options).json), path);
    REQUIRE_MESSAGE(bare, bare.error().message);
    CHECK(bare->bin == unpacked->bin);

    options.fallback = true;
    options.json = SceneJson::packed;
    const auto refused = [&] {
        const auto result = pack_scene(test::bytes_of(glb), {}, options);
        return !result && result.error().code == ErrorCode::invalid_argument;
    };
    CHECK(refused());
    options.bin_uri = options.fallback_uri = "";
    CHECK(refused());
    options.fallback = false;
    CHECK_FALSE(refused());
}

TEST_CASE("accessors and flags that differ from the stream are refused") {
    GltfMaker maker;
    const GridScene grid(6, 0);
    const std::vector<std::uint8_t> colors(108, 9);
    const int positions = test::add_rows(maker, 5126, "VEC3", grid.positions, 3);
    const int color = test::add_rows(maker, 5121, "VEC3", colors, 3, 4, R"(,"normalized":true)");
    const int list = test::add_rows(maker, 5125, "SCALAR", grid.indices, 1);
    const std::string glb = maker.glb_file(test::mesh_of(
        fmt::format(R"({{"attributes":{{"POSITION":{},"COLOR_0":{}}},"indices":{}}})", positions, color, list),
        test::one_node));
    for (const bool keep_order : {false, true}) {
        PackOptions options = test::lossless();
        options.keep_order = keep_order;
        options.json = SceneJson::plain;
        const SceneFile packed = test::must_pack(glb, options);
        const std::string bin(reinterpret_cast<const char*>(packed.bin.data()), packed.bin.size());
        const auto accepted = [&](const char* pointer, const json& value) {
            json document = json::parse(packed.json);
            document[json::json_pointer(pointer)] = value;
            return unpack_scene(test::bytes_of(test::glb(document.dump(), bin)), {}).has_value();
        };
        const char* ordered = "/extensions/LACEDRING_mesh_compression/streams/0/ordered";
        CAPTURE(keep_order);
        CHECK(accepted(ordered, keep_order));
        CHECK_FALSE(accepted(ordered, !keep_order));
        CHECK_FALSE(accepted(ordered, 1));
        CHECK_FALSE(accepted(ordered, "true"));
        CHECK(accepted("/accessors/1/normalized", true));
        CHECK_FALSE(accepted("/accessors/1/normalized", false));
        CHECK(accepted("/accessors/1/type", "VEC3"));
        CHECK_FALSE(accepted("/accessors/1/type", "VEC4"));
        CHECK_FALSE(accepted("/accessors/1/componentType", 5123));
        CHECK(accepted("/accessors/0/count", 36));
        CHECK_FALSE(accepted("/accessors/0/count", 35));
        CHECK_FALSE(accepted("/accessors/2/count", 147));
        CHECK_FALSE(accepted("/accessors/2/type", "VEC3"));
        for (const int type : {5121, 5123, 5125}) CHECK(accepted("/accessors/2/componentType", type));
        for (const int type : {0, 5120, 5122, 5124, 5126}) CHECK_FALSE(accepted("/accessors/2/componentType", type));
    }
}

TEST_CASE("indices are unpacked in the document's type, or refused if they do not fit it") {
    for (const std::uint32_t first : {0U, 254U}) {
        GltfMaker maker;
        const GridScene grid(20, 0);
        const int positions = test::add_rows(maker, 5126, "VEC3", grid.positions, 3);
        const int all = test::add_rows(maker, 5125, "SCALAR", grid.indices, 1);
        // keep_order keeps these indices. 255 does not fit a byte: it is the value that restarts primitives.
        const int few = test::add_rows(maker, 5125, "SCALAR", std::vector<std::uint32_t>{first, first + 1, 20}, 1);
        PackOptions options = test::lossless();
        options.keep_order = true;
        options.json = SceneJson::plain;
        const SceneFile packed = test::must_pack(
            maker.glb_file(test::mesh_of(fmt::format(R"({{"attributes":{{"POSITION":{}}},"indices":{}}},)"
                                                     R"({{"attributes":{{"POSITION":{}}},"indices":{}}})",
                                                     positions, all, positions, few),
                                         test::one_node)),
            options);
        json document = json::parse(packed.json);
        document["accessors"][static_cast<std::size_t>(few)]["componentType"] = 5121;
        const std::string bin(reinterpret_cast<const char*>(packed.bin.data()), packed.bin.size());
        const auto unpacked = unpack_scene(test::bytes_of(test::glb(document.dump(), bin)), {});
        CHECK(unpacked.has_value() == (first == 0));
        if (!unpacked) continue;
        CHECK(json::parse(unpacked->json)["accessors"][static_cast<std::size_t>(few)]["componentType"] == 5121);
        CHECK(test::mesh_of_glb(test::glb_of(*unpacked)).indices.back() == 20);
    }
}
