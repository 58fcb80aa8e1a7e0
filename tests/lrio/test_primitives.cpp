// Compares the list of a scene's primitives with the joined mesh.
#include <doctest/doctest.h>

#include "lacedring/primitives.hpp"
#include "tests/lrio/gltf_maker.h"

using namespace lacedring;
using namespace lacedring::test;

namespace {

PrimitiveList must_list(const std::string& file, ReadReport* report = nullptr) {
    auto list = read_primitives(std::as_bytes(std::span(file)), "x.glb", {}, report);
    const std::string message = list ? std::string() : list.error().message;
    CAPTURE(message);
    REQUIRE(list.has_value());
    return *list;
}

/// Two meshes with different attributes, placed by a mirrored node, an instanced node and a root node.
std::string scene() {
    GltfMaker maker;
    maker.floats("VEC3", square, 3);                                 // 0
    maker.add<std::uint16_t>(5123, "SCALAR", {0, 1, 3, 2}, 1);       // 1: a strip
    maker.add<std::uint8_t>(5121, "SCALAR", {3, 0, 1}, 1);           // 2
    maker.floats("VEC3", {0, 0, 1, 0, 1, 0, 1, 0, 0, 0, 0, -1}, 3);  // 3: normals
    maker.add<std::int8_t>(5120, "VEC4", {127, 0, 0, 127, 0, 127, 0, -127, 0, 0, 127, 127, -127, 0, 0, 127}, 4, true);
    maker.floats("VEC3", {0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 2, 2, 0, 2, 0, 2, 2}, 3);  // 5: two triangles
    maker.floats("VEC2", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 2);                    // 6
    maker.floats("VEC3", {3, 0, 0, 0, 5, 0}, 3);                                      // 7: translations
    return maker.glb_file(R"("scene":0,"scenes":[{"nodes":[0,2,3]}],"nodes":[
        {"scale":[-1,2,3],"translation":[0.1,0,0],"children":[1]},
        {"mesh":0,"rotation":[0,0,0.6,0.8]},
        {"mesh":1,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":7}}}},
        {"mesh":0}],
        "extensionsUsed":["EXT_mesh_gpu_instancing"],
        "meshes":[{"name":"panel","primitives":[
            {"attributes":{"POSITION":0,"NORMAL":3,"TANGENT":4},"indices":1,"mode":5},
            {"attributes":{"POSITION":0,"NORMAL":3,"TANGENT":4},"indices":2},
            {"attributes":{"POSITION":0},"mode":0},
            {"attributes":{"POSITION":0},"mode":6}]},
          {"primitives":[{"attributes":{"POSITION":5,"TEXCOORD_0":6}}]},
          {"name":"not placed","primitives":[{"attributes":{"POSITION":0}}]}])");
}

/// The values of an attribute at the corners of the triangles.
template <class T>
std::vector<T> at_corners(const Mesh& mesh, std::string_view name) {
    const std::vector<T> values = values_of<T>(mesh, name);
    const std::size_t width = find_attribute(mesh, name)->components;
    std::vector<T> out;
    for (const std::uint32_t v : mesh.indices) {
        for (std::size_t c = 0; c < width; ++c) out.push_back(values[v * width + c]);
    }
    return out;
}

}  // namespace

TEST_CASE("primitives: the list of primitives and placed meshes") {
    ReadReport report;
    const PrimitiveList list = must_list(scene(), &report);
    REQUIRE(list.primitives.size() == 4);
    SUBCASE("the report counts primitives and names the points left out") {
        CHECK(report.primitives == 4);
        CHECK(report.left_out == std::vector<std::string>{"1 primitive of points"});
    }
    SUBCASE("meshes have names, and every primitive is sound") {
        CHECK(list.mesh_names == std::vector<std::string>{"panel", "", "not placed"});
        for (const Primitive& primitive : list.primitives) CHECK(is_sound(primitive.geometry));
    }
    SUBCASE("a strip is a triangle list, with all its attributes") {
        const Primitive& strip = list.primitives[0];
        CHECK(strip.mode == PrimitiveMode::strip);
        CHECK(strip.geometry.indices == Indices{0, 1, 3, 1, 2, 3});
        CHECK(attributes_of(strip.geometry) == "POSITION:f32x3 NORMAL:f32x3 TANGENT:i8x4n");
    }
    SUBCASE("a primitive that shares an accessor has only its own vertices") {
        const Primitive& shared = list.primitives[1];
        CHECK(shared.geometry.vertex_count == 3);
        CHECK(shared.geometry.indices == Indices{2, 0, 1});
        CHECK(values_of<float>(shared.geometry, "POSITION") == Floats{0, 0, 0, 1, 0, 0, 0, 1, 0});
        CHECK(values_of<float>(shared.geometry, "NORMAL") == Floats{0, 0, 1, 0, 1, 0, 0, 0, -1});
    }
    SUBCASE("a fan has the numbers of its mesh and primitive") {
        const Primitive& fan = list.primitives[2];
        CHECK(fan.mesh == 0);
        CHECK(fan.number == 3);
        CHECK(fan.mode == PrimitiveMode::fan);
        CHECK(fan.geometry.indices == Indices{1, 2, 0, 2, 3, 0});
        CHECK(attributes_of(fan.geometry) == "POSITION:f32x3");
    }
    SUBCASE("a primitive without indices") {
        CHECK(list.primitives[3].mesh == 1);
        CHECK(list.primitives[3].geometry.indices == Indices{0, 1, 2, 3, 4, 5});
        CHECK(attributes_of(list.primitives[3].geometry) == "POSITION:f32x3 TEXCOORD_0:f32x2");
    }
    SUBCASE("meshes are placed by mirrored, instanced and root nodes") {
        REQUIRE(list.placed.size() == 4);
        CHECK(list.placed[0].mesh == 0);
        CHECK(mirrors(list.placed[0].placement));
        CHECK(list.placed[1].mesh == 1);
        CHECK(list.placed[1].placement[12] == 3.0);
        CHECK(list.placed[2].placement[13] == 5.0);
        CHECK(list.placed[3].mesh == 0);
        CHECK(list.placed[3].placement == kIdentity);
    }
}

TEST_CASE("primitives: the joined mesh has the triangles of the placed primitives") {
    const std::string file = scene();
    const PrimitiveList list = must_list(file);
    ReadReport report;
    const auto joined = read_mesh(std::as_bytes(std::span(file)), "x.glb", {}, &report);
    REQUIRE(joined.has_value());
    CHECK(report.primitives == 4);
    Floats positions;
    for (const PlacedMesh& placed : list.placed) {
        for (const Primitive& primitive : list.primitives) {
            if (primitive.mesh != placed.mesh) continue;
            const Floats more = at_corners<float>(place(primitive.geometry, placed.placement), "POSITION");
            positions.insert(positions.end(), more.begin(), more.end());
        }
    }
    CHECK(at_corners<float>(*joined, "POSITION") == positions);
    CHECK(joined->triangle_count() == 5 + 2 + 2 + 5);
}

TEST_CASE("primitives: place() transforms normals and tangents, and flips mirrored triangles") {
    const PrimitiveList list = must_list(scene());
    const Mesh& strip = list.primitives[0].geometry;
    CHECK(same(place(strip, kIdentity), strip));
    const Mesh mirrored = place(strip, {-2, 0, 0, 0, 0, 4, 0, 0, 0, 0, 4, 0, 1, 2, 3, 1});
    CHECK(mirrored.indices == Indices{0, 3, 1, 1, 3, 2});
    CHECK(attributes_of(mirrored) == "POSITION:f32x3 NORMAL:f32x3 TANGENT:f32x4");
    CHECK(values_of<float>(mirrored, "POSITION") == Floats{1, 2, 3, -1, 2, 3, -1, 6, 3, 1, 6, 3});
    CHECK(values_of<float>(mirrored, "NORMAL") == Floats{0, 0, 1, 0, 1, 0, -1, 0, 0, 0, 0, -1});
    CHECK(values_of<float>(mirrored, "TANGENT") == Floats{-1, 0, 0, 1, 0, 1, 0, -1, 0, 0, 1, 1, 1, 0, 0, 1});
}

TEST_CASE("primitives: the joined mesh gets normals from triangles where a primitive has none") {
    const std::string file = scene();
    ReadReport report;
    const auto joined = read_mesh(std::as_bytes(std::span(file)), "x.glb", {}, &report);
    REQUIRE(joined.has_value());
    CHECK(attributes_of(*joined) == "POSITION:f32x3 NORMAL:f32x3");
    const auto has = [&](const std::string& line) {
        return std::find(report.left_out.begin(), report.left_out.end(), line) != report.left_out.end();
    };
    CHECK(has("2 primitives without normals (made from their triangles)"));
    CHECK(has("2 attributes that not every primitive has alike ('TANGENT', 'TEXCOORD_0')"));
    const Floats normals = at_corners<float>(*joined, "NORMAL");
    // The last five triangles are the panel at the root: strip, triangle, fan.
    const auto last = [&](std::size_t triangle) {
        const std::size_t at = normals.size() - 9 * (5 - triangle);
        return Floats(normals.begin() + static_cast<std::ptrdiff_t>(at),
                      normals.begin() + static_cast<std::ptrdiff_t>(at + 9));
    };
    CHECK(last(0) == Floats{0, 0, 1, 0, 1, 0, 0, 0, -1});
    CHECK(last(2) == Floats{0, 0, -1, 0, 0, 1, 0, 1, 0});
    CHECK(last(3) == Floats{0, 0, 1, 0, 0, 1, 0, 0, 1});
    // The first instance of the other mesh faces +z, and so does the mirrored fan.
    const std::size_t other = 9 * 5;
    CHECK(Floats(normals.begin() + other, normals.begin() + other + 9) == Floats{0, 0, 1, 0, 0, 1, 0, 0, 1});
    CHECK(Floats(normals.begin() + 27, normals.begin() + 36)[2] == 1);
    INFO("normals of different types are joined as floats");
    GltfMaker maker;
    maker.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);                                // 0
    maker.floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);                                // 1
    maker.add<std::int8_t>(5120, "VEC3", {0, 0, -127, 0, 0, -127, 0, 127, 0}, 3, true);  // 2
    const Mesh mixed = must_read("mixed.glb", maker.glb_file(one_node + mesh_of(R"(
        {"attributes":{"POSITION":0,"NORMAL":2}},{"attributes":{"POSITION":0,"NORMAL":1}})")));
    CHECK(values_of<float>(mixed, "NORMAL") == Floats{0, 0, -1, 0, 0, -1, 0, 1, 0, /**/ 0, 0, 1, 0, 0, 1, 0, 0, 1});
}

TEST_CASE("primitives: a file of another format has one primitive") {
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double "
        "z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    const PrimitiveList list = must_list(ply);
    REQUIRE(list.primitives.size() == 1);
    CHECK(same(list.primitives[0].geometry, must_read("x.ply", ply)));
    CHECK(list.placed.size() == 1);
    CHECK(list.placed[0].placement == kIdentity);
    CHECK(list.mesh_names.size() == 1);
    CHECK(read_primitives(write_text("y.ply", ply)).has_value());
}

TEST_CASE("primitives: errors name the primitive, and memory is limited") {
    GltfMaker maker;
    maker.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);                           // 0
    maker.add<std::uint8_t>(5121, "SCALAR", {0, 1, 3}, 1);                          // 1
    maker.add_accessor(R"("componentType":5126,"count":100000000,"type":"VEC3")");  // 2
    maker.add<std::uint16_t>(5123, "SCALAR", {0, 1, 2}, 1);                         // 3
    const auto message = [&](const std::string& primitives, std::uint64_t held = 0) {
        const std::string file = maker.glb_file(one_node + mesh_of(primitives));
        ReadOptions options;
        options.held_bytes = held;
        const auto list = read_primitives(std::as_bytes(std::span(file)), "x.glb", options);
        return list ? std::string("none") : list.error().message;
    };
    CHECK(message(R"({"attributes":{"POSITION":0}},{"attributes":{"POSITION":0},"indices":1})") ==
          "glTF: mesh 0: primitive 1: index 3 at place 2 is out of range (3 vertices)");
    CHECK(message(R"({"attributes":{"POSITION":0,"NORMAL":0}},{"attributes":{"POSITION":2},"indices":3},
        {"attributes":{"POSITION":2},"indices":3})")
              .find("are allowed") != std::string::npos);
    CHECK(message(R"({"attributes":{"POSITION":0}})", std::uint64_t{1} << 30).find("are allowed") != std::string::npos);
    CHECK(message(R"({"attributes":{"POSITION":0}})", 1000) == "none");
    CHECK(message(R"({"attributes":{"POSITION":0},"mode":1})") == "has no triangles");
}
