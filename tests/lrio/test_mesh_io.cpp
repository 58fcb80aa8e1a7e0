// Tests reading PLY, OBJ, OFF and STL, and the real meshes of the folder LACEDRING_MESHES.
#include <doctest/doctest.h>

#include <cstdlib>
#include <limits>
#include <sstream>

#include "tests/lrio/mesh_files.h"
#include "tests/support/capture.h"

using namespace lacedring;
using namespace lacedring::test;

namespace {

/// ReadReport::left_out as "a; b".
std::string left_out(const std::string& name, std::string_view content) {
    ReadReport report;
    const auto mesh = read_mesh(write_text(name, content), {}, &report);
    const std::string message = mesh ? std::string() : mesh.error().message;
    CAPTURE(message);
    REQUIRE(mesh.has_value());
    std::string out;
    for (const std::string& what : report.left_out) out += (out.empty() ? "" : "; ") + what;
    return out;
}

const std::string four_obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

}  // namespace

TEST_CASE("PLY ascii: properties become attributes, lists of vertices are skipped, polygons are cut") {
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
    CHECK(values_of<float>(mesh, "NORMAL")[1] == 2.0F);  // ny is behind nz in the file
    CHECK(values_of<std::int16_t>(mesh, "quality") == std::vector<std::int16_t>{-5, 300, 1, 2, 3});
    CHECK(values_of<std::uint8_t>(mesh, "COLOR_0")[8] == 255);
    CHECK(is_sound(mesh));
}

TEST_CASE("PLY binary in both byte orders: faces before vertices, doubles, colors of mixed types stay apart") {
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

TEST_CASE("PLY: positions of other types become floats; types have two spellings") {
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

TEST_CASE("PLY: triangle strips with restarts, and faces beside them") {
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

TEST_CASE("PLY ascii: elements are read by line, or by word where lines do not match elements") {
    const auto head = [](int vertices, int faces) {
        return fmt::format(
            "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
            "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
            vertices, faces);
    };
    const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
    const Indices both{0, 1, 2, 2, 1, 0};
    // A value after the indices of each face.
    CHECK(must_read("a.ply", head(3, 2) + vertices + "3 0 1 2 7\n3 2 1 0 7\n").indices == both);
    CHECK(left_out("a.ply", head(3, 2) + vertices + "3 0 1 2 7\n3 2 1 0 7\n") ==
          "2 lines with values after their elements'");
    CHECK(must_read("b.ply", head(3, 2) + "\n0 0 0 9 9\n\n1 0 0\r\n \n0 1 0 9\n3 0 1 2\n3 2 1 0 255 0 0").indices ==
          both);
    CHECK(must_read("c.ply", head(3, 2) + "0 0 0 1 0 0\n0 1\n0 3 0 1\n2 3 2 1 0\n").indices == both);
    CHECK(must_read("d.ply", head(3, 2) + "0 0 0 1 0 0 0 1 0 3 0 1 2 3 2 1 0").indices == both);
    CHECK(must_read("e.ply", head(3, 2) + "0\n0\n0\n1 0 0\n0 1 0\n3\n0 1 2\n3 2 1 0\n").indices == both);
    // As many lines as elements, but elements continue on other lines.
    CHECK(must_read("f.ply", head(3, 2) + "0 0 0\n1 0\n0 0 1 0\n3 0 1 2\n3 2 1 0\n").indices == both);
    CHECK(must_read("g.ply", head(3, 2) + vertices + "3 0 1\n2 3 2 1 0\n").indices == both);
    CHECK(left_out("g.ply", head(3, 2) + vertices + "3 0 1\n2 3 2 1 0\n").empty());
    // More lines than elements.
    CHECK(must_read("h.ply", head(3, 2) + vertices + "3 0 1 2\n3 2 1 0\nand more\n").indices == both);
    CHECK(left_out("h.ply", head(3, 2) + vertices + "3 0 1 2\n3 2 1 0\nand more\n") ==
          "9 bytes after the last element");
    const std::string cr = head(3, 2) + vertices + "3 0 1 2 7\n3 2 1 0 7\n";
    std::string old_mac = cr;
    std::replace(old_mac.begin(), old_mac.end(), '\n', '\r');
    CHECK(must_read("i.ply", old_mac).indices == both);
}

TEST_CASE("PLY: the report names what is left out; doubles beyond the range of floats are refused") {
    const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
    const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";
    const std::string data = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    CHECK(left_out("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\n" + xyz + faces +
                                "element edge 0\nproperty int v\n"
                                "element strange 5\nend_header\n" +
                                data)
              .empty());
    CHECK(left_out("b.ply",
                   "ply\nformat ascii 1.0\nelement vertex 3\n" + xyz + "property list uchar int rings\n" + faces +
                       "property uchar red\nproperty list uchar float texcoord\nelement edge 2\nproperty int v\n"
                       "element material 1\nproperty float shine\nend_header\n0 0 0 0\n1 0 0 0\n0 1 0 0\n"
                       "3 0 1 2 255 0\n1\n2\n.5\n") ==
          "2 elements 'edge'; 1 element 'material'; 1 list of vertices: 'rings'; 2 properties of faces: 'red', "
          "'texcoord'");
    std::string many = "ply\nformat ascii 1.0\nelement vertex 3\n" + xyz + faces;
    for (int i = 0; i < 100; ++i) many += fmt::format("property int p{}\n", i);
    for (int i = 0; i < 100; ++i) many += fmt::format("element e{} 1\nproperty int p\n", i);
    many += "end_header\n" + data;
    for (int i = 0; i < 200; ++i) many += " 1";
    CHECK(left_out("c.ply", many) ==
          "1 element 'e0'; 1 element 'e1'; 1 element 'e2'; 1 element 'e3'; 96 further elements; "
          "100 properties of faces: 'p0', 'p1', 'p2', 'p3', ...");
    const std::string doubles =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n" + faces +
        "end_header\n";
    CHECK(must_read("d.ply", doubles + "0 0 0\n1 0 3.4028235677973362e38\n0 1 0\n3 0 1 2\n").vertex_count == 3);
    for (const char* big : {"3.4028235677973367e38", "-1e39", "1e300"}) {
        const auto mesh = read_text("e.ply", doubles + "0 0 0\n1 0 " + big + "\n0 1 0\n3 0 1 2\n");
        REQUIRE(!mesh);
        CHECK(mesh.error().code == ErrorCode::malformed);
        CHECK(mesh.error().message == "vertex 1: the position is beyond the range of floats");
    }
}

TEST_CASE("OBJ: vertices, faces and colors") {
    SUBCASE("faces of plain v keep the file's vertices, with unused ones") {
        const Mesh mesh = must_read("a.obj",
                                    "# comment\r\nmtllib a.mtl\r\no thing\r\nv 9 9 9\r\nv 1 2 3 1\r\n"
                                    "v +1e-3 0 1e-60 # here too\r\n\r\nf 2 3 4\r\nv 1 1 1\r\nusemtl m\r\n"
                                    "f -1 -2 -3\r\nf 2 3 \\\r\n 4 \\\r\n 2\r\nf 1 2\r\nl 1 2\r\ns off");
        CHECK(mesh.vertex_count == 4);
        CHECK(mesh.indices == Indices{1, 2, 3, 3, 2, 1, 1, 2, 3, 1, 3, 1});
        CHECK(attributes_of(mesh) == "POSITION:f32x3");
        CHECK(values_of<float>(mesh, "POSITION")[6] == 0.001F);
    }
    SUBCASE("vertices are the distinct v/vt/vn in the order of first use, then the unused v") {
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
    SUBCASE("faces may come before their vertices; convex polygons are fans") {
        const Mesh mesh = must_read("c.obj",
                                    "f 1//1 2//1 3//1 4//1 5//1\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\n"
                                    "vn 0 0 1\n");
        CHECK(mesh.indices == Indices{0, 1, 2, 0, 2, 3, 0, 3, 4});
    }
    SUBCASE("colors are read if every vertex has one") {
        const std::string faces = "f 1 2 3\n";
        const Mesh all = must_read("d.obj", "v 0 0 0 1 .5 0\nv 1 0 0 1 .5 0\nv 0 1 0 1 .5 .25\n" + faces);
        CHECK(attributes_of(all) == "POSITION:f32x3 COLOR_0:f32x3");
        CHECK(values_of<float>(all, "COLOR_0")[8] == .25F);
        const Mesh some = must_read("e.obj", "v 0 0 0 1 .5 0\nv 1 0 0\nv 0 1 0 1 .5 .25\n" + faces);
        CHECK(attributes_of(some) == "POSITION:f32x3");
    }
}

TEST_CASE("OBJ: a backslash at the end continues a line") {
    const Indices both{0, 1, 2, 0, 2, 3};
    // A blank after the backslash.
    CHECK(must_read("a.obj", four_obj + "f 1 2 3 \\ \n4\n").indices == both);
    for (const char* joint : {"\\\n", " \\\n", "\\ \t \n", "\\\r\n", " \\ \r\n \t", "\\\r", " \\\n\\\n \\ \n"}) {
        CAPTURE(joint);
        const std::string j = joint;
        CHECK(must_read("b.obj", four_obj + "f 1" + j + (j.back() == '\n' ? " " : "") + "2 3" + j + " 4\n").indices ==
              both);
        CHECK(must_read("c.obj", four_obj + "f" + j + " 1 2 3 4" + j + " \nf 1 2 3").indices.size() == 9);
        // Lines that are not read continue, too: "f 1 2 3" are further names of a group.
        CHECK(must_read("d.obj", four_obj + "g a b" + j + " f 1 2 3\nf 1 2 3 4\n").indices == both);
        CHECK(must_read("e.obj", four_obj + "vp 1 " + j + "f 1 2 3\nf 1 2 3 4\n").indices == both);
        CHECK(must_read("f.obj", four_obj + "vn 0 0 1 5 5 " + j + "f 1 2 3\nf 1 2 3 4\n").indices == both);
        // Comments do not.
        CHECK(must_read("g.obj", four_obj + "f 1 2 3 # and" + j + "\nf 1 3 4\n").indices == both);
        CHECK(must_read("h.obj", four_obj + "# and" + j + "\nf 1 2 3 4\n").indices == both);
    }
}

TEST_CASE("OBJ: comments without a blank before them, and faces of format version 1") {
    const Indices both{0, 1, 2, 0, 2, 3};
    CHECK(must_read("a.obj", "v 0 0 0#a\nv 1 0 0# b\nv 1 1 0 #c\n#no\n#\nv 0 1 0\nf 1 2 3#comment\nf 1 3 4#").indices ==
          both);
    CHECK(must_read("b.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nfo 1 3 4\n").indices == both);
    CHECK(must_read("c.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nfo 1 2 3 4#f\n").indices == both);
}

TEST_CASE("OBJ: faces may reference normals and texture coordinates if the file has none at all") {
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (const char* face :
         {"f 1//1 2//2 3//3\n", "f 1/1/1 2/2/2 3/3/3\n", "f 1/7 2/7 3/7\n", "f -3//-3 -2//-2 -1//-1\n"}) {
        const Mesh mesh = must_read("a.obj", vertices + face);
        CHECK(mesh.indices == Indices{0, 1, 2});
        CHECK(attributes_of(mesh) == "POSITION:f32x3");
    }
    const Mesh mesh = must_read("b.obj", vertices + "vt 0 1\nf 1/1/1 2/1/2 3/1/3\n");
    CHECK(attributes_of(mesh) == "POSITION:f32x3 TEXCOORD_0:f32x2");
    CHECK(left_out("c.obj", vertices + "f 1/1/1 2/1/2 3//3\n") ==
          "2 references to texture coordinates, of which the file has none; "
          "3 references to normals, of which the file has none");
    // Normals may follow their faces.
    CHECK(attributes_of(must_read("d.obj", "f 1//1 2//1 3//1\n" + vertices + "vn 0 0 1\n")) ==
          "POSITION:f32x3 NORMAL:f32x3");
}

TEST_CASE("OBJ: the report names what is left out") {
    const std::string face = "f 1 2 3\n";
    CHECK(left_out("a.obj", "# plain\n" + four_obj + "vt 0 0\nvt 0 0 0\nvn 0 0 1\nf 1/1/1 2/2/1 3/1/1\nf 1 2 3 4\n")
              .empty());
    CHECK(left_out("b.obj", four_obj + "v 5 5 5 1\ns off\ns 0\ng\ng default\no\nusemtl\n" + face).empty());
    CHECK(left_out("c.obj", "mtllib a.mtl\nmtllib a.mtl\nmtllib b c.mtl\no one\no two\n" + four_obj +
                                "g a b\ng b\ns 1\nusemtl red hot\n" + face + "usemtl blue\n" + face +
                                "usemtl red hot # again\ns 2\ns 1\n" + face) ==
          "2 materials; 2 material libraries; 2 objects; 2 groups; 2 smoothing groups");
    CHECK(left_out("d.obj", four_obj + face +
                                "l 1 2\nl 2 3 4\np 1 2 \\\n 3\nvp 1\nvp 1 2\ncstype bezier\ndeg 3\n"
                                "curv 0 1 1 2 3 4\nparm u 0 1\nend\ncall other.obj\nhello there\n") ==
          "2 lines; 3 points; 1 curve or surface; 2 parameter-space vertices; 1 call of another file; "
          "1 unknown statement");
    CHECK(left_out("e.obj", four_obj + "v 0 0 1 2\nv 0 0 1 .5\nvt 0 0 1\nf 1 2\nf\n" + face) ==
          "2 vertex weights; 1 third texture coordinate; 2 faces with fewer than 3 corners");
    CHECK(left_out("f.obj", four_obj + "v 0 0 1 .5 .5 .5\n" + face) == "1 color (not every vertex has one)");
    CHECK(left_out("g.obj", "v 0 0 0 1 1 1\nv 1 0 0 1 1 1\nv 0 1 0 1 1 1\n" + face).empty());
    std::string many = four_obj;
    for (int i = 0; i < 10000; ++i) many += fmt::format("usemtl m{}\nf 1 2 3\n", i * i % 1000);
    CHECK(left_out("h.obj", many) == "159 materials");
}

TEST_CASE("infinities and NaNs in every spelling and text format") {
    const double infinity = std::numeric_limits<double>::infinity();
    const std::pair<const char*, double> numbers[] = {{"inf", infinity},
                                                      {"-INF", -infinity},
                                                      {"+Infinity", infinity},
                                                      {"-infinity", -infinity},
                                                      {"1.#INF", infinity},
                                                      {"-1.#INF", -infinity},
                                                      {"+1.#inf", infinity},
                                                      {"1.#INF00", infinity},
                                                      {"1.#INF000e+000", infinity},
                                                      {"-1.#INF0E-01", -infinity},
                                                      {"nan", NAN},
                                                      {"NaN", NAN},
                                                      {"-nan", NAN},
                                                      {"nan(ind)", NAN},
                                                      {"-nan(ind)", NAN},
                                                      {"-NAN(IND)", NAN},
                                                      {"nan(snan)", NAN},
                                                      {"-1.#IND", NAN},
                                                      {"1.#IND", NAN},
                                                      {"-1.#IND00", NAN},
                                                      {"1.#QNAN", NAN},
                                                      {"-1.#QNAN0", NAN},
                                                      {"1.#SNAN", NAN},
                                                      {"1.#qnan00e+00", NAN}};
    const auto same = [](float got, double expected) {
        return std::isnan(expected) ? std::isnan(got) : got == static_cast<float>(expected);
    };
    for (const auto& [word, value] : numbers) {
        CAPTURE_COPY(word);
        const std::string w = word;
        const Mesh obj =
            must_read("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn " + w + " 0 " + w + "# c\nf 1//1 2//1 3//1\n");
        CHECK(same(values_of<float>(obj, "NORMAL")[0], value));
        CHECK(values_of<float>(obj, "NORMAL")[1] == 0);
        CHECK(same(values_of<float>(obj, "NORMAL")[2], value));
        const Mesh off =
            must_read("a.off", "NOFF\n3 1 0\n0 0 0 " + w + " 0 " + w + "#c\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n");
        CHECK(same(values_of<float>(off, "NORMAL")[2], value));
        const Mesh ply = must_read("a.ply",
                                   "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                   "property float z\nproperty double q\nproperty float r\nelement face 1\n"
                                   "property list uchar int vertex_index\nend_header\n0 0 0 " +
                                       w + " " + w + "\n1 0 0 0 0\n0 1 0 0 0\n3 0 1 2\n");
        CHECK(same(static_cast<float>(values_of<double>(ply, "q")[0]), value));
        CHECK(same(values_of<float>(ply, "r")[0], value));
        CHECK(must_read("a.stl", "solid\nfacet normal " + w + " 0 " + w +
                                     "\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                                     "vertex 0 1 0\nendloop\nendfacet\nendsolid\n")
                  .triangle_count() == 1);
        // Positions must be finite.
        CHECK(!read_text("b.obj", "v 0 0 " + w + "\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
    }
    for (const char* word :
         {"1.#", "1.#IN", "1.#INFx", "2.#INF", "1#INF", "-1.#IND0e", "1.#IND1", "--1.#INF", "nan(", "infi"}) {
        CAPTURE(word);
        CHECK(!read_text("c.stl", fmt::format("solid\nfacet normal 0 0 {}\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                                              "vertex 0 1 0\nendloop\nendfacet\nendsolid\n",
                                              word)));
    }
}

TEST_CASE("polygons are cut into triangles that cover them, also where positions follow the faces") {
    const auto check = [&](const std::string& name, const std::string& text) {
        CAPTURE(name);
        CHECK(must_read(name, text).triangle_count() == 3);
        CHECK(must_read(name, text).indices ==
              must_read("first.obj", "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 1 2 3 4 5\n").indices);
    };
    const std::string points = "0 0 0\n4 0 0\n4 4 0\n2 1 0\n0 4 0\n";
    const std::string obj = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\n";
    check("a.obj", "f 1 2 3 4 5\n" + obj);
    check("b.obj", obj + "f -5 -4 -3 -2 -1\n");
    check("c.off", "OFF\n5 1 0\n" + points + "5 0 1 2 3 4\n");
    for (const char* type : {"float", "double"}) {
        const std::string vertex =
            fmt::format("element vertex 5\nproperty {0} x\nproperty {0} y\nproperty {0} z\n", type);
        const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
        const std::string head = "ply\nformat ascii 1.0\n";
        check("d.ply", head + vertex + face + "end_header\n" + points + "5 0 1 2 3 4\n");
        check("e.ply", head + face + vertex + "end_header\n5 0 1 2 3 4\n" + points);
    }
    INFO("v, vt and vn are reordered alike, and the triangles cover the polygon");
    const Mesh mesh = must_read("f.obj", obj +
                                             "vt 0 0\nvt 1 0\nvt 2 0\nvt 3 0\nvt 4 0\nvn 1 0 0\nvn 2 0 0\nvn 3 0 0\n"
                                             "vn 4 0 0\nvn 5 0 0\nf 1/1/1 2/2/2 3/3/3 4/4/4 5/5/5\n");
    const auto x = values_of<float>(mesh, "TEXCOORD_0"), n = values_of<float>(mesh, "NORMAL"),
               p = values_of<float>(mesh, "POSITION");
    CHECK(mesh.vertex_count == 5);
    for (std::size_t v = 0; v < 5; ++v) CHECK(x[2 * v] + 1 == n[3 * v]);
    double area = 0;
    for (std::size_t t = 0; t < 9; t += 3) {
        const float* a = &p[3 * mesh.indices[t]];
        const float* b = &p[3 * mesh.indices[t + 1]];
        const float* c = &p[3 * mesh.indices[t + 2]];
        const double own = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        CHECK(own > 0);
        area += own / 2;
    }
    CHECK(area == 10);
    INFO("polygons between triangles and strips keep their place");
    const Mesh mixed = must_read("g.ply",
                                 "ply\nformat ascii 1.0\nelement face 3\nproperty list uchar int vertex_indices\n"
                                 "element tristrips 1\nproperty list uchar int vertex_indices\nelement face 1\n"
                                 "property list uchar int vertex_indices\nelement vertex 5\nproperty float x\n"
                                 "property float y\nproperty float z\nend_header\n3 0 1 2\n2 0 1\n3 2 1 0\n"
                                 "5 0 1 2 -1 3\n4 1 2 3 0\n" +
                                     points);
    CHECK(mixed.indices == Indices{0, 1, 2, 2, 1, 0, 0, 1, 2, 1, 2, 3, 1, 3, 0});
}

TEST_CASE("OBJ: decimals are correctly rounded") {
    const Mesh mesh = must_read("r.obj",
                                "v 16777217 16777219 1.00000005960464477539062500\n"
                                "v 1.00000005960464477539062501 3.4028235e38 1e-45\n"
                                "v 7.0e-46 0.000000000000000000000000000000000000000000000000000001e54 -0\nf 1 2 3\n");
    CHECK(values_of<float>(mesh, "POSITION") ==
          Floats{16777216.0F, 16777220.0F, 1.0F, 1.00000011920928955F, 3.4028235e38F, 1e-45F, 0.0F, 1.0F, -0.0F});
}

TEST_CASE("OFF: attributes of vertices") {
    SUBCASE("none, with comments and colors of faces") {
        const Mesh mesh = must_read("a.off",
                                    "# first\nOFF # word\n# counts\n4 2 0\n0 0 0\n1 0 0 # c\n\n1 1 0\n0 1 0\n"
                                    "4 0 1 2 3 255 0 0\n3 0 1 2\n");
        CHECK(mesh.indices == Indices{0, 1, 2, 0, 2, 3, 0, 1, 2});
        CHECK(attributes_of(mesh) == "POSITION:f32x3");
        CHECK(must_read("b.off", "OFF 3 1 3\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2").indices == Indices{0, 1, 2});
        CHECK(must_read("c.off", "3 1\n0 0 0\n1 0 0\n0 1 0\n3 2 1 0").indices == Indices{2, 1, 0});
        CHECK(must_read("d.dat", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 2 1 0").vertex_count == 3);
    }
    SUBCASE("colors, normals and texture coordinates") {
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
    SUBCASE("colors of integers are bytes only if one is above 1") {
        const auto read = [](const std::string& a, const std::string& b) {
            return must_read("u.off", "COFF\n3 1 0\n0 0 0 " + a + "\n1 0 0 " + b + "\n0 1 0 " + b + "\n3 0 1 2\n");
        };
        CHECK(attributes_of(read("1 0 0 1", "0 1 0 1")) == "POSITION:f32x3 COLOR_0:f32x4");
        CHECK(values_of<float>(read("1 0 0 1", "0 1 0 1"), "COLOR_0")[3] == 1.0F);
        CHECK(attributes_of(read("1 0 0 2", "0 1 0 1")) == "POSITION:f32x3 COLOR_0:u8x4n");
        CHECK(attributes_of(read("255.0 0.0 0.0", "0 1 0")) == "POSITION:f32x3 COLOR_0:u8x3n");
        CHECK(attributes_of(read("255 0 0", "0 1 .5")) == "POSITION:f32x3 COLOR_0:f32x3");
        CHECK(attributes_of(read("256 0 0", "0 1 0")) == "POSITION:f32x3 COLOR_0:f32x3");
        CHECK(attributes_of(read("0 0 0", "0 0 0")) == "POSITION:f32x3 COLOR_0:f32x3");
    }
    SUBCASE("prefixes in any order; the values are in Geomview's order, or for NCOFF in MeshLab's") {
        const std::string tail =
            "\n3 1 0\n0 0 0 0 0 1 255 0 9 7\n1 0 0 0 0 1 255 0 9 7\n0 1 0 0 0 1 255 0 9 7\n3 0 1 2\n";
        for (const char* word : {"CNOFF", "NCOFF"}) {
            const Mesh mesh = must_read("n.off", word + tail);
            CHECK(values_of<float>(mesh, "NORMAL")[2] == 1.0F);
            CHECK(values_of<std::uint8_t>(mesh, "COLOR_0")[0] == 255);
        }
        const std::string meshlab =
            "\n3 1 0\n0 0 0 255 0 9 7 0 0 1\n1 0 0 0 0 0 255 -.6 0 .8\n0 1 0 255 0 9 7 0 0 1\n3 0 1 2\n";
        const Mesh mesh = must_read("m.off", "NCOFF" + meshlab);
        CHECK(values_of<std::uint8_t>(mesh, "COLOR_0")[2] == 9);
        CHECK(values_of<float>(mesh, "NORMAL")[3] == -.6F);
        const Mesh textured = must_read("t.off",
                                        "NCSTOFF\n3 1 0\n0 0 0 255 0 9 7 0 0 1 .5 .25\n1 0 0 255 0 9 7 0 0 1 .5 .25\n"
                                        "0 1 0 255 0 9 7 0 0 1 .5 .25\n3 0 1 2\n");
        CHECK(attributes_of(textured) == "POSITION:f32x3 NORMAL:f32x3 TEXCOORD_0:f32x2 COLOR_0:u8x4n");
        CHECK(values_of<float>(textured, "TEXCOORD_0")[1] == .25F);
        CHECK(values_of<float>(textured, "NORMAL")[2] == 1.0F);
        const std::string st = "3 1 0\n0 0 0 .5 .25\n1 0 0 .5 .25\n0 1 0 .5 .25\n3 0 1 2\n";
        CHECK(attributes_of(must_read("s.off", "STOFF " + st)) == "POSITION:f32x3 TEXCOORD_0:f32x2");
        CHECK(attributes_of(must_read("s.off", "SSTOFF" + st)) == "POSITION:f32x3 TEXCOORD_0:f32x2");
        CHECK(attributes_of(
                  must_read("s.off", "CSTOFF 3 1\n0 0 0 1 1 1 0 0\n1 0 0 1 1 1 0 0\n0 1 0 1 1 1 0 0\n3 0 1 2\n")) ==
              "POSITION:f32x3 TEXCOORD_0:f32x2 COLOR_0:f32x3");
    }
}

TEST_CASE("OFF: numbers may be on any lines") {
    SUBCASE("counts after the word without a blank, on several lines, and without edges") {
        for (const char* head :
             {"OFF3 1 0\n", "OFF 3 1 0\n", "OFF3 1\n", "OFF\n3 1\n", "OFF3\n1\n0\n", "OFF\n3\n1\n0\n", "3\n1\n0\n",
              "OFF# c\n3 1#c\n", "OFF\n\n3 #c\n\n1\n#c\n0 #c\n\n", "\n#c\nOFF3 1 0 #\n", "3 1 0\r\n"}) {
            CAPTURE(head);
            CHECK(must_read("c.off", head + std::string("0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")).indices == Indices{0, 1, 2});
        }
        CHECK(must_read("d.dat", "COFF3 1 0\n0 0 0 1 1 1\n1 0 0 1 1 1\n0 1 0 1 1 1\n3 0 1 2\n").vertex_count == 3);
        CHECK(!read_text("e.dat", "OFFSET 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
    }
    SUBCASE("vertices and faces on several lines, several vertices on a line, comments and blank lines") {
        const Indices quad{0, 1, 2, 0, 2, 3};
        const std::string faces = "4 0 1 2 3\n";
        for (const char* vertices :
             {"0 0 0\n1 0 0\n1 1 0\n0 1 0\n", "0 0\n0\n1\n0 0\n1 1 0\n0 1\n0\n", "0 0 0 1 0 0\n1 1 0 0 1 0\n",
              "0 0 0 1\n0 0 1 1 0 0 1\n0\n", "# c\n0 0 0#c\n\n#\n1 0 0 # d\n1 1 0\n\n\n0 1 0\n#e\n"}) {
            CAPTURE(vertices);
            CHECK(must_read("v.off", "OFF 4 1 0\n" + (vertices + faces)).indices == quad);
            CHECK(must_read("v.off", "OFF 4 1 0\n" + (vertices + faces)).vertex_count == 4);
        }
        const std::string vertices = "OFF 4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
        for (const char* text :
             {"4 0 1 2 3\n3 0 1 2\n", "4 0 1\n2 3\n3\n0 1 2\n", "4\n0\n1\n2\n3\n\n3 0 1 2",
              "4 0 1 2\n3 255 0 0\n3 0 1 2 .5 .5 .5\n", "4 0 #c\n#d\n1 2 3 1 2 3 4\n\n# e\n3 0 1 2\n"}) {
            CAPTURE(text);
            CHECK(must_read("f.off", vertices + text).indices == Indices{0, 1, 2, 0, 2, 3, 0, 1, 2});
        }
        const Mesh colored =
            must_read("g.off", "COFF 3 1 0\n0 0 0\n255 0 0 1\n1 0 0\n255 0 0 1\n0 1 0\n255 0 0 1\n3 0 1 2\n");
        CHECK(attributes_of(colored) == "POSITION:f32x3 COLOR_0:u8x4n");
        const Mesh three = must_read(
            "h.off", "CNOFF 3 1 0\n0 0 0\n0 0 1\n255 0 0\n1 0 0\n0 0 1\n255 0 0\n0 1 0\n0 0 1\n255 0 0\n3 0 1 2\n");
        CHECK(attributes_of(three) == "POSITION:f32x3 NORMAL:f32x3 COLOR_0:u8x3n");
    }
}

TEST_CASE("OFF: the report names what is left out, and binary and 4D files are refused") {
    SUBCASE("the report names what is left out") {
        const std::string vertices = "OFF 4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
        CHECK(left_out("l.off", vertices + "4 0 1 2 3\n3 0 1 2\n").empty());
        CHECK(left_out("l.off", vertices + "4 0 1 2 3 9\n3 0 1 2 1 2 3\n") == "2 colors of faces");
        CHECK(left_out("l.off", vertices + "4 0 1 2 3\n2 0 1\n") == "1 face with fewer than 3 corners");
        CHECK(left_out("l.off", vertices + "4 0 1 2 3\n3 0 1 2\n# end\n7") == "1 byte after the last face");
        CHECK(left_out("l.off", "OFF 3 1 0\n0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 0\n3 0 1 2\n") ==
              "3 vertices with numbers after their own");
    }
    SUBCASE("binary and 4D files are refused") {
        CHECK(read_text("g.off", "OFF BINARY\n").error().code == ErrorCode::unsupported);
        CHECK(read_text("h.off", "4OFF\n1 1 1\n").error().code == ErrorCode::unsupported);
    }
}

TEST_CASE("STL: corners at one position are one vertex") {
    const Floats corners{0, 0, 0, 1, 0,           0, 0, 1, 0, /* */ 1, 0, 0, 1, 1,
                         0, 0, 1, 0, /* */ -0.0F, 0, 0, 1, 0, 0,       1, 1, 0};
    const Indices indices{0, 1, 2, 1, 3, 2, 0, 1, 3};
    for (const char* title : {"binary", "solid but binary", ""}) {
        const Mesh mesh = must_read("a.stl", binary_stl(corners, title));
        CHECK(mesh.indices == indices);
        CHECK(mesh.vertex_count == 4);
        CHECK(attributes_of(mesh) == "POSITION:f32x3");
    }
    CHECK(must_read("b.stl", binary_stl(corners) + "trailing").indices == indices);
    CHECK(left_out("b.stl", binary_stl(corners) + "trailing") == "8 bytes after the last triangle");
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
    CHECK(must_read("e.stl", "\xEF\xBB\xBF" + text).indices == indices);
    CHECK(must_read("no-extension", "\xEF\xBB\xBF" + text).indices == indices);
    // The title of a binary file is any 80 bytes.
    CHECK(must_read("f.stl", binary_stl(corners, "\xEF\xBB\xBFsolid")).indices == indices);
    CHECK(must_read("no-extension", binary_stl(corners, "\xEF\xBB\xBF")).indices == indices);
}

TEST_CASE("STL: a vertex has the bits of its first corner; the report names colors") {
    const Floats corners{-0.0F, 0, 0, 1, 0, 0, 0, 1, -0.0F, 0, 0, 0, 0, 1, 0, 1, 0, -0.0F};
    for (const std::string& file :
         {binary_stl(corners),
          std::string("solid\nfacet normal 0 0 1\nouter loop\nvertex -0 0 0\n"
                      "vertex 1 0 0\nvertex 0 1 -0\nendloop\nendfacet\nfacet normal 0 0 -1\nouter loop\n"
                      "vertex 0 0 0\nvertex 0 1 0\nvertex 1 0 -0\nendloop\nendfacet\nendsolid\n")}) {
        const Mesh mesh = must_read("a.stl", file);
        CHECK(mesh.indices == Indices{0, 1, 2, 0, 2, 1});
        const auto position = values_of<float>(mesh, "POSITION");
        CHECK(std::signbit(position[0]));
        CHECK(!std::signbit(position[5]));
        CHECK(std::signbit(position[8]));
        CHECK(left_out("b.stl", file).empty());
    }
    std::string colored = binary_stl(corners);
    colored[84 + 49] = '\x7F';
    CHECK(left_out("c.stl", colored) == "1 color or attribute of a triangle");
    colored[84 + 50 + 48] = '\1';
    CHECK(left_out("c.stl", colored) == "2 colors or attributes of triangles");
}

TEST_CASE("the format is found by content before extension") {
    CHECK(must_read("really.obj",
                    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                    "property float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n"
                    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
              .triangle_count() == 1);
    CHECK(must_read("really.ply", "\xEF\xBB\xBFOFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").triangle_count() == 1);
    CHECK(read_text("what.xyz", "v 0 0 0\n").error().code == ErrorCode::unsupported);
}

TEST_CASE("the meshes of LACEDRING_MESHES, where it is set, have the triangles of their index") {
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
        // The index counts the triangles of meshes once; this file places its wheels twice.
        const std::size_t instanced = fields[0] == "CesiumMilkTruck.glb" ? 768 : 0;
        CHECK(mesh->triangle_count() == std::stoull(fields[4]) + instanced);
        const bool has_file_vertices =
            fields[3].starts_with("ply") || fields[3].starts_with("off") || fields[3].starts_with("stl");
        if (has_file_vertices) CHECK(mesh->vertex_count == std::stoull(fields[5]));
    }
}
