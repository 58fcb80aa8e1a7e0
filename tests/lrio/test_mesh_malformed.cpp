// Malformed and hostile mesh files: read_mesh returns an error or a sound mesh for any bytes.
#include <doctest/doctest.h>

#include <chrono>
#include <random>

#include "lacedring/mesh_files.hpp"
#include "tests/lrio/mesh_files.h"

using namespace lacedring;
using namespace lacedring::test;

namespace {

struct Sample {
    std::string name;
    std::string bytes;
};

std::string ply_header(const std::string& format) {
    return "ply\nformat " + format +
           " 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
           "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 2\n"
           "property list uchar int vertex_indices\nelement tristrips 1\nproperty list int int "
           "vertex_indices\nend_header\n";
}

std::string binary_ply(bool big) {
    std::string out = ply_header(big ? "binary_big_endian" : "binary_little_endian");
    for (int v = 0; v < 4; ++v) {
        for (int i = 0; i < 3; ++i) put(out, static_cast<float>((v >> i) & 1), big);
        out += "\x01\x02\x03";
    }
    for (const int count : {3, 4}) {
        put(out, static_cast<std::uint8_t>(count));
        for (int i = 0; i < count; ++i) put(out, std::int32_t{i}, big);
    }
    for (const int value : {5, 0, 1, 2, -1, 3}) put(out, std::int32_t{value}, big);
    return out;
}

/// One valid file of a few hundred bytes in every format.
std::vector<Sample> samples() {
    std::vector<Sample> out;
    const std::string vertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
    out.push_back({"s.ply", ply_header("ascii") +
                                "0 0 0 1 2 3\n1 0 0 1 2 3\n1 1 0 1 2 3\n0 1 0 1 2 3\n3 0 1 2\n4 0 1 2 3\n"
                                "5 0 1 2 -1 3\n"});
    out.push_back({"l.ply", binary_ply(false)});
    out.push_back({"b.ply", binary_ply(true)});
    out.push_back({"s.obj",
                   "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 1 1 0 1 0 0\nv 0 1 0 1 0 0\nvt 0 0\nvn 0 0 1\n"
                   "f 1/1/1 2/1/1 3/1/1 \\\n 4/1/1\nf -1//1 -2//1 -3//1\nf 1 2 3\n# end\n"});
    out.push_back({"s.off", "OFF\n4 2 0\n" + vertices + "3 0 1 2\n4 0 1 2 3 255 0 0\n"});
    out.push_back({"c.off", "CNOFF\n3 1 0\n0 0 0 0 0 1 255 0 0\n1 0 0 0 0 1 0 0 0\n0 1 0 0 0 1 1 2 3\n3 0 1 2\n"});
    out.push_back({"a.stl",
                   "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                   "endfacet\nendsolid x\n"});
    out.push_back({"b.stl", binary_stl(Floats{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0})});
    Mesh mesh = must_read("s.off", out[4].bytes);
    Attribute color{"COLOR_0", ComponentType::u8, 3, true, std::vector<std::byte>(12)};
    mesh.attributes.push_back(color);
    REQUIRE(write_mesh(mesh, folder() / "w.glb").has_value());
    std::ifstream file(folder() / "w.glb", std::ios::binary);
    out.push_back({"s.glb", std::string((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>())});
    out.push_back({"s.gltf", R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0,"scale":[1,2,-3],"children":[1]},
{"mesh":0,"rotation":[0,0,0,1]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":4}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,"indices":
{"bufferView":0,"componentType":5121},"values":{"bufferView":0,"byteOffset":12}}}],"images":[{"uri":"a.png"}],
"bufferViews":[{"buffer":0,"byteLength":36,"byteStride":12}],"extras":{"a":[1,[2,3]]},
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})"});
    return out;
}

/// Reads a file. Whether the mesh is sound, or the error a short line of printable ASCII.
bool survives(const Sample& sample) {
    const auto mesh = read_text(sample.name, sample.bytes);
    if (mesh) return is_sound(*mesh);
    const std::string& message = mesh.error().message;
    const bool one_line = std::all_of(message.begin(), message.end(), [](char c) { return c >= ' ' && c <= '~'; });
    return one_line && !message.empty() && message.size() < 500;
}

Error error_of(const std::string& name, const std::string& bytes) {
    const auto mesh = read_text(name, bytes);
    CAPTURE(bytes);
    REQUIRE(!mesh);
    return mesh.error();
}

std::string message_of(const std::string& name, const std::string& bytes) {
    return error_of(name, bytes).message;
}

}  // namespace

TEST_CASE("the samples are valid") {
    for (const Sample& sample : samples()) {
        CAPTURE(sample.name);
        CHECK(is_sound(must_read(sample.name, sample.bytes)));
    }
}

TEST_CASE("files cut at every byte are refused or read as a sound mesh") {
    for (const Sample& sample : samples()) {
        for (std::size_t length = 0; length < sample.bytes.size(); ++length) {
            CAPTURE(sample.name);
            CAPTURE(length);
            REQUIRE(survives({sample.name, sample.bytes.substr(0, length)}));
        }
    }
}

TEST_CASE("files with bytes changed, removed and repeated are refused or read as a sound mesh") {
    const std::uint32_t seed = 4711;
    CAPTURE(seed);
    std::mt19937 random(seed);
    const std::string alphabet = "0123456789-+.eE/\\ \n\r\t{}[]\":,#\0\x01\x7F\xFF";
    for (const Sample& sample : samples()) {
        for (int round = 0; round < 3000; ++round) {
            Sample changed = sample;
            const std::size_t changes = 1 + random() % 4;
            for (std::size_t i = 0; i < changes && !changed.bytes.empty(); ++i) {
                const std::size_t at = random() % changed.bytes.size();
                switch (random() % 5) {
                    case 0:
                        changed.bytes[at] = static_cast<char>(random());
                        break;
                    case 1:
                        changed.bytes[at] = static_cast<char>(changed.bytes[at] ^ (1 << random() % 8));
                        break;
                    case 2:
                        changed.bytes[at] = alphabet[random() % alphabet.size()];
                        break;
                    case 3:
                        changed.bytes.erase(at, 1 + random() % 8);
                        break;
                    default:
                        changed.bytes.insert(at, changed.bytes, random() % changed.bytes.size(), random() % 12);
                        break;
                }
            }
            CAPTURE(sample.name);
            CAPTURE(round);
            REQUIRE(survives(changed));
        }
    }
}

TEST_CASE("text files with numbers replaced are refused or read as a sound mesh") {
    const std::uint32_t seed = 1234;
    CAPTURE(seed);
    std::mt19937 random(seed);
    const std::vector<std::string> numbers{"-1",
                                           "0",
                                           "4294967295",
                                           "4294967294",
                                           "4294967296",
                                           "18446744073709551615",
                                           "1e9",
                                           "18446744073709551616",
                                           "-9223372036854775808",
                                           "1e400",
                                           "nan",
                                           "-inf",
                                           "2147483648",
                                           "99999999999999999999999999",
                                           "1e-400",
                                           "0x10",
                                           "3.5",
                                           "",
                                           "1073741824"};
    for (const Sample& sample : samples()) {
        for (int round = 0; round < 1000; ++round) {
            Sample changed = sample;
            const std::size_t from = changed.bytes.find_first_of("0123456789", random() % changed.bytes.size());
            if (from == std::string::npos) continue;
            const std::size_t to = std::min(changed.bytes.find_first_not_of("0123456789", from), changed.bytes.size());
            changed.bytes.replace(from, to - from, numbers[random() % numbers.size()]);
            CAPTURE(sample.name);
            CAPTURE(round);
            REQUIRE(survives(changed));
        }
    }
}

TEST_CASE("the bytes of another format than the name's, and noise, are refused or read as a sound mesh") {
    const std::uint32_t seed = 5;
    CAPTURE(seed);
    std::mt19937 random(seed);
    for (const Sample& bytes : samples()) {
        for (const Sample& name : samples()) CHECK(survives({name.name, bytes.bytes}));
    }
    for (const Sample& name : samples()) {
        for (int round = 0; round < 100; ++round) {
            std::string noise(random() % 300, '\0');
            for (char& c : noise) c = static_cast<char>(random());
            CHECK(survives({name.name, noise}));
        }
    }
}

TEST_CASE("folders, missing files and empty files are refused") {
    CHECK(read_mesh(folder() / "missing.ply").error().code == ErrorCode::cannot_open);
    CHECK(read_mesh(folder()).error().code == ErrorCode::cannot_open);
    for (const char* name : {"e.ply", "e.obj", "e.off", "e.stl", "e.glb", "e.gltf", "e"}) {
        CHECK(error_of(name, "").code == ErrorCode::malformed);
    }
}

TEST_CASE("counts beyond the bytes of the file are refused at once") {
    const auto start = std::chrono::steady_clock::now();
    const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
    const std::string faces = "property list uchar int vertex_indices\n";
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
        const std::string head = fmt::format("ply\nformat {} 1.0\n", format);
        for (const char* count : {"4000000000", "4294967294", "5000000000", "18446744073709551615"}) {
            CHECK(!read_text("h.ply", head + "element vertex " + count + "\n" + xyz + "end_header\n0 0 0\n"));
            CHECK(!read_text(
                "h.ply", head + "element vertex 0\n" + xyz + "element face " + count + "\n" + faces + "end_header\n"));
            CHECK(!read_text("h.ply", head + "element vertex 0\n" + xyz + "element none " + count + "\nend_header\n"));
            CHECK(!read_text("h.ply", head + "element none " + count + "\nproperty int i\nelement vertex 0\n" + xyz +
                                          "end_header\n"));
        }
    }
    CHECK(error_of("h.ply", "ply\nformat ascii 1.0\nelement vertex 4294967295\n" + xyz + "end_header\n").code ==
          ErrorCode::too_large);
    CHECK(!read_text("h.ply", "ply\nformat ascii 1.0\nelement vertex 1\n" + xyz +
                                  "element face 1\n"
                                  "property list uint uint vertex_indices\nend_header\n0 0 0\n4294967295 0 0 0\n"));
    for (const char* counts :
         {"4000000000 1 0", "1 4000000000 0", "18446744073709551615 18446744073709551615 0", "-1 1 0"}) {
        CHECK(!read_text("h.off", fmt::format("OFF\n{}\n0 0 0\n3 0 0 0\n", counts)));
    }
    CHECK(!read_text("h.off", "OFF\n1 1 0\n0 0 0\n18446744073709551615 0 0 0\n"));
    std::string stl(84, '\0');
    stl.replace(80, 4, "\xFF\xFF\xFF\xFF");
    CHECK(message_of("h.stl", stl).find("4294967295") != std::string::npos);
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(60));
}

TEST_CASE("PLY errors name the line and the cause") {
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    SUBCASE("an index out of range") {
        CHECK(message_of("m.ply", ply + "0 0 0\n1 0 0\n0 0 0\n3 0 1 3\n") ==
              "line 13: face 0: index 3 is out of range (3 vertices)");
        CHECK(message_of("m.ply", ply + "0 0 0\n1 0 0\n0 0 0\n3 0 1 -1\n") ==
              "line 13: face 0: index -1 is out of range (3 vertices)");
    }
    SUBCASE("a value that is not a finite number") {
        CHECK(message_of("m.ply", ply + "0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n") == "line 12: vertex 2: 'y' is not finite");
        CHECK(message_of("m.ply", ply + "0 0 0\n1 zero 0\n0 0 0\n3 0 1 2\n") ==
              "line 11: vertex 1: 'zero' is not a number of its type");
    }
    SUBCASE("a line that ends early") {
        CHECK(message_of("m.ply", ply + "0 0 0\n1 0\n0 0 0\n3 0 1 2\n") == "line 11: the line ends in vertex 1");
        CHECK(message_of("m.ply", ply + "0 0 0\n1 0 0\n0 0 0\n3 0 1\n") == "line 13: the line ends in face 0");
    }
    SUBCASE("a first line that is not 'ply'") {
        CHECK(message_of("m.ply", "hello\n") == "line 1: does not begin with 'ply'");
        CHECK(message_of("m.ply", "plyx\nformat ascii 1.0\nend_header\n") == "line 1: does not begin with 'ply'");
    }
    SUBCASE("a bad header") {
        CHECK(message_of("m.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nend_header\n1 2 3\n") ==
              "line 3: the vertices have no x, y and z");
        CHECK(message_of("m.ply",
                         "ply\nformat ascii 1.0\nelement vertex 3\nelement face 1\nproperty list uchar int "
                         "vertex_index\nend_header\n3 0 1 2\n") == "line 3: the vertices have no x, y and z");
        CHECK(message_of("m.ply", "ply\nformat ascii 1.0\nelement vertex x\n") ==
              "line 3: 'x' is not a number of elements");
        CHECK(message_of("m.ply", "ply\nelement vertex 1\nproperty long x\n") == "line 3: 'long' is not a type");
        CHECK(error_of("m.ply", "ply\nformat binary_middle_endian 1.0\nend_header\n").code == ErrorCode::unsupported);
    }
    SUBCASE("no triangles") {
        CHECK(message_of("m.ply", ply + "0 0 0\n1 0 0\n0 0 0\n2 0 1\n") == "has no triangles");
    }
}

TEST_CASE("OBJ errors name the line and the cause") {
    SUBCASE("a vertex, normal or texture coordinate that does not exist") {
        CHECK(message_of("m.obj", "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 4\n\n") ==
              "line 4: vertex 4 does not exist (there are 3)");
        CHECK(message_of("m.obj", "v 0 0 0\nf 1//1 1//1 1//2\nvn 0 0 1\n") ==
              "line 2: normal 2 does not exist (there are 1)");
        CHECK(message_of("m.obj", "v 0 0 0\nf 1/2/1 1/1/7 1\nvn 0 0 1\nvt 0 0\n") ==
              "line 2: texture coordinate 2 does not exist (there are 1)");
        CHECK(message_of("m.obj", "v 0 0 0\nf 1 1 1\nf 1//-1 1//-1 1//-1\nvn 0 0 1\n") ==
              "line 3: normal -1 does not exist (there are 0 before it)");
        CHECK(message_of("m.obj", "f 1 2 3\n") == "line 1: vertex 1 does not exist (there are 0)");
    }
    SUBCASE("the first reference that does not exist, not the highest") {
        CHECK(message_of("m.obj", "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 4\nf 1 2 9\nf 1 2 5\n") ==
              "line 4: vertex 4 does not exist (there are 3)");
        CHECK(message_of("m.obj", "v 0 0 0\nf 1//1 1//3 1//2\nf 1//9 1 1\nvn 0 0 1\n") ==
              "line 2: normal 3 does not exist (there are 1)");
    }
    SUBCASE("a corner that is not v, v/vt, v//vn or v/vt/vn") {
        CHECK(message_of("m.obj", "v 0 0 0\nvn 0 0 1\nf 1//-1 1//-1 1//-2\n") ==
              "line 3: '1//-2' is not a corner of a face");
        CHECK(message_of("m.obj", "v 0 0 0\nf 1 1\\1 1\n") == "line 2: '1\\1' is not a corner of a face");
        CHECK(message_of("m.obj", "v 0 0 0\nf 1 1 1\\ 1\n") == "line 2: '1\\' is not a corner of a face");
        CHECK(message_of("m.obj", "v 0 0 0\nf 1 1 -2\n") == "line 2: '-2' is not a corner of a face");
        CHECK(message_of("m.obj", "v 0 0 0\nf 1 1 0\n") == "line 2: '0' is not a corner of a face");
        for (const char* face : {"f 1 1 \\ 1\n", "f 1 1 1 \\", "f 1 1 1 \\ #\n1\n", "f 1 1 1 \\ \\ \n1\n"}) {
            CHECK(message_of("m.obj", std::string("v 0 0 0\n") + face) == "line 2: '\\' is not a corner of a face");
        }
    }
    SUBCASE("a number that is missing, none or not finite") {
        CHECK(message_of("m.obj", "v 0 0 0\nv 0 0 0\nv 0 0 inf\n") == "line 3: vertex 3 is not finite");
        CHECK(message_of("m.obj", "v 0 0 \\ 0\n") == "line 1: '\\' is not a number");
        CHECK(message_of("m.obj", "v 0 0 0\r\nv 0 0\r\n") == "line 2: 2 numbers where 3 are due");
        CHECK(message_of("m.obj", "v 0 0 \x1B[2J\n") == "line 1: '?[2J' is not a number");
    }
    SUBCASE("no triangles") {
        CHECK(message_of("m.obj", "v 0 0 0\n") == "has no triangles");
    }
}

TEST_CASE("OFF errors name the line and the cause") {
    SUBCASE("an index out of range") {
        CHECK(message_of("m.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n") ==
              "line 6: face 0: index 3 is out of range (3 vertices)");
        CHECK(message_of("m.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n4 0 1 2\n3 0 1 2\n") ==
              "line 7: face 0: index 3 is out of range (3 vertices)");
    }
    SUBCASE("a missing number or color, or a number that is not finite") {
        CHECK(message_of("m.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 nan\n3 0 1 2\n") == "line 5: vertex 2 is not finite");
        CHECK(message_of("m.off", "COFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n") ==
              "line 3: 0 numbers where a color is due");
        CHECK(message_of("m.off", "OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n") == "line 4: ends before a number");
    }
}

TEST_CASE("STL errors name the line or triangle and the cause") {
    SUBCASE("another word than is due") {
        CHECK(message_of("m.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 x\n") ==
              "line 4: 'x' where a number is due");
        CHECK(message_of("m.stl", "solid\nfacet normal\nouter loop\nvertex 0 0 0\n") ==
              "line 3: 'outer' where a number is due");
        CHECK(message_of("m.stl", "solid\nfacet normal 0 0\nouter loop\nvertex 0 0 0\n") ==
              "line 3: 'outer' where a number is due");
        CHECK(message_of("m.stl", "solid\nfacet\nouter loop\nvertex 0 0 0\n") ==
              "line 3: 'outer' where 'normal' is due");
    }
    SUBCASE("no triangles, or a vertex that is not finite") {
        CHECK(message_of("m.stl", "solid\nendsolid\n") == "has no triangles");
        CHECK(message_of("m.stl", binary_stl(Floats{0, 0, 0, 1, 0, std::nanf(""), 0, 1, 0})) ==
              "triangle 0: vertex 1 is not finite");
    }
}
