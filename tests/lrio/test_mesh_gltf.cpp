// Tests reading glTF and GLB.
#include <doctest/doctest.h>

#include "tests/lrio/gltf_maker.h"

using namespace lacedring;
using namespace lacedring::test;

TEST_CASE("glTF: index types, strips and fans, and primitives that share vertices") {
    GltfMaker maker;
    maker.floats("VEC3", square, 3);                            // 0
    maker.add<std::uint8_t>(5121, "SCALAR", {0, 1, 2}, 1);      // 1
    maker.add<std::uint16_t>(5123, "SCALAR", {0, 1, 3, 2}, 1);  // 2
    maker.add<std::uint32_t>(5125, "SCALAR", {3, 0, 1, 2}, 1);  // 3
    const std::string mesh = mesh_of(R"({"attributes":{"POSITION":0},"indices":1},
        {"attributes":{"POSITION":0},"indices":2,"mode":5},{"attributes":{"POSITION":0},"indices":3,"mode":6},
        {"attributes":{"POSITION":0},"mode":0},{"attributes":{"POSITION":0},"mode":3},{"attributes":{}}, 
        {"attributes":{"POSITION":0},"mode":6})");
    const Mesh mesh_read = must_read("modes.glb", maker.glb_file(one_node + mesh));
    CHECK(mesh_read.vertex_count == 4);
    CHECK(mesh_read.indices ==
          Indices{0, 1, 2, /*strip*/ 0, 1, 3, 1, 2, 3, /*fan*/ 0, 1, 3, 1, 2, 3, /*no indices*/ 1, 2, 0, 2, 3, 0});
    CHECK(attributes_of(mesh_read) == "POSITION:f32x3");
}

TEST_CASE("glTF: strides, sparse accessors, and attributes that all primitives have") {
    GltfMaker maker;
    maker.add_view(packed<float>({0, 0, 0, 9, 1, 0, 0, 9, 0, 1, 0}), 16);  // the last row has no padding
    maker.add_accessor(R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3")");  // 0
    maker.add_view(packed<std::uint16_t>({1, 2}), 0);
    maker.add_view(packed<float>({5, 6, 7, 8, 9, 10}), 0);
    const std::string sparse =
        R"("sparse":{"count":2,"indices":{"bufferView":1,"componentType":5123},"values":{"bufferView":2}})";
    maker.add_accessor(R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)" + sparse);  // 1
    maker.add_accessor(R"("componentType":5126,"count":3,"type":"VEC3",)" + sparse);                 // 2: over zeros
    maker.add<std::uint8_t>(5121, "VEC4", {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, 4, true);         // 3
    maker.floats("VEC2", {0, 1, 2, 3, 4, 5}, 2);                                                     // 4
    const Mesh mesh = must_read("sparse.glb", maker.glb_file(one_node + mesh_of(R"(
        {"attributes":{"TEXCOORD_0":4,"POSITION":0,"COLOR_0":3}},{"attributes":{"POSITION":1,"COLOR_0":3,"_EXTRA":4}},
        {"attributes":{"POSITION":2,"COLOR_0":3,"TEXCOORD_0":3}})")));
    CHECK(attributes_of(mesh) == "POSITION:f32x3 COLOR_0:u8x4n");
    CHECK(mesh.indices == Indices{0, 1, 2, 3, 4, 5, 6, 7, 8});
    CHECK(values_of<float>(mesh, "POSITION") ==
          Floats{0, 0, 0, 1, 0, 0, 0, 1, 0, /**/ 0, 0, 0, 5, 6, 7, 8, 9, 10, /**/ 0, 0, 0, 5, 6, 7, 8, 9, 10});
    CHECK(values_of<std::uint8_t>(mesh, "COLOR_0")[23] == 12);
}

TEST_CASE("glTF: node transforms") {
    GltfMaker maker;
    maker.floats("VEC3", {-0.0F, 0.1F, 0.2F, 1, 0, 0, 0, 1, 0}, 3);  // 0
    maker.floats("VEC3", {0, 0, 1, 0, 0, 1, 1, 0, 0}, 3);            // 1
    maker.floats("VEC4", {1, 0, 0, -1, 0, 1, 0, 1, 0, 0, 1, 1}, 4);  // 2
    const std::string mesh = mesh_of(R"({"attributes":{"POSITION":0,"NORMAL":1,"TANGENT":2}})", ",");
    SUBCASE("nodes are placed depth first, before their children; the identity keeps the bits") {
        const Mesh read =
            must_read("nodes.glb", maker.glb_file(R"("scenes":[{"nodes":[]},{"nodes":[3,0]}],"scene":1,"nodes":[
            {"mesh":0},{"mesh":0,"translation":[10,0,0]},{"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,20,0,1]},
            {"children":[1,4],"scale":[2,1,1]},{"children":[2]}])" +
                                                  mesh));
        CHECK(read.vertex_count == 9);
        const auto p = values_of<float>(read, "POSITION");
        CHECK(p[0] == 20.0F);  // scaled translation
        CHECK(p[3] == 22.0F);
        CHECK(p[10] == 20.1F);
        CHECK(p[12] == 2.0F);
        CHECK_MESSAGE(std::signbit(p[18]), "-0 of the node without a transform");
        const auto n = values_of<float>(read, "NORMAL");
        CHECK(n[6] == 1.0F);
        CHECK(values_of<float>(read, "TANGENT")[3] == -1.0F);
    }
    SUBCASE("a mirrored node has its triangles flipped") {
        const Mesh read = must_read("mirror.glb", maker.glb_file(R"("scenes":[{"nodes":[0]}],"nodes":[
            {"scale":[-2,4,4],"children":[1]},
            {"mesh":0,"rotation":[0,0,0.7071067811865476,0.7071067811865476]}])" +
                                                                 mesh));
        CHECK(read.indices == Indices{0, 2, 1});
        const auto p = values_of<float>(read, "POSITION");
        CHECK(p[4] == doctest::Approx(4));  // (1,0,0) -> (0,1,0) -> (0,4,0)
        CHECK(p[6] == doctest::Approx(2));  // (0,1,0) -> (-1,0,0) -> (2,0,0)
        const auto n = values_of<float>(read, "NORMAL");
        CHECK(n[2] == doctest::Approx(1));
        CHECK(n[7] == doctest::Approx(1));
        const auto t = values_of<float>(read, "TANGENT");
        CHECK(t[1] == doctest::Approx(1));
        CHECK(t[4] == doctest::Approx(1));
        CHECK(t[3] == -1.0F);
    }
    SUBCASE("normals are transformed by the transposed inverse") {
        const Mesh read = must_read("shear.glb", maker.glb_file(R"("scenes":[{"nodes":[0]}],"nodes":[
            {"mesh":0,"matrix":[1,0,0,0,0,1,0,0,1,0,1,0,0,0,0,1]}])" +
                                                                mesh));  // x += z
        const auto n = values_of<float>(read, "NORMAL");
        CHECK(n[0] == 0.0F);
        CHECK(n[2] == 1.0F);
        CHECK(n[6] == doctest::Approx(std::sqrt(0.5)));
        CHECK(n[8] == doctest::Approx(-std::sqrt(0.5)));
    }
    SUBCASE("without scenes all roots are placed, without nodes all meshes") {
        CHECK(must_read("r.glb", maker.glb_file(R"("nodes":[{"mesh":0,"children":[1]},{"mesh":0},{"mesh":0}])" + mesh))
                  .vertex_count == 9);
        CHECK(must_read("s.glb", maker.glb_file(mesh.substr(1))).vertex_count == 3);
    }
}

TEST_CASE("glTF: quantized positions and normals") {
    GltfMaker maker;
    maker.add<std::uint16_t>(5123, "VEC3", {0, 0, 0, 65535, 0, 0, 0, 13107, 0}, 3, true);  // 0
    maker.add<std::int8_t>(5120, "VEC3", {0, 0, 127, 0, 0, 127, -128, 0, 0}, 3, true);     // 1
    const std::string mesh = mesh_of(R"({"attributes":{"POSITION":0,"NORMAL":1}})");
    const std::string used =
        R"("extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"],)";
    const Mesh plain = must_read("q.glb", maker.glb_file(used + one_node + mesh));
    CHECK(attributes_of(plain) == "POSITION:f32x3 NORMAL:i8x3n");
    CHECK(values_of<float>(plain, "POSITION") == Floats{0, 0, 0, 1, 0, 0, 0, 0.2F, 0});
    const Mesh moved = must_read("q.glb", maker.glb_file(used + R"("nodes":[{"mesh":0,"scale":[10,10,10]}],)" + mesh));
    CHECK(attributes_of(moved) == "POSITION:f32x3 NORMAL:f32x3");
    CHECK(values_of<float>(moved, "POSITION") == Floats{0, 0, 0, 10, 0, 0, 0, 2, 0});
    CHECK(values_of<float>(moved, "NORMAL") == Floats{0, 0, 1, 0, 0, 1, -1, 0, 0});
}

TEST_CASE("glTF: buffers in files and in the JSON are read, images are not") {
    GltfMaker maker;
    maker.add<float>(5126, "VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
    const std::string rest =
        one_node +
        R"("images":[{"uri":"missing.png"},{"uri":"data:image/png;base64,AAAA"},{"bufferView":0,"mimeType":"image/png"}],)" +
        mesh_of(R"({"attributes":{"POSITION":0}})");
    write_text("with space.bin", maker.bin());
    CHECK(must_read("file.gltf", "\xEF\xBB\xBF \n" + maker.json(rest, "with%20space.bin")).triangle_count() == 1);
    CHECK(must_read("data.json", maker.json(rest,
                                            "data:application/octet-stream;base64,"
                                            "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"))
              .indices == Indices{0, 1, 2});
    const auto missing = read_text("missing.gltf", maker.json(rest, "not-there.bin"));
    REQUIRE(!missing);
    CHECK(missing.error().code == ErrorCode::cannot_open);
    CHECK(missing.error().message.find("not-there.bin") != std::string::npos);
    for (const char* uri : {"/dev/zero", "../../../../../../../../../../dev/zero", ".", ""}) {
        CHECK(!read_text("hostile.gltf", maker.json(rest, uri)));
    }
}

TEST_CASE("glTF: references, bounds and cycles are checked") {
    const auto with_accessor = [](const std::string& accessor, const std::string& attributes = R"("POSITION":0)") {
        GltfMaker maker;
        maker.add_view(packed<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}), 0);
        maker.add_accessor(accessor);
        return read_text("x.glb", maker.glb_file(one_node + mesh_of(R"({"attributes":{)" + attributes + "}}")));
    };
    CHECK(with_accessor(R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3")").has_value());
    for (
        const char* bad : {
            R"("bufferView":0,"componentType":5126,"count":4,"type":"VEC3")",
            R"("bufferView":0,"componentType":5126,"count":18446744073709551615,"type":"VEC3")",
            R"("bufferView":0,"byteOffset":4,"componentType":5126,"count":3,"type":"VEC3")",
            R"("bufferView":0,"byteOffset":18446744073709551612,"componentType":5126,"count":3,"type":"VEC3")",
            R"("bufferView":1,"componentType":5126,"count":3,"type":"VEC3")",
            R"("bufferView":-5,"componentType":5126,"count":4000000000,"type":"VEC3")",
            R"("componentType":5126,"count":4000000000,"type":"VEC3")",
            R"("bufferView":0,"componentType":5124,"count":3,"type":"VEC3")",
            R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC2")",
            R"("bufferView":0,"componentType":5126,"count":2,"type":"VEC3")",
            R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":0,"byteOffset":4,"componentType":5126},"values":{"bufferView":0}})",
            R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":0,"byteOffset":12,"componentType":5125},"values":{"bufferView":0}})",
            R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":-1,"indices":{"bufferView":0,"componentType":5125},"values":{"bufferView":0}})",
            R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":3,"indices":{"bufferView":0,"componentType":5125},"values":{"bufferView":0,"byteOffset":4}})",
            R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":[])",
        }) {
        CAPTURE(bad);
        CHECK(!with_accessor(bad));
    }
    CHECK(!with_accessor(R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3")", R"("POSITION":1)"));
    CHECK(!with_accessor(R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3")", R"("POSITION":-1)"));

    GltfMaker maker;
    maker.floats("VEC3", square, 3);
    maker.add<std::uint16_t>(5123, "SCALAR", {0, 1, 4}, 1);
    maker.add<std::uint16_t>(5123, "SCALAR", {0, 1, 65535}, 1);
    maker.add<std::uint16_t>(5123, "SCALAR", {0, 1}, 1);
    const std::string mesh = mesh_of(R"({"attributes":{"POSITION":0},"mode":6})", ",");
    for (const char* nodes : {
             R"("nodes":[{"mesh":0,"children":[0]}])",
             R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"children":[1]},{"children":[0]}])",
             R"("scenes":[{"nodes":[0,0]}],"nodes":[{"mesh":0}])",
             R"("nodes":[{"mesh":0,"children":[2]},{"mesh":0,"children":[2]},{"mesh":0}])",
             R"("nodes":[{"mesh":1}])",
             R"("nodes":[{"mesh":-2}])",
             R"("nodes":[{"mesh":0,"children":[7]}])",
             R"("scenes":[{"nodes":[1]}],"nodes":[{"mesh":0}])",
             R"("scene":3,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}])",
             R"("nodes":[{"mesh":0,"matrix":[1,0]}])",
             R"("nodes":[{"mesh":0,"scale":[1e300,1e300,1e300]}])",
         }) {
        CAPTURE(nodes);
        CHECK(!read_text("n.glb", maker.glb_file(nodes + mesh)));
    }
    for (const int indices : {1, 2, 3, 0, 9}) {
        const auto bad = read_text(
            "i.glb", maker.glb_file(one_node + mesh_of(fmt::format(R"({{"attributes":{{"POSITION":0}},"indices":{}}})",
                                                                   indices))));
        CAPTURE(indices);
        CHECK(!bad);
    }
    CHECK(!read_text("m.glb", maker.glb_file(one_node + mesh_of(R"({"attributes":{"POSITION":0},"mode":7})"))));
}

TEST_CASE("glTF: JSON nested too deep, and a mesh placed too often, are refused") {
    GltfMaker maker;
    maker.floats("VEC3", square, 3);
    const std::string mesh = mesh_of(R"({"attributes":{"POSITION":0},"mode":6})");
    const std::string deep = R"("extras":)" + std::string(200000, '[') + std::string(200000, ']') + ",";
    CHECK(!read_text("deep.glb", maker.glb_file(deep + one_node + mesh)));
    // A chain of 50,000 nodes is valid.
    std::string chain = R"("nodes":[)";
    for (int i = 1; i < 50000; ++i) chain += fmt::format(R"({{"children":[{}]}},)", i);
    CHECK(must_read("chain.glb", maker.glb_file(chain + R"({"mesh":0}],)" + mesh)).triangle_count() == 2);

    std::string triangles(60000, '\0');
    GltfMaker big;
    big.add_view(packed(square), 0);
    big.add_accessor(R"("bufferView":0,"componentType":5126,"count":4,"type":"VEC3")");
    big.add_view(triangles, 0);
    big.add_accessor(R"("bufferView":1,"componentType":5121,"count":60000,"type":"SCALAR")");
    std::string nodes = R"("nodes":[{"mesh":0})";
    for (int i = 0; i < 20000; ++i) nodes += R"(,{"mesh":0})";
    const auto often =
        read_text("often.glb", big.glb_file(nodes + "]," + mesh_of(R"({"attributes":{"POSITION":0},"indices":1})")));
    REQUIRE(!often);
    CHECK(often.error().code == ErrorCode::memory_limit);
}
