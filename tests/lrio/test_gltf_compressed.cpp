// Tests reading EXT_meshopt_compression and KHR_meshopt_compression.
#include <doctest/doctest.h>

#include "tests/lrio/meshopt_maker.h"
#include "tests/support/capture.h"

using namespace lacedring;
using namespace lacedring::test;

namespace {

Result<Mesh> read_grid(bool compressed, Mode mode, std::size_t index_stride, const char* name) {
    GltfMaker maker;
    maker.add_buffers(kPlaceholder);
    const Indices indices = grid_indices();
    const int vertices = add_view(maker, compressed, Mode::attributes, grid_vertices(), 16, "", name);
    const int triangles = add_view(maker, compressed, mode, index_bytes(indices, index_stride), index_stride, "", name);
    maker.add_accessor(accessor(vertices, 0, 5126, kSide * kSide, "VEC3"));
    maker.add_accessor(accessor(vertices, 12, 5120, kSide * kSide, "VEC3", true));
    maker.add_accessor(accessor(triangles, 0, index_stride == 2 ? 5123 : 5125, indices.size(), "SCALAR"));
    return read_text("grid.glb", maker.glb_file(fmt::format(R"("extensionsRequired":["{}"],)", name) + one_node +
                                                mesh_of(R"({"attributes":{"POSITION":0,"NORMAL":1},"indices":2})")));
}

/// Reads a mesh whose attribute "_V" is in a filtered view.
Result<Mesh> read_filtered(const std::string& filtered, std::size_t stride, const std::string& filter, int type,
                           const char* shape, bool normalized) {
    GltfMaker maker;
    maker.add_buffers(kPlaceholder);
    const std::size_t count = filtered.size() / stride;
    std::string positions;
    for (std::size_t i = 0; i < count * 3; ++i) put(positions, static_cast<float>(i * i % 97));
    const int position_view = maker.add_view(positions, 0);
    const int view = add_view(maker, true, Mode::attributes, filtered, stride, R"(,"filter":")" + filter + "\"");
    maker.add_accessor(accessor(position_view, 0, 5126, count, "VEC3"));
    maker.add_accessor(accessor(view, 0, type, count, shape, normalized));
    return read_text("f.glb",
                     maker.glb_file(kRequired + one_node + mesh_of(R"({"attributes":{"POSITION":0,"_V":1}})")));
}

std::vector<float> unit_vectors(std::size_t count, std::size_t width) {
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    std::vector<float> out;
    for (std::size_t i = 0; i < count; ++i) {
        float squares = 0;
        for (std::size_t c = 0; c < width; ++c) {
            out.push_back(normal(random));
            squares += out.back() * out.back();
        }
        for (std::size_t c = 0; c < width; ++c) out[out.size() - 1 - c] /= std::sqrt(squares);
        if (width == 3) out.push_back(1);  // the octahedral filter keeps the fourth component
    }
    return out;
}

}  // namespace

TEST_CASE("glTF: a mesh compressed by meshoptimizer is read bit for bit") {
    const auto plain = read_grid(false, Mode::triangles, 4, "EXT_meshopt_compression");
    REQUIRE(message_of(plain) == "");
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
        for (const Mode mode : {Mode::triangles, Mode::indices}) {
            for (const std::size_t stride : {2U, 4U}) {
                CAPTURE_COPY(name);
                CAPTURE_COPY(stride);
                const auto mesh = read_grid(true, mode, stride, name);
                REQUIRE(message_of(mesh) == "");
                if (mode == Mode::indices) CHECK(same(*mesh, *plain));
                CHECK(mesh->attributes.size() == 2);
                CHECK(mesh->attributes[0].data == plain->attributes[0].data);
                CHECK(mesh->attributes[1].data == plain->attributes[1].data);
                // The triangle codec may rotate a triangle.
                REQUIRE(mesh->indices.size() == plain->indices.size());
                for (std::size_t i = 0; i < mesh->indices.size(); i += 3) {
                    Indices a(mesh->indices.begin() + static_cast<std::ptrdiff_t>(i),
                              mesh->indices.begin() + static_cast<std::ptrdiff_t>(i) + 3);
                    Indices b(plain->indices.begin() + static_cast<std::ptrdiff_t>(i),
                              plain->indices.begin() + static_cast<std::ptrdiff_t>(i) + 3);
                    std::rotate(a.begin(), std::min_element(a.begin(), a.end()), a.end());
                    std::rotate(b.begin(), std::min_element(b.begin(), b.end()), b.end());
                    CHECK(a == b);
                }
            }
        }
    }
}

TEST_CASE("glTF: meshoptimizer's filters") {
    constexpr std::size_t count = 300;
    SUBCASE("octahedral") {
        const std::vector<float> from = unit_vectors(count, 3);
        for (const std::size_t stride : {4U, 8U}) {
            std::string bytes(count * stride, '\0');
            meshopt_encodeFilterOct(bytes.data(), count, stride, stride == 4 ? 8 : 12, from.data());
            const auto mesh = read_filtered(bytes, stride, "OCTAHEDRAL", stride == 4 ? 5120 : 5122, "VEC4", true);
            REQUIRE(message_of(mesh) == "");
            meshopt_decodeFilterOct(bytes.data(), count, stride);
            const auto& data = mesh->attributes[1].data;
            CHECK(std::equal(data.begin(), data.end(), std::as_bytes(std::span(bytes)).begin()));
            for (std::size_t i = 0; i < count * 4; ++i) {
                double value = 0;
                if (stride == 4) value = values_of<std::int8_t>(*mesh, "_V")[i] / 127.0;
                if (stride == 8) value = values_of<std::int16_t>(*mesh, "_V")[i] / 32767.0;
                CHECK(value == doctest::Approx(static_cast<double>(from[i])).epsilon(stride == 4 ? 0.03 : 0.002));
            }
        }
    }
    SUBCASE("quaternion") {
        const std::vector<float> from = unit_vectors(count, 4);
        std::string bytes(count * 8, '\0');
        meshopt_encodeFilterQuat(bytes.data(), count, 8, 12, from.data());
        const auto mesh = read_filtered(bytes, 8, "QUATERNION", 5122, "VEC4", true);
        REQUIRE(message_of(mesh) == "");
        const auto values = values_of<std::int16_t>(*mesh, "_V");
        // q and -q are the same rotation.
        for (std::size_t i = 0; i < count; ++i) {
            double dot = 0;
            for (std::size_t c = 0; c < 4; ++c)
                dot += values[i * 4 + c] / 32767.0 * static_cast<double>(from[i * 4 + c]);
            CHECK(std::abs(dot) == doctest::Approx(1).epsilon(0.001));
        }
    }
    SUBCASE("exponential") {
        std::vector<float> from;
        for (std::size_t i = 0; i < count * 3; ++i) from.push_back(static_cast<float>(i) * 0.37F - 20);
        std::string bytes(count * 12, '\0');
        meshopt_encodeFilterExp(bytes.data(), count, 12, 20, from.data());
        const auto mesh = read_filtered(bytes, 12, "EXPONENTIAL", 5126, "VEC3", false);
        REQUIRE(message_of(mesh) == "");
        const auto values = values_of<float>(*mesh, "_V");
        for (std::size_t i = 0; i < values.size(); ++i) CHECK(std::abs(values[i] - from[i]) < 0.001F);
    }
    SUBCASE("an unknown filter is refused") {
        const auto mesh = read_filtered(std::string(count * 4, '\0'), 4, "COLOR", 5121, "VEC4", true);
        REQUIRE(!mesh);
        CHECK(mesh.error().code == ErrorCode::unsupported);
        CHECK(mesh.error().message.find("filter 'COLOR' is not read") != std::string::npos);
    }
}

TEST_CASE("glTF: sparse accessors and instances in compressed views are read") {
    const auto read = [](bool compressed) {
        GltfMaker maker;
        maker.add_buffers(kPlaceholder);
        const std::string base = packed<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
        const int positions = add_view(maker, compressed, Mode::attributes, base, 12);
        const int where = add_view(maker, compressed, Mode::indices, index_bytes({1, 3}, 2), 2);
        const int values = add_view(maker, compressed, Mode::attributes, packed<float>({5, 6, 7, 8, 9, 10}), 12);
        const int moves = add_view(maker, compressed, Mode::attributes, packed<float>({1, 0, 0, 0, 2, 0}), 12);
        maker.add_accessor(
            accessor(positions, 0, 5126, 4, "VEC3") +
            fmt::format(
                R"(,"sparse":{{"count":2,"indices":{{"bufferView":{},"componentType":5123}},"values":{{"bufferView":{}}}}})",
                where, values));
        maker.add_accessor(accessor(moves, 0, 5126, 2, "VEC3"));
        return must_read(
            "s.glb",
            maker.glb_file(
                R"("nodes":[{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":1}}}}],)" +
                mesh_of(R"({"attributes":{"POSITION":0},"mode":5})")));
    };
    const Mesh mesh = read(true);
    CHECK(same(mesh, read(false)));
    CHECK(mesh.triangle_count() == 4);
    const Floats first = values_of<float>(mesh, "POSITION");
    CHECK(Floats(first.begin(), first.begin() + 6) == Floats{1, 0, 0, 6, 6, 7});
}

TEST_CASE("glTF: quantized positions in compressed views are read") {
    for (const bool normalized : {false, true}) {
        for (const int type : {5120, 5121, 5122, 5123}) {
            CAPTURE(type);
            CAPTURE(normalized);
            GltfMaker maker;
            maker.add_buffers(kPlaceholder);
            const std::size_t size = type < 5122 ? 1 : 2;
            std::string bytes;
            for (const int value : {0, 0, 0, 0, 100, 0, 0, 0, 0, 127, 0, 0}) {
                put(bytes, static_cast<std::uint8_t>(value));
                if (size == 2) put(bytes, std::uint8_t{0});
            }
            const int view = add_view(maker, true, Mode::attributes, bytes, 4 * size);
            maker.add_accessor(accessor(view, 0, type, 3, "VEC3", normalized));
            const Mesh mesh =
                must_read("q.glb", maker.glb_file(kRequired + one_node + mesh_of(R"({"attributes":{"POSITION":0}})")));
            const double most[] = {127, 255, 32767, 65535};
            const double divisor = normalized ? most[type - 5120] : 1;
            CHECK(values_of<float>(mesh, "POSITION") ==
                  Floats{0, 0, 0, static_cast<float>(100 / divisor), 0, 0, 0, static_cast<float>(127 / divisor), 0});
        }
    }
}

TEST_CASE("glTF: uncompressed copies are opened only where the compressed bytes cannot be read") {
    const std::string vertices = packed<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
    const auto read = [&](char first_byte, const std::string& buffer, const std::string& required) {
        GltfMaker maker;
        maker.add_buffers(buffer);
        std::string data = compress(Mode::attributes, vertices, 12);
        data[0] = first_byte;
        const std::size_t offset = maker.append(data);
        maker.add_view_json(fmt::format(
            R"("buffer":1,"byteLength":36,"extensions":{{"EXT_meshopt_compression":{{"buffer":0,"byteOffset":{},"byteLength":{},"byteStride":12,"count":3,"mode":"ATTRIBUTES"}}}})",
            offset, data.size()));
        maker.add_accessor(accessor(0, 0, 5126, 3, "VEC3"));
        ReadReport report;
        const auto path =
            write_text("u.glb", maker.glb_file(required + one_node + mesh_of(R"({"attributes":{"POSITION":0}})")));
        const auto mesh = read_mesh(path, {}, &report);
        return std::pair(message_of(mesh), report.files.size());
    };
    using Read = std::pair<std::string, std::size_t>;
    const std::string copy = R"(,{"byteLength":36,"uri":"copy.bin"})";
    write_text("copy.bin", vertices);
    constexpr char kOld = '\xa0', kNew = '\xa1';
    CHECK(read(kOld, copy, "") == Read("", 0));
    CHECK(read(kOld, R"(,{"byteLength":36,"uri":"not-there.bin"})", "") == Read("", 0));
    CHECK(read(kNew, copy, "") == Read("", 1));
    const std::string refused =
        "glTF: mesh 0: primitive 0: 'POSITION': buffer view 0: compressed by version 1 of meshoptimizer's vertex "
        "codec, "
        "which the installed meshoptimizer 0.18 does not read";
    if (MESHOPTIMIZER_VERSION == 180) {
        CHECK(read(kNew, copy, kRequired) == Read(refused, 0));
        CHECK(read(kNew, R"(,{"byteLength":36})", "") == Read(refused, 0));
    }
    CHECK(read('\x50', copy, "").first.find("the data is not of meshoptimizer's vertex codec") != std::string::npos);
}
