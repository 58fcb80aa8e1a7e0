// PLY, OBJ, OFF and STL: what each of them can say, and the real meshes where LACEDRING_MESHES names their folder.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <cstdlib>
#include <limits>
#include <sstream>

#include "tests/lrcore/mesh_files.h"

using namespace lr;
using namespace lr::test;

TEST_CASE("PLY ascii: groups, other properties, lists on vertices, polygons") {
    const Mesh mesh = must_read("a.ply", R"(ply
format ascii 1.0
comment made by hand
obj_info nothing
element vertex 5
property float x
property float y
property float z
property float32 nx
property float nz
property float ny
property uchar red
property uint8 green
property uchar blue
property uchar alpha
property list uchar int rings
property short quality
property float s
property float t
element material 1
property float shine
element face 3
property list uchar float texcoord
property list uchar int vertex_indices
property uchar flags
end_header
0 0 0  0 1 2  1 2 3 4  2 7 7  -5  .5 .25
1 0 0  0 1 2  1 2 3 4  0      300 .5 .25
1 1 +1.5e0  0 1 2  255.0 2 3 4  1 9  1  .5 .25
0 1 0  0 1 2  1 2 3 4  0      2   .5 .25
0 0 -0 0 1 2  1 2 3 4  0      3   .5 .25
0.5
6 0 0 1 0 1 1  3 0 1 2  255
0              4 0 2 3 4  0
0              2 0 1  0
)");
    CHECK(mesh.vertex_count == 5);
    CHECK(mesh.indices == Indices{0, 1, 2, 0, 2, 3, 0, 3, 4});
    CHECK(attributes_of(mesh) == "POSITION:f32x3 NORMAL:f32x3 TEXCOORD_0:f32x2 COLOR_0:u8x4n quality:i16x1");
    CHECK(values_of<float>(mesh, "POSITION")[8] == 1.5F);
    CHECK(std::signbit(values_of<float>(mesh, "POSITION")[14]));
    CHECK(values_of<float>(mesh, "NORMAL")[1] == 2.0F);  // ny is the file's sixth property
    CHECK(values_of<std::int16_t>(mesh, "quality") == std::vector<std::int16_t>{-5, 300, 1, 2, 3});
    CHECK(values_of<std::uint8_t>(mesh, "COLOR_0")[8] == 255);
    CHECK(is_sound(mesh));
}

TEST_CASE("PLY binary in both orders: faces before vertices, doubles, colours that stay apart") {
    for (const bool big : {false, true}) {
        std::string file = fmt::format("ply\r\nformat binary_{}_endian 1.0\r\n", big ? "big" : "little");
        file += "element face 1\r\nproperty list ushort uint32 vertex_index\r\nelement empty 4000000000\r\n";
        file += "element vertex 3\r\nproperty double x\r\nproperty float64 y\r\nproperty double z\r\n";
        file += "property int red\r\nproperty int green\r\nproperty int blue\r\nproperty ushort u\r\nend_header\r\n";
        put(file, std::uint16_t{3}, big);
        for (const std::uint32_t v : {2U, 1U, 0U}) put(file, v, big);
        for (int v = 0; v < 3; ++v) {
            for (int i = 0; i < 3; ++i) put(file, 0.1 * (v * 3 + i), big);
            for (int i = 0; i < 3; ++i) put(file, std::int32_t{-7 * v}, big);
            put(file, static_cast<std::uint16_t>(v), big);
        }
        const Mesh mesh = must_read("b.ply", file);
        CHECK(mesh.indices == Indices{2, 1, 0});
        CHECK(attributes_of(mesh) == "POSITION:f64x3 red:i32x1 green:i32x1 blue:i32x1 u:u16x1");
        CHECK(values_of<double>(mesh, "POSITION")[8] == 0.1 * 8);
        CHECK(values_of<std::int32_t>(mesh, "red") == std::vector<std::int32_t>{0, -7, -14});
    }
}

TEST_CASE("PLY: positions of other types become floats; both spellings of every type") {
    const Mesh mesh = must_read("c.ply",
                                "ply\nformat ascii 1.0\nelement vertex 3\nproperty int8 x\nproperty double y\n"
                                "property uint16 z\nproperty int16 i\nproperty uint32 j\nproperty float32 k\n"
                                "property char l\nproperty ushort m\nproperty uint n\nproperty int32 o\n"
                                "element face 1\nproperty list int8 uint16 vertex_indices\nend_header\n"
                                "-128 0.1 65535 1 4294967295 1e-50 1 1 1 -2147483648\n"
                                "1 0 0 1 1 -1e50 1 1 1 1\n0 1 0 1 1 nan 1 1 1 1\n3 0 1 2\n");
    CHECK(attributes_of(mesh) == "POSITION:f32x3 i:i16x1 j:u32x1 k:f32x1 l:i8x1 m:u16x1 n:u32x1 o:i32x1");
    CHECK(values_of<float>(mesh, "POSITION")[0] == -128.0F);
    CHECK(values_of<float>(mesh, "POSITION")[1] == 0.1F);
    CHECK(values_of<float>(mesh, "POSITION")[2] == 65535.0F);
    CHECK(values_of<std::uint32_t>(mesh, "j")[0] == UINT32_MAX);
    CHECK(values_of<float>(mesh, "k")[0] == 0.0F);
    CHECK(values_of<float>(mesh, "k")[1] == -std::numeric_limits<float>::infinity());
    CHECK(std::isnan(values_of<float>(mesh, "k")[2]));
}

TEST_CASE("PLY: triangle strips with restarts, beside faces") {
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
        "property float z\n";
    const std::string vertices = "0 0 0 1 0 0 2 0 0 3 0 0 4 0 0 5 0 0\n";
    const Mesh strip = must_read("s.ply", head +
                                              "element tristrips 1\nproperty list int int vertex_indices\n"
                                              "end_header\n" +
                                              vertices + "10 0 1 2 3 -1 2 -1 3 4 5\n");
    CHECK(strip.indices == Indices{0, 1, 2, 1, 3, 2, 3, 4, 5});
    const Mesh both = must_read("t.ply", head +
                                             "element face 1\nproperty list uchar int vertex_indices\n"
                                             "element tristrips 1\nproperty list int int vertex_indices\n"
                                             "end_header\n" +
                                             vertices + "3 5 4 3\n4 0 1 2 3\n");
    CHECK(both.indices == Indices{5, 4, 3, 0, 1, 2, 1, 3, 2});
}

TEST_CASE("OBJ") {
    SUBCASE("plain v keeps the file's vertices, unused ones too") {
        const Mesh mesh = must_read("a.obj",
                                    "# comment\r\nmtllib a.mtl\r\no thing\r\nv 9 9 9\r\nv 1 2 3 1\r\n"
                                    "v +1e-3 0 1e-60 # here too\r\n\r\nf 2 3 4\r\nv 1 1 1\r\nusemtl m\r\n"
                                    "f -1 -2 -3\r\nf 2 3 \\\r\n 4 \\\r\n 2\r\nf 1 2\r\nl 1 2\r\ns off");
        CHECK(mesh.vertex_count == 4);
        CHECK(mesh.indices == Indices{1, 2, 3, 3, 2, 1, 1, 2, 3, 1, 3, 1});
        CHECK(attributes_of(mesh) == "POSITION:f32x3");
        CHECK(values_of<float>(mesh, "POSITION")[6] == 0.001F);
    }
    SUBCASE("a vertex is a distinct v/vt/vn in the order of first use; v that no face uses follow") {
        const Mesh mesh = must_read("b.obj",
                                    "v 0 0 0\nv 1 0 0\nv 7 7 7\nv 0 1 0\nvt .1 .2\nvt .3\nvn 0 0 1\n"
                                    "f 4/1/1 2/2/1 1/1/1\nf 4/2/1 2/2/1 1//1\nf 4/1/1 2 1/1/\n");
        CHECK(mesh.indices == Indices{0, 1, 2, 3, 1, 4, 0, 5, 6});
        CHECK(mesh.vertex_count == 8);
        CHECK(attributes_of(mesh) == "POSITION:f32x3 NORMAL:f32x3 TEXCOORD_0:f32x2");
        const auto position = values_of<float>(mesh, "POSITION");
        CHECK(position[1] == 1.0F);
        CHECK(position[21] == 7.0F);
        CHECK(values_of<float>(mesh, "TEXCOORD_0") ==
              Floats{.1F, .2F, .3F, 0, .1F, .2F, .3F, 0, 0, 0, 0, 0, .1F, .2F, 0, 0});
        const auto normal = values_of<float>(mesh, "NORMAL");
        CHECK(normal[2] == 1.0F);
        CHECK(normal[17] == 0.0F);
        CHECK(normal[23] == 0.0F);
    }
    SUBCASE("faces may come before what they use; polygons are fans") {
        const Mesh mesh = must_read("c.obj",
                                    "f 1//1 2//1 3//1 4//1 5//1\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\n"
                                    "vn 0 0 1\n");
        CHECK(mesh.indices == Indices{0, 1, 2, 0, 2, 3, 0, 3, 4});
    }
    SUBCASE("colours, if every vertex has one") {
        const std::string faces = "f 1 2 3\n";
        const Mesh all = must_read("d.obj", "v 0 0 0 1 .5 0\nv 1 0 0 1 .5 0\nv 0 1 0 1 .5 .25\n" + faces);
        CHECK(attributes_of(all) == "POSITION:f32x3 COLOR_0:f32x3");
        CHECK(values_of<float>(all, "COLOR_0")[8] == .25F);
        const Mesh some = must_read("e.obj", "v 0 0 0 1 .5 0\nv 1 0 0\nv 0 1 0 1 .5 .25\n" + faces);
        CHECK(attributes_of(some) == "POSITION:f32x3");
    }
}

TEST_CASE("OBJ: decimals are correctly rounded") {
    const Mesh mesh = must_read("r.obj",
                                "v 16777217 16777219 1.00000005960464477539062500\n"
                                "v 1.00000005960464477539062501 3.4028235e38 1e-45\n"
                                "v 7.0e-46 0.000000000000000000000000000000000000000000000000000001e54 -0\nf 1 2 3\n");
    CHECK(values_of<float>(mesh, "POSITION") ==
          Floats{16777216.0F, 16777220.0F, 1.0F, 1.00000011920928955F, 3.4028235e38F, 1e-45F, 0.0F, 1.0F, -0.0F});
}

TEST_CASE("OFF") {
    SUBCASE("plain, with comments, colours of faces, and counts on the first line") {
        const Mesh mesh = must_read("a.off",
                                    "# first\nOFF # word\n# counts\n4 2 0\n0 0 0\n1 0 0 # c\n\n1 1 0\n0 1 0\n"
                                    "4 0 1 2 3 255 0 0\n3 0 1 2\n");
        CHECK(mesh.indices == Indices{0, 1, 2, 0, 2, 3, 0, 1, 2});
        CHECK(attributes_of(mesh) == "POSITION:f32x3");
        CHECK(must_read("b.off", "OFF 3 1 3\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2").indices == Indices{0, 1, 2});
        CHECK(must_read("c.off", "3 1\n0 0 0\n1 0 0\n0 1 0\n3 2 1 0").indices == Indices{2, 1, 0});
        CHECK(must_read("d.dat", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 2 1 0").vertex_count == 3);
    }
    SUBCASE("vertex colours and normals") {
        const Mesh bytes = must_read("e.off", "COFF\n3 1 0\n0 0 0 255 0 1 9\n1 0 0 1 2 3 4\n0 1 0 0 0 0 0\n3 0 1 2\n");
        CHECK(attributes_of(bytes) == "POSITION:f32x3 COLOR_0:u8x4n");
        CHECK(values_of<std::uint8_t>(bytes, "COLOR_0")[0] == 255);
        const Mesh reals = must_read("f.off",
                                     "STCNOFF\n3 1 0\n0 0 0 0 0 1 1 1 1 .5 .6\n1 0 0 0 0 1 .5 0 0 .5 .6\n"
                                     "0 1 0 0 0 1 0 0 0 .5 .7\n3 0 1 2\n");
        CHECK(attributes_of(reals) == "POSITION:f32x3 NORMAL:f32x3 TEXCOORD_0:f32x2 COLOR_0:f32x3");
        CHECK(values_of<float>(reals, "COLOR_0")[3] == .5F);
        CHECK(values_of<float>(reals, "TEXCOORD_0")[5] == .7F);
    }
    SUBCASE("what is not read") {
        CHECK(read_text("g.off", "OFF BINARY\n").error().code == ErrorCode::unsupported);
        CHECK(read_text("h.off", "4OFF\n1 1 1\n").error().code == ErrorCode::unsupported);
    }
}

TEST_CASE("STL: vertices with the same bits are one") {
    const Floats corners{0, 0, 0, 1, 0,           0, 0, 1, 0, /* */ 1, 0, 0, 1, 1,
                         0, 0, 1, 0, /* */ -0.0F, 0, 0, 1, 0, 0,       1, 1, 0};
    const Indices indices{0, 1, 2, 1, 3, 2, 4, 1, 3};
    for (const char* title : {"binary", "solid but binary", ""}) {
        const Mesh mesh = must_read("a.stl", binary_stl(corners, title));
        CHECK(mesh.indices == indices);
        CHECK(mesh.vertex_count == 5);
        CHECK(attributes_of(mesh) == "POSITION:f32x3");
    }
    CHECK(must_read("b.stl", binary_stl(corners) + "trailing").indices == indices);
    CHECK(must_read("no-extension", binary_stl(corners)).indices == indices);

    std::string text;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (i % 9 == 0) text += fmt::format("solid part {}\n facet normal 0 0 nan\n  outer loop\n", i);
        if (i % 3 == 0) text += "   vertex";
        text += fmt::format(" {}", corners[i]);
        if (i % 3 == 2) text += "\r\n";
        if (i % 9 == 8) text += "  endloop\n endfacet\nendsolid part of something\n\n";
    }
    CHECK(must_read("c.stl", text).indices == indices);
    std::transform(text.begin(), text.end(), text.begin(), [](char c) { return static_cast<char>(std::toupper(c)); });
    CHECK(must_read("d.stl", "  " + text).indices == indices);
}

TEST_CASE("formats are told by content before extension") {
    CHECK(must_read("really.obj",
                    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                    "property float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n"
                    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
              .triangle_count() == 1);
    CHECK(must_read("really.ply", "\xEF\xBB\xBFOFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").triangle_count() == 1);
    CHECK(read_text("what.xyz", "v 0 0 0\n").error().code == ErrorCode::unsupported);
}

TEST_CASE("the real meshes of LACEDRING_MESHES") {
    const char* meshes = std::getenv("LACEDRING_MESHES");
    if (meshes == nullptr) return;
    std::ifstream index(std::filesystem::path(meshes) / "INDEX.tsv");
    REQUIRE(index.good());
    std::string line;
    std::getline(index, line);
    while (std::getline(index, line)) {
        std::vector<std::string> fields;
        std::istringstream words(line);
        for (std::string field; std::getline(words, field, '\t');) fields.push_back(field);
        REQUIRE(fields.size() > 5);
        CAPTURE(fields[0]);
        const auto mesh = read_mesh(std::filesystem::path(meshes) / fields[0]);
        REQUIRE(mesh.has_value());
        CHECK(is_sound(*mesh));
        // The index counts what a glTF file holds, and one file places its wheels twice.
        const std::size_t instanced = fields[0] == "CesiumMilkTruck.glb" ? 768 : 0;
        CHECK(mesh->triangle_count() == std::stoull(fields[4]) + instanced);
        const bool has_file_vertices =
            fields[3].starts_with("ply") || fields[3].starts_with("off") || fields[3].starts_with("stl");
        if (has_file_vertices) CHECK(mesh->vertex_count == std::stoull(fields[5]));
    }
}
