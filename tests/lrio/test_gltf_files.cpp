// Tests which files a glTF may open, and reading of unusual glTF files.
#include <doctest/doctest.h>
#include <sys/stat.h>

#include "tests/lrio/gltf_maker.h"
#include "tests/support/capture.h"

using namespace lacedring;
using namespace lacedring::test;

namespace fs = std::filesystem;

namespace {

/// A triangle whose positions are in the buffer `uri`.
std::string triangle_in(const std::string& uri, std::size_t byte_length = 36, const std::string& more_buffers = "") {
    return R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
           R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)"
           R"("bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{)" +
           (uri.empty() ? "" : "\"uri\":\"" + uri + "\",") + "\"byteLength\":" + std::to_string(byte_length) + "}" +
           more_buffers + "]}";
}

const std::string kPositions = packed<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});

Result<Mesh> read_named(const fs::path& path, const std::string& content, const ReadOptions& options = {},
                        ReadReport* report = nullptr) {
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << content;
    return read_mesh(path, options, report);
}

std::string message(const Result<Mesh>& mesh) {
    return mesh ? "" : mesh.error().message;
}

}  // namespace

TEST_CASE("glTF: a buffer outside the folder is opened only with allow_outside") {
    const fs::path inner = folder() / "outside" / "inner";
    fs::create_directories(inner / "sub");
    write_text("outside/secret.bin", kPositions);
    write_text("outside/inner/own.bin", kPositions);
    write_text("outside/inner/sub/below.bin", kPositions);
    fs::create_symlink("../secret.bin", inner / "link.bin");
    fs::create_directory_symlink("..", inner / "up");
    fs::create_symlink("sub/below.bin", inner / "link-inside.bin");
    const std::string absolute = (folder() / "outside" / "secret.bin").string();
    for (const std::string& uri :
         {std::string("../secret.bin"), std::string("%2e%2e/secret.bin"), std::string("sub/../../secret.bin"),
          std::string("link.bin"), std::string("up/secret.bin"), absolute, "%2F" + absolute.substr(1)}) {
        CAPTURE(uri);
        const auto refused = read_named(inner / "a.gltf", triangle_in(uri));
        CHECK(message(refused).find("leaves the folder") != std::string::npos);
        const auto permitted = read_named(inner / "a.gltf", triangle_in(uri), {.allow_outside = true});
        CHECK(message(permitted) == "");
    }
    for (const char* uri : {"own.bin", "sub/below.bin", "sub/../own.bin", "./own.bin", "../inner/own.bin",
                            "link-inside.bin", "%6Fwn.bin"}) {
        CAPTURE(uri);
        CHECK(message(read_named(inner / "a.gltf", triangle_in(uri))) == "");
    }
    // The path "outside/inner.bin" begins with the glTF's folder "outside/inner", but is not in it.
    write_text("outside/inner.bin", kPositions);
    CHECK(!read_named(inner / "a.gltf", triangle_in("../inner.bin")));
}

TEST_CASE("glTF: only regular files are opened, and no URI with a scheme") {
    const fs::path pipe = folder() / "pipe.bin";
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    const ReadOptions outside{.allow_outside = true};
    for (const char* uri : {"pipe.bin", "/dev/zero", "/proc/self/environ", "/proc/self/mem", "."}) {
        CAPTURE(uri);
        CHECK(!read_named(folder() / "a.gltf", triangle_in(uri), outside));
    }
    for (const char* uri : {"http://example.org/a.bin", "file:///etc/passwd", "HTTPS://x/y", "a%00b.bin"}) {
        CAPTURE(uri);
        CHECK(!read_named(folder() / "a.gltf", triangle_in(uri), outside));
    }
    fs::remove(pipe);
    // The path of the mesh, too, must name a regular file.
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    for (const char* path : {pipe.c_str(), "/dev/zero", "/dev/null", "/proc/self/environ", "/proc/self/status"}) {
        CAPTURE(path);
        const auto mesh = read_mesh(path);
        REQUIRE(!mesh);
        CHECK(mesh.error().code == ErrorCode::cannot_open);
        CHECK(mesh.error().message == "is not a regular file");
    }
    fs::remove(pipe);
}

TEST_CASE("glTF: each file of a used buffer is opened once") {
    write_text("own.bin", kPositions + std::string(1000, 'x'));
    SUBCASE("a file longer than byteLength is read") {
        ReadReport report;
        CHECK(message(read_named(folder() / "a.gltf", triangle_in("own.bin"), {}, &report)) == "");
        REQUIRE(report.files.size() == 1);
        CHECK(report.files.front().filename() == "own.bin");
    }
    SUBCASE("a file shorter than byteLength is refused") {
        const auto mesh = read_named(folder() / "a.gltf", triangle_in("own.bin", 2000));
        CHECK(message(mesh).find("byteLength is 2000") != std::string::npos);
    }
    SUBCASE("the file of an unused buffer may be missing, outside the folder or without a URI") {
        for (const char* more : {R"(,{"byteLength":100})", R"(,{"byteLength":100,"uri":"absent.bin"})",
                                 R"(,{"byteLength":100,"uri":"/etc/passwd"})", R"(,{"byteLength":9,"uri":"data:x"})"}) {
            ReadReport report;
            CHECK(message(read_named(folder() / "a.gltf", triangle_in("own.bin", 36, more), {}, &report)) == "");
            CHECK(report.files.size() == 1);
        }
    }
    SUBCASE("a thousand buffers of growing byteLength in one file") {
        constexpr int kBuffers = 1000;
        std::string json = R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[)";
        std::string accessors, views, buffers;
        for (int i = 0; i < kBuffers; ++i) {
            const char* comma = i == 0 ? "" : ",";
            json += fmt::format(R"({}{{"attributes":{{"POSITION":{}}}}})", comma, i);
            accessors += fmt::format(R"({}{{"bufferView":{},"componentType":5126,"count":3,"type":"VEC3"}})", comma, i);
            views += fmt::format(R"({}{{"buffer":{},"byteLength":36}})", comma, i);
            buffers += fmt::format(R"({}{{"uri":"own.bin","byteLength":{}}})", comma, 36 + i);
        }
        json +=
            R"(]}],"accessors":[)" + accessors + R"(],"bufferViews":[)" + views + R"(],"buffers":[)" + buffers + "]}";
        ReadReport report;
        const auto mesh = read_named(folder() / "a.gltf", json, {}, &report);
        CHECK(message(mesh) == "");
        CHECK(mesh->triangle_count() == kBuffers);
        CHECK(report.files.size() == 1);
    }
    SUBCASE("images are not opened") {
        ReadReport report;
        std::string json = triangle_in("own.bin");
        json.insert(1, R"("images":[{"uri":"../../etc/passwd"},{"uri":7},{"bufferView":99},5],)");
        CHECK(message(read_named(folder() / "a.gltf", json, {}, &report)) == "");
        CHECK(report.files.size() == 1);
        REQUIRE(report.left_out.size() == 1);
        CHECK(report.left_out.front() == "4 images");
    }
}

TEST_CASE("glTF: URIs with blanks, percent signs and percent-encoded bytes") {
    for (const auto& [name, uri] :
         {std::pair("ten 10%.bin", "ten 10%.bin"), std::pair("a b.bin", "a%20b.bin"), std::pair("100%", "100%"),
          std::pair("5%2.bin", "5%2.bin"), std::pair("%zz.bin", "%zz.bin"), std::pair("\xC3\xA4.bin", "%C3%A4.bin")}) {
        CAPTURE_COPY(uri);
        write_text(name, kPositions);
        CHECK(message(read_named(folder() / "a.gltf", triangle_in(uri))) == "");
    }
}

TEST_CASE("glTF: data URIs in base64 and percent-encoding are read, malformed ones refused") {
    const std::string base64 = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    for (const std::string& uri : {"data:application/octet-stream;base64," + base64, "data:;base64," + base64,
                                   "DATA:text/plain;charset=utf-8;BASE64," + base64 + "AA==",
                                   "data:application/gltf-buffer;base64," + base64 + "AA"}) {
        CAPTURE(uri);
        CHECK(message(read_text("d.gltf", triangle_in(uri))) == "");
    }
    std::string percent = "data:application/octet-stream,";
    for (const char c : kPositions) percent += fmt::format("%{:02x}", static_cast<unsigned char>(c));
    CHECK(message(read_text("d.gltf", triangle_in(percent))) == "");
    for (const std::string& uri : {"data:application/octet-stream;base64," + base64.substr(4),
                                   "data:application/octet-stream;base64,!" + base64.substr(1),
                                   "data:application/octet-stream;base64," + base64 + "A", std::string("data:"),
                                   "data:application/octet-stream;base64" + base64}) {
        CAPTURE(uri);
        CHECK(!read_text("d.gltf", triangle_in(uri)));
    }
}

TEST_CASE("GLB: BIN chunks of other lengths, unknown chunks and malformed containers") {
    const std::string json = triangle_in("");
    const auto chunk = [](const std::string& kind, const std::string& bytes) {
        std::string out;
        put(out, static_cast<std::uint32_t>(bytes.size()));
        return out + kind + bytes;
    };
    const auto file = [](const std::string& chunks) {
        std::string out = "glTF";
        put(out, std::uint32_t{2});
        put(out, static_cast<std::uint32_t>(12 + chunks.size()));
        return out + chunks;
    };
    const std::string kBin("BIN\0", 4);
    for (const std::size_t more : {0, 1, 2, 3, 4, 5, 1000}) {
        CAPTURE(more);
        CHECK(message(read_text("b.glb",
                                file(chunk("JSON", json) + chunk(kBin, kPositions + std::string(more, 'x'))))) == "");
    }
    CHECK(message(read_text("b.glb", file(chunk("JSON", json + std::string(3, '\0')) + chunk(kBin, kPositions)))) ==
          "");
    CHECK(message(read_text("b.glb", file(chunk("JSON", json) + chunk(kBin, kPositions) + chunk("ODD!", "123")))) ==
          "");
    CHECK(message(read_text("b.glb", file(chunk("JSON", json) + chunk(kBin, kPositions)) + "behind")) == "");
    CHECK(!read_text("b.glb", file(chunk("JSON", json) + chunk(kBin, kPositions.substr(1)))));
    CHECK(!read_text("b.glb", file(chunk("JSON", json) + chunk("ODD!", "1") + chunk(kBin, kPositions))));
    CHECK(!read_text("b.glb", file(chunk("JSON", json))));
    CHECK(!read_text("b.glb", file(chunk("NOSJ", json) + chunk(kBin, kPositions))));
    CHECK(!read_text("b.glb", file("")));
    // A document with data URIs may have no BIN chunk, or an empty one.
    const std::string data = triangle_in("data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA");
    CHECK(message(read_text("b.glb", file(chunk("JSON", data)))) == "");
    CHECK(message(read_text("b.glb", file(chunk("JSON", data) + chunk(kBin, "")))) == "");
}

TEST_CASE("glTF: other versions and unknown required extensions are refused") {
    const auto with = [](const std::string& asset, const std::string& more = "") {
        std::string json = triangle_in("data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA");
        json.replace(json.find(R"({"version":"2.0"})"), 17, asset);
        json.insert(1, more);
        return read_text("v.gltf", json);
    };
    CHECK(with(R"({"version":"2.0"})").has_value());
    CHECK(with(R"({"version":"2.1"})").has_value());
    CHECK(with(R"({"version":"2.1","minVersion":"2.0"})").has_value());
    for (const char* asset : {R"({"version":"1.0"})", R"({"version":"3.0"})", R"({"version":"2.1","minVersion":"2.1"})",
                              R"({"version":2.0})", R"({"version":"two"})", "{}", "7"}) {
        CAPTURE(asset);
        CHECK(!with(asset));
    }
    const std::string two = R"({"version":"2.0"})";
    for (const char* name : {"KHR_materials_unlit", "KHR_texture_transform", "KHR_lights_punctual", "EXT_texture_webp",
                             "KHR_mesh_quantization", "EXT_mesh_gpu_instancing", "VRMC_vrm", "EXT_meshopt_compression",
                             "KHR_meshopt_compression"}) {
        CAPTURE(name);
        CHECK(with(two, fmt::format(R"("extensionsRequired":["{}"],)", name)).has_value());
    }
    for (const char* name : {"FOO_folded_geometry", "CESIUM_RTC", ""}) {
        CAPTURE(name);
        const auto refused = with(two, fmt::format(R"("extensionsRequired":["{}"],)", name));
        REQUIRE(!refused);
        CHECK(refused.error().code == ErrorCode::unsupported);
        CHECK(refused.error().message.find(name) != std::string::npos);
        CHECK(with(two, fmt::format(R"("extensionsUsed":["{}"],)", name)).has_value());
    }
}

TEST_CASE("glTF: skins and instances") {
    GltfMaker maker;
    maker.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);  // 0
    maker.floats("VEC3", {10, 0, 0, 20, 0, 0}, 3);         // 1
    maker.add<std::int16_t>(5122, "VEC4", {0, 0, 32767, 0, 0, 0, 0, 32767}, 4,
                            true);                      // 2: half a turn about z, and no turn
    maker.floats("VEC3", {1, 1, 1, 2, -2, 2}, 3);       // 3
    maker.floats("VEC3", {1, 1, 1}, 3);                 // 4
    maker.floats("VEC4", {0, 0, 0, 1, 0, 0, 0, 1}, 4);  // 5
    const std::string mesh = mesh_of(R"({"attributes":{"POSITION":0}})", ",");
    const auto node = [&](const std::string& fields) {
        return read_text("i.glb",
                         maker.glb_file(R"("nodes":[{"mesh":0,)" + fields + R"(}],"skins":[{"joints":[0]}])" + mesh));
    };
    SUBCASE("a skinned mesh ignores its node's transform") {
        const auto skinned = node(R"("skin":0,"translation":[100,0,0],"scale":[-1,1,1])");
        REQUIRE(skinned.has_value());
        CHECK(values_of<float>(*skinned, "POSITION") == Floats{0, 0, 0, 1, 0, 0, 0, 1, 0});
        CHECK(skinned->indices == Indices{0, 1, 2});
    }
    SUBCASE("the node's transform is applied after the instance's; a mirrored instance has its triangles flipped") {
        const auto placed = node(
            R"("scale":[2,2,2],"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":1,"ROTATION":2,"SCALE":3}}})");
        REQUIRE(placed.has_value());
        CHECK(values_of<float>(*placed, "POSITION") ==
              Floats{20, 0, 0, 18, 0, 0, 20, -2, 0, /**/ 40, 0, 0, 44, 0, 0, 40, -4, 0});
        CHECK(placed->indices == Indices{0, 1, 2, 3, 5, 4});
    }
    SUBCASE("instance attributes may be missing, but wrong ones are refused") {
        CHECK(node(R"("extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"SCALE":3,"_ID":1}}})").has_value());
        for (const char* attributes :
             {"", R"("TRANSLATION":9)", R"("TRANSLATION":-1)", R"("TRANSLATION":"x")", R"("_ID":1)",
              R"("TRANSLATION":5)", R"("ROTATION":1)", R"("TRANSLATION":1,"SCALE":4)"}) {
            CAPTURE(attributes);
            CHECK(!node(
                fmt::format(R"("extensions":{{"EXT_mesh_gpu_instancing":{{"attributes":{{{}}}}}}})", attributes)));
        }
        CHECK(!node(R"("extensions":{"EXT_mesh_gpu_instancing":{}})"));
    }
    SUBCASE("a billion instances without bytes are refused") {
        GltfMaker small;
        small.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
        small.add_accessor(R"("componentType":5126,"count":1000000000,"type":"VEC3")");
        const auto bomb = read_text("i.glb",
                                    small.glb_file(R"("nodes":[{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":
            {"attributes":{"TRANSLATION":1}}}}])" + mesh));
        REQUIRE(!bomb);
        CHECK(bomb.error().code == ErrorCode::memory_limit);
    }
}

TEST_CASE("glTF: indices without a buffer view are zeros") {
    GltfMaker maker;
    maker.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
    maker.add_accessor(R"("componentType":5123,"count":6,"type":"SCALAR")");
    maker.add_view(packed<std::uint16_t>({1, 2}), 0);
    maker.add_view(packed<std::uint16_t>({1, 2}), 0);
    maker.add_accessor(R"("componentType":5123,"count":3,"type":"SCALAR","sparse":{"count":2,"indices":{"bufferView":1,
        "componentType":5123},"values":{"bufferView":2}})");
    const auto indices = [&](int accessor) {
        return must_read("z.glb",
                         maker.glb_file(one_node + mesh_of(fmt::format(
                                                       R"({{"attributes":{{"POSITION":0}},"indices":{}}})", accessor))))
            .indices;
    };
    CHECK(indices(1) == Indices{0, 0, 0, 0, 0, 0});
    CHECK(indices(2) == Indices{0, 1, 2});
}

TEST_CASE("glTF: the report names everything that is left out") {
    GltfMaker maker;
    maker.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
    maker.floats("VEC2", {0, 0, 1, 0, 0, 1}, 2);
    const std::string json = R"("materials":[{},{},{}],"textures":[{}],"images":[{}],"skins":[{"joints":[0]}],
        "animations":[{},{}],"cameras":[{}],"scenes":[{"nodes":[0,1,2]},{}],"extensionsUsed":["FOO_bar","KHR_lights_punctual"],
        "extensions":{"KHR_lights_punctual":{"lights":[{},{}]}},"nodes":[{"mesh":0},{"mesh":0},{}],"meshes":[{"primitives":[
        {"attributes":{"POSITION":0,"TEXCOORD_0":1},"targets":[{"POSITION":0}]},{"attributes":{"POSITION":0}},
        {"attributes":{"POSITION":0},"mode":0},{"attributes":{"POSITION":0},"mode":1},{"attributes":{}}]}])";
    ReadReport report;
    const std::string file = maker.glb_file(json);
    REQUIRE(read_mesh(std::as_bytes(std::span(file)), "x.glb", {}, &report).has_value());
    const std::vector<std::string> expected{"the extension 'FOO_bar'",
                                            "3 materials",
                                            "1 texture",
                                            "1 image",
                                            "1 skin",
                                            "2 animations",
                                            "1 camera",
                                            "2 lights",
                                            "1 other scene",
                                            "3 nodes (their transforms are applied)",
                                            "1 instance (its triangles are repeated)",
                                            "2 primitives (joined into one)",
                                            "1 morph target",
                                            "1 primitive of points",
                                            "1 primitive of lines",
                                            "1 primitive without positions",
                                            "1 attribute that not every primitive has alike ('TEXCOORD_0')"};
    CHECK(report.left_out == expected);
    INFO("nothing is left out of a file of one mesh");
    ReadReport plain;
    const std::string own = maker.glb_file(one_node + mesh_of(R"({"attributes":{"POSITION":0}})"));
    REQUIRE(read_mesh(std::as_bytes(std::span(own)), "x.glb", {}, &plain).has_value());
    CHECK(plain.left_out.empty());
}

TEST_CASE("glTF: in memory, buffers in files are found only with a path") {
    write_text("own.bin", kPositions);
    const std::string json = triangle_in("own.bin");
    const auto bytes = std::as_bytes(std::span(json));
    CHECK(message(read_mesh(bytes, "")).find("no folder") != std::string::npos);
    CHECK(read_mesh(bytes, folder() / "any name").has_value());
}

TEST_CASE("the memory of a mesh is limited by the file's size or ReadOptions") {
    GltfMaker maker;
    maker.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
    std::string nodes = R"("nodes":[{"mesh":0})";
    for (int i = 1; i < 1000; ++i) nodes += R"(,{"mesh":0})";
    const std::string file = maker.glb_file(nodes + "]," + mesh_of(R"({"attributes":{"POSITION":0}})"));
    const auto read = [&](const ReadOptions& options) {
        return read_mesh(std::as_bytes(std::span(file)), "x", options);
    };
    CHECK(read({}).has_value());
    // 1,000 triangles and 3,000 vertices of 12 bytes each.
    CHECK(read({.max_bytes = 48000}).has_value());
    CHECK(!read({.max_bytes = 47999}));
    CHECK(read({.max_bytes = 148000, .triangle_bytes = 100}).has_value());
    CHECK(!read({.max_bytes = 147999, .triangle_bytes = 100}));
    const auto refused = read({.triangle_bytes = 1U << 20});
    REQUIRE(!refused);
    CHECK(refused.error().code == ErrorCode::memory_limit);
    const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    CHECK(!read_mesh(std::as_bytes(std::span(obj)), "x.obj", {.max_bytes = 47}));
    CHECK(read_mesh(std::as_bytes(std::span(obj)), "x.obj", {.max_bytes = 48}).has_value());
    CHECK(read_mesh(std::as_bytes(std::span(obj)), "", {.format = MeshFormat::obj}).has_value());
}
