// Malformed and hostile data in EXT_meshopt_compression and KHR_meshopt_compression is refused.
#include <doctest/doctest.h>

#include "tests/lrio/meshopt_maker.h"

using namespace lacedring;
using namespace lacedring::test;

TEST_CASE("glTF: every field of a compressed view is checked") {
    const std::string vertices = packed<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
    const std::string data = compress(Mode::attributes, vertices, 12);
    using Fields = std::vector<std::pair<std::string, std::string>>;
    const auto read = [&](Fields changes) {
        Fields fields = {{"buffer", "0"},       {"byteOffset", "0"}, {"byteLength", std::to_string(data.size())},
                         {"byteStride", "12"},  {"count", "3"},      {"mode", "\"ATTRIBUTES\""},
                         {"filter", "\"NONE\""}};
        std::string view = "36", stride, json;
        for (const auto& [name, value] : changes) {
            if (name == "view") view = value;
            if (name == "stride") stride = R"(,"byteStride":)" + value;
            for (auto& field : fields) {
                if (field.first == name) field.second = value;
            }
        }
        for (const auto& [name, value] : fields) {
            if (!value.empty()) json += fmt::format("{}\"{}\":{}", json.empty() ? "" : ",", name, value);
        }
        GltfMaker maker;
        maker.add_buffers(R"(,{"byteLength":99999999999})");
        maker.append(data);
        maker.add_view_json(fmt::format(
            R"("buffer":1,"byteLength":{}{},"extensions":{{"EXT_meshopt_compression":{{{}}}}})", view, stride, json));
        maker.add_accessor(accessor(0, 0, 5126, 3, "VEC3"));
        return read_text("m.glb", maker.glb_file(kRequired + one_node + mesh_of(R"({"attributes":{"POSITION":0}})")));
    };
    CHECK(message_of(read({})) == "");
    CHECK(message_of(read({{"byteOffset", ""}, {"filter", ""}})) == "");
    CHECK(message_of(read({{"stride", "12"}})) == "");
    const Fields bad[] = {{{"buffer", ""}},
                          {{"buffer", "1"}},
                          {{"buffer", "2"}},
                          {{"buffer", "-1"}},
                          {{"buffer", "4294967296"}},
                          {{"buffer", "0.5"}},
                          {{"byteOffset", "1"}},
                          {{"byteOffset", "-1"}},
                          {{"byteOffset", "18446744073709551615"}},
                          {{"byteOffset", "null"}},
                          {{"byteLength", ""}},
                          {{"byteLength", "0"}},
                          {{"byteLength", "1"}},
                          {{"byteLength", std::to_string(data.size() - 1)}},
                          {{"byteLength", std::to_string(data.size() + 8)}},
                          {{"byteLength", "18446744073709551615"}},
                          {{"byteStride", ""}},
                          {{"byteStride", "0"}},
                          {{"byteStride", "6"}},
                          {{"byteStride", "36"}, {"count", "1"}, {"stride", "12"}},
                          {{"byteStride", "4"}, {"count", "9"}},
                          {{"byteStride", "18"}, {"count", "2"}},
                          {{"byteStride", "260"}, {"view", "780"}},
                          {{"byteStride", "9223372036854775808"}, {"count", "2"}, {"view", "0"}},
                          {{"count", ""}},
                          {{"count", "0"}},
                          {{"count", "2"}},
                          {{"count", "4"}},
                          {{"count", "-3"}},
                          {{"count", "100000000"}, {"view", "1200000000"}},
                          {{"count", "1537228672809129304"}, {"view", "18446744073709551600"}},
                          {{"mode", ""}},
                          {{"mode", "\"TRIANGLES\""}},
                          {{"mode", "\"INDICES\""}},
                          {{"mode", "\"POINTS\""}},
                          {{"mode", "0"}},
                          {{"mode", "\"INDICES\""}, {"byteStride", "4"}, {"count", "9"}},
                          {{"mode", "\"TRIANGLES\""}, {"byteStride", "4"}, {"count", "9"}},
                          {{"mode", "\"TRIANGLES\""}, {"byteStride", "4"}, {"count", "10"}, {"view", "40"}},
                          {{"mode", "\"INDICES\""}, {"byteStride", "4"}, {"count", "9"}, {"filter", "\"EXPONENTIAL\""}},
                          {{"filter", "\"OCTAHEDRAL\""}},
                          {{"filter", "\"QUATERNION\""}},
                          {{"filter", "\"none\""}},
                          {{"filter", "1"}},
                          {{"view", "35"}},
                          {{"view", "48"}},
                          {{"stride", "16"}}};
    for (const Fields& changes : bad) {
        std::string label;
        for (const auto& [name, value] : changes) label += name + " = " + value + " ";
        CAPTURE(label);
        const auto mesh = read(changes);
        REQUIRE(!mesh);
        CHECK((mesh.error().code == ErrorCode::malformed || mesh.error().code == ErrorCode::unsupported));
        CHECK(mesh.error().message.find("buffer view 0: ") != std::string::npos);
    }
    INFO("an extension that is not an object is refused");
    GltfMaker maker;
    maker.add_view_json(R"("buffer":7,"byteLength":36,"extensions":{"EXT_meshopt_compression":3})");
    maker.add_accessor(accessor(0, 0, 5126, 3, "VEC3"));
    CHECK(!read_text("m.glb", maker.glb_file(one_node + mesh_of(R"({"attributes":{"POSITION":0}})"))));
}

TEST_CASE("glTF: compressed data of huge counts is refused without allocating them") {
    // Compressed data may decode to 64 times its bytes, and any number of views may share them.
    const std::size_t count = 1U << 21U;
    const std::string zeros(count * 32, '\0');
    const std::string data = compress(Mode::attributes, zeros, 32);
    CHECK(data.size() * 60 < zeros.size());
    CHECK(data.size() * 64 < zeros.size() + 64 * 300);
    GltfMaker maker;
    maker.append(data);
    std::string primitives;
    for (int i = 0; i < 100; ++i) {
        maker.add_view_json(fmt::format(
            R"("buffer":1,"byteLength":{},"byteStride":32,"extensions":{{"EXT_meshopt_compression":{{"buffer":0,"byteLength":{},"byteStride":32,"count":{},"mode":"ATTRIBUTES"}}}})",
            zeros.size(), data.size(), count));
        maker.add_accessor(accessor(i, 0, 5126, 3, "VEC3"));
        primitives += fmt::format(R"({}{{"attributes":{{"POSITION":{}}}}})", i == 0 ? "" : ",", i);
    }
    maker.add_buffers(R"(,{"byteLength":9})");
    const std::string file = maker.glb_file(kRequired + one_node + mesh_of(primitives));
    const auto mesh = read_text("z.glb", file);
    REQUIRE(!mesh);
    CHECK(mesh.error().code == ErrorCode::memory_limit);
    const auto less = read_mesh(write_text("z.glb", file), {.max_bytes = 1U << 20U});
    REQUIRE(!less);
    CHECK(less.error().code == ErrorCode::memory_limit);
}

TEST_CASE("glTF: damaged compressed data is refused or read as a sound mesh") {
    const Indices indices = grid_indices();
    std::mt19937 random(11);
    for (const Mode mode : {Mode::attributes, Mode::triangles, Mode::indices}) {
        const bool of_vertices = mode == Mode::attributes;
        const std::string plain = of_vertices ? grid_vertices() : index_bytes(indices, 4);
        const std::size_t stride = of_vertices ? 16 : 4;
        const std::string good = compress(mode, plain, stride);
        for (int trial = 0; trial < 150; ++trial) {
            std::string data = good;
            if (trial < 30) data.resize(random() % data.size());
            for (int i = 0; i < trial % 5; ++i) data[random() % data.size()] = static_cast<char>(random());
            if (data.empty()) continue;
            CAPTURE(trial);
            GltfMaker maker;
            const std::size_t offset = maker.append(data);
            maker.add_view_json(fmt::format(
                R"("buffer":1,"byteLength":{},"extensions":{{"EXT_meshopt_compression":{{"buffer":0,"byteOffset":{},"byteLength":{},"byteStride":{},"count":{},"mode":"{}"}}}})",
                plain.size(), offset, data.size(), stride, plain.size() / stride,
                kModes[static_cast<std::size_t>(mode)]));
            maker.add_buffers(R"(,{"byteLength":9})");
            const int vertices = of_vertices ? 0 : maker.add_view(grid_vertices(), 16);
            maker.add_accessor(accessor(vertices, 0, of_vertices ? 5120 : 5126, kSide * kSide, "VEC3"));
            maker.add_accessor(accessor(0, 0, 5125, indices.size(), "SCALAR"));
            const auto mesh = read_text(
                "d.glb", maker.glb_file(kRequired + one_node +
                                        mesh_of(of_vertices ? R"({"attributes":{"POSITION":0}})"
                                                            : R"({"attributes":{"POSITION":0},"indices":1})")));
            if (mesh) CHECK(is_sound(*mesh));
            if (trial < 30 && trial % 5 == 0) CHECK(!mesh);
        }
    }
}
