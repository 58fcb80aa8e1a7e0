// Tests write_mesh, whose files read_mesh reads as the same mesh, and weld.
#include <doctest/doctest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <random>

#include "lacedring/file.hpp"
#include "lacedring/mesh_files.hpp"
#include "lrio/mesh/distinct.h"
#include "tests/lrio/mesh_files.h"

using namespace lacedring;
using namespace lacedring::test;

namespace {

template <class T>
Attribute attribute(std::string name, ComponentType type, std::uint8_t components, const std::vector<T>& values,
                    bool normalized = false) {
    Attribute out{std::move(name), type, components, normalized, {}};
    const auto bytes = std::as_bytes(std::span(values));
    out.data.assign(bytes.begin(), bytes.end());
    return out;
}

Mesh square_mesh() {
    Mesh mesh;
    mesh.vertex_count = 4;
    mesh.indices = {0, 1, 2, 0, 2, 3};
    mesh.attributes.push_back(
        attribute<float>("POSITION", ComponentType::f32, 3, {-0.0F, 0.1F, 1e-45F, 1, 0, 0, 1, 1, 3.4e38F, 0, 1, 0}));
    return mesh;
}

Mesh round_trip(const Mesh& mesh, const std::string& name) {
    const auto written = write_mesh(mesh, folder() / name);
    REQUIRE(written.has_value());
    const auto in_memory = mesh_file_bytes(mesh, writable_format(name));
    REQUIRE(in_memory.has_value());
    CHECK(*in_memory == *read_file(folder() / name));
    auto back = read_mesh(folder() / name);
    const std::string message = back ? "" : back.error().message;
    CAPTURE(message);
    REQUIRE(back.has_value());
    CHECK(is_sound(*back));
    return *back;
}

nlohmann::json glb_json(const std::string& name) {
    std::ifstream file(folder() / name, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, 4);
    CHECK(bytes.size() % 4 == 0);
    CHECK(length % 4 == 0);
    return nlohmann::json::parse(bytes.substr(20, length));
}

}  // namespace

TEST_CASE("PLY keeps every attribute bit for bit, with its name") {
    Mesh mesh = square_mesh();
    mesh.attributes.push_back(attribute<float>("NORMAL", ComponentType::f32, 3, Floats(12, std::nanf("7"))));
    mesh.attributes.push_back(
        attribute<std::uint8_t>("COLOR_0", ComponentType::u8, 4, std::vector<std::uint8_t>(16, 200), true));
    mesh.attributes.push_back(
        attribute<std::uint16_t>("COLOR_0", ComponentType::u16, 3, std::vector<std::uint16_t>(12, 9)));
    mesh.attributes.push_back(attribute<float>("TEXCOORD_0", ComponentType::f32, 2, Floats(8, .5F)));
    mesh.attributes.push_back(attribute<double>("a b\n%41 ", ComponentType::f64, 1, {1, 2, 3, 4}));
    mesh.attributes.push_back(attribute<std::int8_t>("", ComponentType::i8, 2, {-1, -2, -3, -4, 5, 6, 7, 8}, true));
    mesh.attributes.push_back(attribute<std::int16_t>("x", ComponentType::i16, 1, {-1, -2, -3, -4}));
    mesh.attributes.push_back(attribute<std::int32_t>("i", ComponentType::i32, 1, {-1, -2, -3, -4}));
    mesh.attributes.push_back(attribute<std::uint32_t>("_JOINTS", ComponentType::u32, 16, Indices(64, 4000000000U)));
    CHECK(same(round_trip(mesh, "w.ply"), mesh));

    Mesh doubles = square_mesh();
    doubles.attributes.front() = attribute<double>("POSITION", ComponentType::f64, 3, std::vector<double>(12, 0.1));
    CHECK(same(round_trip(doubles, "d.ply"), doubles));
}

TEST_CASE("PLY: comments about attributes that do not match the properties are ignored") {
    const std::string body =
        "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar q\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2\n";
    for (const char* notes :
         {"comment lacedring attribute 3 0 POSITION\n", "comment lacedring attribute 4 0 POSITION\n",
          "comment lacedring attribute 3 0 POSITION\ncomment lacedring attribute 2 0 q\n",
          "comment lacedring attribute 255 0 POSITION\n", "comment lacedring attribute 0 0 POSITION\n",
          "comment lacedring attribute 3 0 WHERE\ncomment lacedring attribute 1 0 q\n",
          "comment lacedring attribute x\n", "comment lacedring attribute \n"}) {
        CAPTURE(notes);
        CHECK(attributes_of(must_read("n.ply", std::string("ply\nformat ascii 1.0\n") + notes + body)) ==
              "POSITION:f32x3 q:u8x1");
    }
    CHECK(attributes_of(must_read("n.ply",
                                  "ply\nformat ascii 1.0\ncomment lacedring attribute 3 0 POSITION\n"
                                  "comment lacedring attribute 1 1 %51%\n" +
                                      body)) == "POSITION:f32x3 Q%:u8x1n");
}

TEST_CASE("GLB: attributes of glTF are kept, others are renamed, converted or left out") {
    Mesh mesh = square_mesh();
    mesh.attributes.push_back(
        attribute<std::uint8_t>("COLOR_0", ComponentType::u8, 3, std::vector<std::uint8_t>(12, 200), true));
    mesh.attributes.push_back(
        attribute<std::uint8_t>("JOINTS_0", ComponentType::u8, 4, std::vector<std::uint8_t>(16, 3)));
    mesh.attributes.push_back(
        attribute<float>("NORMAL", ComponentType::f32, 3, {0, 0, 1, 1, 0, 0, 0, 1, 0, .6F, 0, .8F}));
    mesh.attributes.push_back(attribute<float>("WEIGHTS_0", ComponentType::f32, 4, Floats(16, .25F)));
    mesh.attributes.push_back(attribute<std::int16_t>("_short", ComponentType::i16, 1, {-1, -2, -3, -4}));
    CHECK(same(round_trip(mesh, "w.glb"), mesh));
    const auto json = glb_json("w.glb");
    CHECK(!json.contains("extensionsUsed"));
    CHECK(json["accessors"][0]["min"] == nlohmann::json({-0.0F, 0.0F, 0.0F}));
    CHECK(json["accessors"][0]["max"][2].get<float>() == 3.4e38F);
    CHECK(json["accessors"].back()["componentType"] == 5123);
    for (const auto& view : json["bufferViews"]) {
        CHECK(view["byteOffset"].get<int>() % 4 == 0);
        if (view.contains("byteStride")) CHECK(view["byteStride"].get<int>() % 4 == 0);
    }

    mesh = square_mesh();
    mesh.attributes.push_back(attribute<std::uint32_t>("big", ComponentType::u32, 1, {1, 2, 3, 16777217}));  // left out
    mesh.attributes.push_back(attribute<std::int32_t>("exact", ComponentType::i32, 1, {-1, 2, 3, 16777216}));
    mesh.attributes.push_back(attribute<double>("half", ComponentType::f64, 1, {.5, 0.1, 0, 0}));
    mesh.attributes.push_back(
        attribute<std::int8_t>("NORMAL", ComponentType::i8, 3, {0, 0, 127, 127, 0, 0, 0, -128, 0, 0, 127, 0}, true));
    mesh.attributes.push_back(attribute<float>("TEXCOORD_0", ComponentType::f32, 3, Floats(12, .5F)));
    mesh.attributes.push_back(attribute<float>("\xFF", ComponentType::f32, 1, Floats(4, .5F)));
    mesh.attributes.push_back(attribute<float>("six", ComponentType::f32, 6, Floats(24, .5F)));  // left out
    const Mesh back = round_trip(mesh, "x.glb");
    CHECK(attributes_of(back) ==
          "POSITION:f32x3 NORMAL:i8x3n _TEXCOORD_0:f32x3 _exact:f32x1 _half:f32x1 _\xEF\xBF\xBD:f32x1");
    CHECK(values_of<float>(back, "_exact") == Floats{-1, 2, 3, 16777216});
    CHECK(glb_json("x.glb")["extensionsRequired"] == nlohmann::json({"KHR_mesh_quantization"}));

    Mesh doubles = square_mesh();
    doubles.attributes.front() = attribute<double>("POSITION", ComponentType::f64, 3, std::vector<double>(12, 0.1));
    CHECK(attributes_of(round_trip(doubles, "d.glb")) == "POSITION:f32x3");
    doubles.attributes.front() = attribute<double>("POSITION", ComponentType::f64, 3, std::vector<double>(12, 1e300));
    CHECK(write_mesh(doubles, folder() / "d.glb").error().code == ErrorCode::invalid_argument);
}

TEST_CASE("GLB: values that glTF forbids are replaced, and the notes say so") {
    const auto notes_of = [](const Mesh& mesh) {
        WriteNotes notes;
        REQUIRE(write_mesh(mesh, folder() / "m.glb", &notes));
        return notes;
    };
    const float nan = std::nanf(""), inf = std::numeric_limits<float>::infinity();
    Mesh mesh = square_mesh();
    mesh.attributes.front() = attribute<float>("POSITION", ComponentType::f32, 3, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    CHECK(notes_of(mesh).empty());
    mesh.attributes.push_back(
        attribute<float>("NORMAL", ComponentType::f32, 3, {0, 0, 0, nan, 0, 1, 0, 0, 2, 0, inf, 0}));
    mesh.attributes.push_back(
        attribute<float>("TANGENT", ComponentType::f32, 4, {0, 0, 0, 1, 0, 3, 0, -1, 1, 0, 0, .5F, 1, 0, 0, -1}));
    mesh.attributes.push_back(
        attribute<float>("TEXCOORD_0", ComponentType::f32, 2, {0, nan, .25F, .25F, inf, 1, 2, -1}));
    mesh.attributes.push_back(
        attribute<float>("COLOR_0", ComponentType::f32, 3, {0, 1, 255, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
    mesh.attributes.push_back(attribute<float>("TEXCOORD_2", ComponentType::f32, 2, Floats(8, .5F)));
    mesh.attributes.push_back(
        attribute<std::uint8_t>("JOINTS_0", ComponentType::u8, 4, std::vector<std::uint8_t>(16, 3)));
    const WriteNotes notes = notes_of(mesh);
    const auto back = read_mesh(folder() / "m.glb");
    REQUIRE(back);
    // Normals without a direction are computed from the triangles.
    CHECK(values_of<float>(*back, "NORMAL") == Floats{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
    CHECK(values_of<float>(*back, "TANGENT") == Floats{1, 0, 0, 1, 0, 1, 0, -1, 1, 0, 0, 1, 1, 0, 0, -1});
    CHECK(values_of<float>(*back, "TEXCOORD_0") == Floats{0, 0, .25F, .25F, 0, 1, 2, -1});
    CHECK(attributes_of(*back) ==
          "POSITION:f32x3 NORMAL:f32x3 TANGENT:f32x4 TEXCOORD_0:f32x2 _COLOR_0:f32x3 _JOINTS_0:u8x4 _TEXCOORD_2:f32x2");
    REQUIRE(notes.size() == 6);
    CHECK(notes[0] == "NORMAL: 1 were not of unit length and were made so");
    CHECK(notes[1] == "NORMAL: 3 without a direction were made from the triangles");
    CHECK(notes[2] == "TANGENT: 2 were not of unit length and were made so");
    CHECK(notes[3] == "TANGENT: 1 without a direction became (1, 0, 0)");
    CHECK(notes[4] == "'TEXCOORD_0': 2 values that are not finite became 0");
    CHECK(notes[5] == "not as glTF defines it, so named _NAME: 'COLOR_0', 'TEXCOORD_2', 'JOINTS_0'");
}

TEST_CASE("texture coordinates keep their origin, or are flipped to the format's origin") {
    Mesh mesh = square_mesh();
    const Floats down{0, 0, .1F, .25F, .3F, 1, 1, -3}, up{0, 1, .1F, .75F, .3F, 0, 1, 4};
    mesh.attributes.push_back(attribute<float>("TEXCOORD_0", ComponentType::f32, 2, down));
    for (const bool v_up : {false, true}) {
        mesh.attributes.back().v_up = v_up;
        for (const char* name : {"o.obj", "o.ply", "o.glb"}) {
            CAPTURE(name);
            CAPTURE(v_up);
            const Mesh back = round_trip(mesh, name);
            const Attribute* texture = find_attribute(back, "TEXCOORD_0");
            REQUIRE(texture != nullptr);
            const bool obj = name[2] == 'o', ply = name[2] == 'p';
            CHECK(texture->v_up == (obj || (ply && v_up)));
            CHECK(values_of<float>(back, "TEXCOORD_0") == (texture->v_up == v_up ? down : up));
        }
    }
    CHECK(find_attribute(must_read("p.ply",
                                   "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                   "property float z\nproperty float s\nproperty float t\nelement face 1\n"
                                   "property list uchar int vertex_indices\nend_header\n0 0 0 0 0\n1 0 0 0 1\n"
                                   "0 1 0 1 0\n3 0 1 2\n"),
                         "TEXCOORD_0")
              ->v_up);
}

TEST_CASE("attributes of the same name are numbered, in linear time") {
    Mesh mesh = square_mesh();
    constexpr int kMany = 20000;
    for (int i = 0; i < kMany; ++i) {
        mesh.attributes.push_back(attribute<std::uint8_t>(i % 2 == 0 ? "same" : fmt::format("same_{}", i),
                                                          ComponentType::u8, 1,
                                                          std::vector<std::uint8_t>(4, static_cast<std::uint8_t>(i))));
    }
    CHECK(round_trip(mesh, "u.glb").attributes.size() == kMany + 1);
    CHECK(same(round_trip(mesh, "u.ply"), mesh));
}

TEST_CASE("OBJ: colors are kept, and the notes name what is left out") {
    Mesh mesh = square_mesh();
    mesh.attributes.push_back(
        attribute<float>("COLOR_0", ComponentType::f32, 3, {0, .1F, 1, 0, 0, 0, .5F, 0, 0, 0, 0, 7}));
    CHECK(same(round_trip(mesh, "c.obj"), mesh));
    mesh.attributes.push_back(attribute<std::uint8_t>("q", ComponentType::u8, 1, {1, 2, 3, 4}));
    WriteNotes notes;
    REQUIRE(write_mesh(mesh, folder() / "c.obj", &notes));
    CHECK(notes == WriteNotes{"OBJ has no place for 'q': left out"});
}

TEST_CASE("GLB: indices are 16 bits wide up to 65,535 vertices") {
    for (const std::uint32_t count : {65535U, 65536U, 70000U}) {
        Mesh mesh;
        mesh.vertex_count = count;
        mesh.indices = {0, 1, count - 1};
        Floats positions;
        for (std::uint32_t i = 0; i < count * 3; ++i) positions.push_back(static_cast<float>(i));
        mesh.attributes.push_back(attribute("POSITION", ComponentType::f32, 3, positions));
        CHECK(same(round_trip(mesh, "i.glb"), mesh));
        CHECK(glb_json("i.glb")["accessors"][1]["componentType"] == (count <= 65535 ? 5123 : 5125));
    }
}

TEST_CASE("OBJ: decimals are read back bit for bit") {
    CHECK(same(round_trip(square_mesh(), "w.obj"), square_mesh()));
    Mesh mesh = square_mesh();
    mesh.attributes.push_back(
        attribute<float>("NORMAL", ComponentType::f32, 3, {0, 0, 1, 0, 1, 0, 1, 0, 0, .6F, .8F, 0}));
    CHECK(same(round_trip(mesh, "n.obj"), mesh));
    mesh.attributes.push_back(attribute<float>("TEXCOORD_0", ComponentType::f32, 2, {0, 0, .1F, .2F, .3F, .4F, 1, 1}));
    mesh.attributes.back().v_up = true;
    CHECK(same(round_trip(mesh, "t.obj"), mesh));
    mesh.attributes.erase(mesh.attributes.begin() + 1);
    CHECK(same(round_trip(mesh, "u.obj"), mesh));

    std::uint32_t seed = 20240607;
    CAPTURE(seed);
    std::mt19937 random(seed);
    Mesh noise;
    noise.indices = {0, 1, 2};
    Floats positions;
    while (positions.size() < 30000) {
        const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
        if (std::isfinite(value)) positions.push_back(value);
    }
    noise.vertex_count = 10000;
    noise.attributes.push_back(attribute("POSITION", ComponentType::f32, 3, positions));
    CHECK(same(round_trip(noise, "r.obj"), noise));
    CHECK(same(round_trip(noise, "r.ply"), noise));
    CHECK(same(round_trip(noise, "r.glb"), noise));
}

TEST_CASE("write_mesh refuses malformed meshes, bad paths and meshes without triangles") {
    CHECK(write_mesh(square_mesh(), folder() / "a.xyz").error().code == ErrorCode::invalid_argument);
    CHECK(write_mesh(square_mesh(), folder() / "no" / "folder.ply").error().code == ErrorCode::cannot_write);
    CHECK(write_mesh(Mesh{}, folder() / "a.ply").error().code == ErrorCode::invalid_argument);
    Mesh mesh = square_mesh();
    mesh.indices[1] = 4;
    CHECK(write_mesh(mesh, folder() / "a.ply").error().code == ErrorCode::invalid_argument);
    mesh = square_mesh();
    mesh.attributes.front().data.pop_back();
    CHECK(write_mesh(mesh, folder() / "a.glb").error().code == ErrorCode::invalid_argument);
    mesh = square_mesh();
    // A mesh without triangles is refused because readers refuse it.
    mesh.indices.clear();
    for (const char* name : {"none.glb", "none.ply", "none.obj"}) {
        CHECK(write_mesh(mesh, folder() / name).error().code == ErrorCode::unsupported);
        CHECK(!std::filesystem::exists(folder() / name));
    }
}

TEST_CASE("weld joins vertices of equal attributes or positions") {
    Mesh mesh;
    mesh.vertex_count = 6;
    mesh.indices = {0, 1, 2, 3, 4, 5, 0, 3, 1};
    mesh.attributes.push_back(attribute<float>("POSITION", ComponentType::f32, 3,
                                               {0, 0, 0, 1, 0, 0, 0, 1, 0, -0.0F, 0, 0, 1, 0, 0, 0, 1, 0}));
    mesh.attributes.push_back(attribute<std::uint8_t>("q", ComponentType::u8, 1, {1, 2, 3, 4, 2, 6}));
    SUBCASE("none keeps all vertices") {
        CHECK(same(weld(mesh, Weld::none), mesh));
    }
    SUBCASE("attributes joins vertices that are equal in all attributes") {
        const Mesh all = weld(mesh, Weld::attributes);
        CHECK(all.indices == Indices{0, 1, 2, 3, 1, 4, 0, 3, 1});
        CHECK(values_of<std::uint8_t>(all, "q") == std::vector<std::uint8_t>{1, 2, 3, 4, 6});
    }
    SUBCASE("position joins -0 and 0; the report counts vertices whose other attributes are lost") {
        WeldReport report;
        const Mesh position = weld(mesh, Weld::position, &report);
        CHECK(position.indices == Indices{0, 1, 2, 0, 1, 2, 0, 0, 1});
        CHECK(values_of<std::uint8_t>(position, "q") == std::vector<std::uint8_t>{1, 2, 3});
        CHECK(values_of<float>(position, "POSITION").size() == 9);
        CHECK(report.vertices == 2);  // with q = 4 and q = 6
        CHECK(report.attributes == std::vector<std::string>{"q"});
    }
    SUBCASE("a joined vertex has the values of its first") {
        mesh.indices = {3, 4, 5};
        std::swap(mesh.attributes[0].data[3], mesh.attributes[0].data[39]);  // the signs of the x of vertices 0 and 3
        const Mesh negative = weld(mesh, Weld::position);
        CHECK(std::signbit(values_of<float>(negative, "POSITION")[0]));
        CHECK(negative.indices == Indices{0, 1, 2});
        CHECK(weld(mesh, Weld::attributes).vertex_count == 5);
    }
    SUBCASE("positions may be doubles") {
        mesh.indices = {3, 4, 5};
        mesh.attributes[0] = attribute<double>("POSITION", ComponentType::f64, 3,
                                               {0, -0.0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -0.0, 0, 1, 0});
        CHECK(weld(mesh, Weld::position).vertex_count == 3);
    }
}

namespace {
std::size_t comparisons = 0;
}

TEST_CASE("items whose hashes collide are grouped by their values") {
    const std::uint32_t seed = 5;
    CAPTURE(seed);
    std::mt19937 random(seed);
    std::vector<std::uint32_t> items(50000);
    for (std::uint32_t& item : items) item = static_cast<std::uint32_t>(random() % 20000);
    const auto compare = [&](std::uint32_t i, std::uint32_t j) {
        ++comparisons;
        return items[i] < items[j] ? -1 : items[i] > items[j] ? 1 : 0;
    };
    const auto count = static_cast<std::uint32_t>(items.size());
    const auto spread = detail::group_equal(
        count, [&](std::uint32_t i) { return detail::mix(0, items[i]); }, compare);
    CHECK(comparisons < 4 * items.size());
    for (const std::uint64_t modulus : {1ULL, 64ULL, 300ULL}) {
        CAPTURE(modulus);
        comparisons = 0;
        const auto collided = detail::group_equal(
            count, [&](std::uint32_t i) { return items[i] % modulus << 40U; }, compare);
        CHECK(collided.of == spread.of);
        CHECK(collided.count == spread.count);
        CHECK(comparisons < 60 * items.size());
    }
    CHECK(detail::group_sorted(0, compare).count == 0);
}

TEST_CASE("weld equals a quadratic weld on many vertices at few positions") {
    const std::uint32_t seed = 99;
    CAPTURE(seed);
    std::mt19937 random(seed);
    for (const std::uint32_t places : {1U, 10U, 3000U}) {
        Mesh mesh;
        mesh.vertex_count = 6000;
        Floats positions;
        for (std::uint32_t i = 0; i < mesh.vertex_count; ++i) {
            const auto place = static_cast<float>(random() % places);
            positions.insert(positions.end(), {place, 0, -place});
            mesh.indices.push_back(i);
        }
        mesh.attributes.push_back(attribute("POSITION", ComponentType::f32, 3, positions));
        const Mesh welded = weld(mesh, Weld::position);
        Floats seen;
        for (std::uint32_t i = 0; i < mesh.vertex_count; ++i) {
            const auto found = std::find(seen.begin(), seen.end(), positions[i * 3]) - seen.begin();
            if (found == static_cast<std::ptrdiff_t>(seen.size())) seen.push_back(positions[i * 3]);
            REQUIRE(welded.indices[i] == static_cast<std::uint32_t>(found));
        }
        CHECK(welded.vertex_count == seen.size());
    }
}
