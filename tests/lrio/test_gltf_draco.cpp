// Tests reading KHR_draco_mesh_compression.
#include "tests/lrio/gltf_maker.h"

#ifdef LACEDRING_DRACO
#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include <memory>
#include <random>

using namespace lacedring;
using namespace lacedring::test;

namespace {

constexpr std::uint32_t kAcross = 12, kPoints = kAcross * kAcross;
const std::string kUsed = R"("extensionsRequired":["KHR_draco_mesh_compression"],)";

/// An attribute of the test meshes, with the type of its glTF accessor.
struct Kind {
    const char* name;
    draco::GeometryAttribute::Type type;
    draco::DataType data;
    std::uint8_t components;
    bool normalized;
    int component_type;
    const char* shape;
};
constexpr Kind kKinds[] = {
    {"POSITION", draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, 3, false, 5126, "VEC3"},
    {"NORMAL", draco::GeometryAttribute::NORMAL, draco::DT_FLOAT32, 3, false, 5126, "VEC3"},
    {"TEXCOORD_0", draco::GeometryAttribute::TEX_COORD, draco::DT_FLOAT32, 2, false, 5126, "VEC2"},
    {"COLOR_0", draco::GeometryAttribute::COLOR, draco::DT_UINT8, 4, true, 5121, "VEC4"},
    {"JOINTS_0", draco::GeometryAttribute::GENERIC, draco::DT_UINT16, 4, false, 5123, "VEC4"},
    {"WEIGHTS_0", draco::GeometryAttribute::GENERIC, draco::DT_FLOAT32, 4, false, 5126, "VEC4"},
    {"_SIGNED", draco::GeometryAttribute::GENERIC, draco::DT_INT16, 1, false, 5122, "SCALAR"},
};

std::string random_values(const Kind& kind, std::mt19937& random) {
    std::string out;
    for (std::uint32_t i = 0; i < kPoints * kind.components; ++i) {
        if (kind.data == draco::DT_FLOAT32) put(out, static_cast<float>(random() % 2000) / 1000 - 1);
        if (kind.data == draco::DT_UINT8) put(out, static_cast<std::uint8_t>(random()));
        if (kind.data == draco::DT_UINT16) put(out, static_cast<std::uint16_t>(random()));
        if (kind.data == draco::DT_INT16) put(out, static_cast<std::int16_t>(random()));
    }
    return out;
}

/// A grid with every kind of attribute. Draco's unique ids of the attributes are 10, 11, ...
std::unique_ptr<draco::Mesh> grid() {
    auto made = std::make_unique<draco::Mesh>();
    draco::Mesh& mesh = *made;
    mesh.set_num_points(kPoints);
    for (std::uint32_t y = 0; y + 1 < kAcross; ++y) {
        for (std::uint32_t x = 0; x + 1 < kAcross; ++x) {
            const draco::PointIndex a(y * kAcross + x), b(a.value() + 1), c(a.value() + kAcross), d(c.value() + 1);
            mesh.AddFace({a, b, c});
            mesh.AddFace({b, d, c});
        }
    }
    std::mt19937 random(5);
    std::uint32_t id = 10;
    for (const Kind& kind : kKinds) {
        const std::string values = random_values(kind, random);
        draco::GeometryAttribute attribute;
        attribute.Init(kind.type, nullptr, kind.components, kind.data, kind.normalized,
                       static_cast<std::int64_t>(values.size() / kPoints), 0);
        const int at = mesh.AddAttribute(attribute, true, kPoints);
        mesh.attribute(at)->buffer()->Write(0, values.data(), values.size());
        mesh.attribute(at)->set_unique_id(id++);
    }
    return made;
}

std::string encode(const draco::Mesh& mesh, int method, int bits) {
    draco::ExpertEncoder encoder(mesh);
    encoder.SetEncodingMethod(method);
    for (int i = 0; i < mesh.num_attributes(); ++i) {
        if (bits != 0 && mesh.attribute(i)->data_type() == draco::DT_FLOAT32) encoder.SetAttributeQuantization(i, bits);
    }
    draco::EncoderBuffer out;
    REQUIRE(encoder.EncodeToBuffer(&out).ok());
    return {out.data(), out.size()};
}

/// Decodes with Draco and returns the mesh as an uncompressed glTF.
std::string uncompressed(const std::string& data) {
    draco::DecoderBuffer buffer;
    buffer.Init(data.data(), data.size());
    auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
    REQUIRE(decoded.ok());
    const draco::Mesh& mesh = *decoded.value();
    GltfMaker maker;
    std::string attributes;
    std::uint32_t id = 10;
    for (const Kind& kind : kKinds) {
        const draco::PointAttribute& attribute = *mesh.GetAttributeByUniqueId(id++);
        std::string values(mesh.num_points() * static_cast<std::size_t>(attribute.byte_stride()), '\0');
        for (std::uint32_t p = 0; p < mesh.num_points(); ++p) {
            attribute.GetMappedValue(draco::PointIndex(p),
                                     values.data() + p * static_cast<std::size_t>(attribute.byte_stride()));
        }
        const int view = maker.add_view(values, 0);
        attributes += fmt::format(R"({}"{}":{})", attributes.empty() ? "" : ",", kind.name,
                                  maker.add_accessor(fmt::format(
                                      R"("bufferView":{},"componentType":{},"count":{},"type":"{}","normalized":{})",
                                      view, kind.component_type, mesh.num_points(), kind.shape, kind.normalized)));
    }
    std::string indices;
    for (std::uint32_t f = 0; f < mesh.num_faces(); ++f) {
        for (const draco::PointIndex& p : mesh.face(draco::FaceIndex(f))) put(indices, p.value());
    }
    const int view = maker.add_view(indices, 0);
    const int accessor = maker.add_accessor(
        fmt::format(R"("bufferView":{},"componentType":5125,"count":{},"type":"SCALAR")", view, indices.size() / 4));
    return maker.glb_file(one_node +
                          mesh_of(fmt::format(R"({{"attributes":{{{}}},"indices":{}}})", attributes, accessor)));
}

struct Parts {
    std::string primitive = R"("indices":7)";  // fields besides attributes and extensions
    std::string attributes =
        R"("POSITION":0,"NORMAL":1,"TEXCOORD_0":2,"COLOR_0":3,"JOINTS_0":4,"WEIGHTS_0":5,"_SIGNED":6)";
    std::string ids =
        R"("POSITION":10,"NORMAL":11,"TEXCOORD_0":12,"COLOR_0":13,"JOINTS_0":14,"WEIGHTS_0":15,"_SIGNED":16)";
    std::string view = "0";
    std::string used = kUsed;
    std::string index_type = "5123";
    std::string color = R"("componentType":5121,"type":"VEC4","normalized":true)";
};

std::string compressed(const std::string& data, const Parts& parts = {}) {
    GltfMaker maker;
    maker.add_view(data, 0);
    for (const Kind& kind : kKinds) {
        const bool is_color = std::string_view(kind.name) == "COLOR_0";
        maker.add_accessor(fmt::format(R"("count":{},)", kPoints) +
                           (is_color ? parts.color
                                     : fmt::format(R"("componentType":{},"type":"{}","normalized":{})",
                                                   kind.component_type, kind.shape, kind.normalized)));
    }
    maker.add_accessor(fmt::format(R"("componentType":{},"count":{},"type":"SCALAR")", parts.index_type,
                                   6 * (kAcross - 1) * (kAcross - 1)));
    return maker.glb_file(
        parts.used + one_node +
        mesh_of(fmt::format(
            R"({{"attributes":{{{}}},"extensions":{{"KHR_draco_mesh_compression":{{"bufferView":{},"attributes":{{{}}}}}}}{}}})",
            parts.attributes, parts.view, parts.ids, parts.primitive.empty() ? "" : "," + parts.primitive)));
}

std::string error_of(const Parts& parts, const std::string& data) {
    const auto mesh = read_text("e.glb", compressed(data, parts));
    return mesh ? "" : mesh.error().message;
}

bool mentions(const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("glTF: a mesh compressed by Draco is the one that Draco decodes, bit for bit") {
    for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING}) {
        for (const int bits : {0, 11}) {
            CAPTURE(method);
            CAPTURE(bits);
            const std::string data = encode(*grid(), method, bits);
            const Mesh expected = must_read("u.glb", uncompressed(data));
            CHECK(same(must_read("c.glb", compressed(data)), expected));
            CHECK(same(must_read("c.glb", compressed(data, {.index_type = "5121"})), expected));
            CHECK(same(must_read("c.glb", compressed(data, {.primitive = ""})), expected));
            // Draco data is a triangle list, also where the mode is a strip.
            CHECK(same(must_read("c.glb", compressed(data, {.primitive = R"("indices":7,"mode":5)"})), expected));
        }
    }
}

TEST_CASE("glTF: Draco's values of another type than the accessor's") {
    const std::string data = encode(*grid(), draco::MESH_EDGEBREAKER_ENCODING, 0);
    const auto colors = values_of<std::uint8_t>(must_read("u.glb", uncompressed(data)), "COLOR_0");
    const Mesh floats = must_read("c.glb", compressed(data, {.color = R"("componentType":5126,"type":"VEC4")"}));
    const auto values = values_of<float>(floats, "COLOR_0");
    REQUIRE(values.size() == colors.size());
    for (std::size_t i = 0; i < values.size(); ++i) CHECK(values[i] == static_cast<float>(colors[i]) / 255);
    const Mesh wide = must_read("c.glb", compressed(data, {.color = R"("componentType":5123,"type":"VEC4")"}));
    const auto shorts = values_of<std::uint16_t>(wide, "COLOR_0");
    CHECK(std::equal(shorts.begin(), shorts.end(), colors.begin(), colors.end()));
    CHECK(mentions(error_of({.color = R"("componentType":5121,"type":"VEC3")"}, data),
                   "has 4 components, the accessor 3"));
    CHECK(mentions(error_of({.color = R"("componentType":5120,"type":"VEC4")"}, data), "no value that fits"));
    CHECK(mentions(error_of({.ids = R"("POSITION":10,"COLOR_0":12)"}, data), "components"));
    CHECK(mentions(error_of({.ids = R"("POSITION":10,"COLOR_0":15)"}, data), "has floats, the accessor not"));
}

TEST_CASE("glTF: primitives with and without Draco data may share accessors") {
    const std::string data = encode(*grid(), draco::MESH_SEQUENTIAL_ENCODING, 0);
    const auto other_mesh = grid();
    const float moved[] = {7, 8, 9};
    other_mesh->attribute(0)->buffer()->Write(0, moved, sizeof moved);
    const std::string other = encode(*other_mesh, draco::MESH_SEQUENTIAL_ENCODING, 0);
    GltfMaker maker;
    maker.add_view(data, 0);
    maker.add_view(other, 0);
    maker.add_view(packed<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}), 0);
    maker.add_accessor(fmt::format(R"("componentType":5126,"count":{},"type":"VEC3")", kPoints));
    maker.add_accessor(R"("componentType":5123,"count":726,"type":"SCALAR")");
    maker.add_accessor(R"("bufferView":2,"componentType":5126,"count":3,"type":"VEC3")");
    const auto primitive = [](int view) {
        return fmt::format(
            R"({{"attributes":{{"POSITION":0}},"indices":1,"extensions":{{"KHR_draco_mesh_compression":{{"bufferView":{},"attributes":{{"POSITION":10}}}}}}}})",
            view);
    };
    const Mesh mesh = must_read("p.glb", maker.glb_file(kUsed + one_node +
                                                        mesh_of(primitive(0) + "," + primitive(1) +
                                                                R"(,{"attributes":{"POSITION":2}},)" + primitive(1))));
    const Floats values = values_of<float>(mesh, "POSITION");
    const Floats first = values_of<float>(must_read("u.glb", uncompressed(data)), "POSITION");
    const std::size_t n = first.size();
    REQUIRE(values.size() == 3 * n + 9);
    CHECK(std::equal(first.begin(), first.end(), values.begin()));
    CHECK(std::equal(values.begin() + 3, values.begin() + static_cast<std::ptrdiff_t>(n),
                     values.begin() + 3 + static_cast<std::ptrdiff_t>(n)));
    CHECK(Floats(values.begin() + static_cast<std::ptrdiff_t>(n),
                 values.begin() + static_cast<std::ptrdiff_t>(n) + 3) == Floats{7, 8, 9});
    CHECK(mesh.triangle_count() == 3 * 242 + 1);
}

TEST_CASE("glTF: Draco data without extensionsUsed or with fewer attributes than the primitive is read") {
    const std::string data = encode(*grid(), draco::MESH_EDGEBREAKER_ENCODING, 10);
    CHECK(error_of({}, data).empty());
    CHECK(error_of({.used = ""}, data).empty());
    // An accessor without a Draco attribute is read from its own view; these have none and so are zeros.
    CHECK(error_of({.ids = R"("POSITION":10)"}, data).empty());
    CHECK(error_of({.ids = R"("POSITION":10,"OTHER":99)"}, data).empty());
}

TEST_CASE("glTF: a primitive with bad Draco attributes, view, mode or indices is refused") {
    const std::string data = encode(*grid(), draco::MESH_EDGEBREAKER_ENCODING, 10);
    for (const auto& [ids, what] :
         {std::pair(R"("POSITION":99)", "attribute 99 does not exist"),
          std::pair(R"("POSITION":-1)", "not an unsigned integer"),
          std::pair(R"("POSITION":"10")", "not an unsigned integer"),
          std::pair(R"("POSITION":1.5)", "not an unsigned integer"), std::pair(R"("POSITION":12)", "has 2 components"),
          std::pair("", "attributes are missing")}) {
        const std::string error = error_of({.ids = ids}, data);
        CAPTURE(error);
        CHECK(mentions(error, what));
    }
    for (const char* view : {"1", "-1", "null", "\"0\"", "2147483647"}) {
        CAPTURE(view);
        CHECK(!error_of({.view = view}, data).empty());
    }
    CHECK(mentions(error_of({.primitive = R"("indices":7,"mode":6)"}, data), "mode 6"));
    CHECK(mentions(error_of({.primitive = R"("indices":99)"}, data), "accessor out of bounds"));
    CHECK(mentions(error_of({.index_type = "5122"}, data), "not unsigned"));
    CHECK(mentions(error_of({.index_type = "5126"}, data), "not unsigned"));
}

TEST_CASE("glTF: Draco data with a bad header is refused") {
    const std::string data = encode(*grid(), draco::MESH_EDGEBREAKER_ENCODING, 10);
    CHECK(mentions(error_of({}, "none"), "the data has no header"));
    const auto changed = [&data](std::size_t at, char byte) {
        std::string out = data;
        out[at] = byte;
        return out;
    };
    CHECK(mentions(error_of({}, changed(0, 'x')), "the data has no header"));
    CHECK(mentions(error_of({}, changed(6, 1)), "bitstream version 2.1 is not read"));
    CHECK(mentions(error_of({}, changed(5, 3)), "bitstream version 3.2 is not read"));
    CHECK(mentions(error_of({}, changed(7, 0)), "the data is not a mesh"));
    CHECK(mentions(error_of({}, changed(8, 9)), "encoding method 9 is not read"));
}

TEST_CASE("glTF: Draco data of huge counts is refused without allocating them") {
    const auto header = [](char method) { return std::string("DRACO\2\2\1", 8) + method + std::string(2, '\0'); };
    const std::string many("\xff\xff\xff\x7f", 4);  // 2^28 - 1
    const std::string zeros(1000, '\0');
    const auto error = [](const std::string& data) {
        const auto mesh = read_text("b.glb", compressed(data));
        REQUIRE(!mesh);
        return mesh.error();
    };
    CHECK(error(header(0) + many + many + zeros).code == ErrorCode::memory_limit);
    // The fields of Edgebreaker data: kind, vertices, faces, tables, symbols, splits.
    CHECK(error(header(1) + '\0' + many + many + '\0' + many + '\0' + zeros).code == ErrorCode::memory_limit);
    CHECK(error(header(1) + '\0' + '\3' + "\xff\xff\x7f" + '\xff' + '\1' + '\0' + zeros).code ==
          ErrorCode::memory_limit);
    CHECK(error(header(1) + '\0' + "\xff\xff\xff\xff\x0f" + many + '\0' + many + many + zeros).code ==
          ErrorCode::malformed);
    const auto little = read_mesh(write_text("b.glb", compressed(encode(*grid(), 1, 10))), {.max_bytes = 1000});
    REQUIRE(!little);
    CHECK(little.error().code == ErrorCode::memory_limit);
}

TEST_CASE("glTF: damaged Draco data is refused or read as a sound mesh") {
    std::mt19937 random(13);
    for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING}) {
        const std::string good = encode(*grid(), method, 10);
        for (int trial = 0; trial < 300; ++trial) {
            std::string data = good;
            if (trial < 60) data.resize(random() % data.size());
            for (int i = 0; i < trial % 4 && !data.empty(); ++i) {
                data[random() % data.size()] = static_cast<char>(random());
            }
            CAPTURE(method);
            CAPTURE(trial);
            const auto mesh = read_text("d.glb", compressed(data));
            if (mesh) CHECK(is_sound(*mesh));
        }
    }
}

#endif
