// Encodes whole meshes in the formats of rivals, and decodes them.

#include <doctest/doctest.h>

#include <cstring>

#include "lrlab/generate/generate.h"
#include "lrlab/rivals/compressors.h"
#include "lrlab/rivals/whole_mesh.h"
#include "tests/support/capture.h"
#include "tests/support/meshes.h"

using namespace lacedring;

namespace {

template <class T>
Attribute attribute(const char* name, ComponentType type, std::uint8_t components, const std::vector<T>& values) {
    Attribute out{name, type, components, false, {}};
    out.data.resize(values.size() * sizeof(T));
    std::memcpy(out.data.data(), values.data(), out.data.size());
    return out;
}

/// A generated mesh with one attribute of each kind.
Mesh with_attributes(const char* kind) {
    Mesh mesh = *generate(kind, 1500);
    const std::vector<float> normals = normals_f32(mesh);
    mesh.attributes.resize(1);
    mesh.attributes.push_back(attribute("NORMAL", ComponentType::f32, 3, normals));
    std::vector<float> texcoords, tangents;
    std::vector<std::uint8_t> colors;
    std::vector<double> heights;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        texcoords.insert(texcoords.end(), {normals[3 * v] / 3, normals[3 * v + 1]});
        tangents.insert(tangents.end(),
                        {normals[3 * v + 1], normals[3 * v + 2], normals[3 * v], v % 3 == 0 ? 1.F : -1.F});
        colors.insert(colors.end(), {static_cast<std::uint8_t>(v), static_cast<std::uint8_t>(v / 7), 255});
        heights.push_back(v / 3.0);
    }
    mesh.attributes.push_back(attribute("TEXCOORD_0", ComponentType::f32, 2, texcoords));
    mesh.attributes.push_back(attribute("TANGENT", ComponentType::f32, 4, tangents));
    mesh.attributes.push_back(attribute("COLOR_0", ComponentType::u8, 3, colors));
    mesh.attributes.push_back(attribute("height", ComponentType::f64, 1, heights));
    return mesh;
}

AttributeBits bits_of(std::uint32_t bits) {
    AttributeBits out;
    out.positions = out.normals = out.texcoords = out.colors = out.weights = bits;
    return out;
}

}  // namespace

TEST_CASE("meshoptimizer decodes whole meshes within the errors of their lattices") {
    for (const char* const kind : {"blob", "parts", "moebius"}) {
        const Mesh mesh = with_attributes(kind);
        for (const std::uint32_t bits : {0U, 8U, 12U, 16U}) {
            CAPTURE_COPY(kind);
            CAPTURE(bits);
            const Result<RivalMesh> coded = encode_meshopt_mesh(mesh, bits_of(bits));
            REQUIRE(coded);
            CHECK(coded->invalid == "");
            CHECK(coded->bytes.size() < store_raw(mesh).bytes.size());
            REQUIRE(coded->largest_errors.size() == mesh.attributes.size());
            for (std::size_t i = 0; i < 4; ++i) CHECK((coded->largest_errors[i] > 0) == (bits > 0));
            CHECK(coded->largest_errors[4] == 0);
            CHECK(coded->largest_errors[5] == 0);
        }
    }
}

TEST_CASE("Draco decodes whole meshes") {
    for (const char* const kind : {"blob", "genus", "terrain"}) {
        const Mesh mesh = with_attributes(kind);
        for (const std::uint32_t bits : {0U, 12U}) {
            CAPTURE_COPY(kind);
            CAPTURE(bits);
            const Result<RivalMesh> coded = encode_draco_mesh(mesh, bits_of(bits));
            if (draco_version().empty()) {
                CHECK(coded.error().message == "built without libdraco");
                continue;
            }
            REQUIRE(coded);
            CHECK(coded->invalid == "");
            CHECK(coded->bytes.size() < store_raw(mesh).bytes.size());
            REQUIRE(coded->largest_errors.size() == mesh.attributes.size());
            for (std::size_t i = 0; i < 4; ++i) {
                CHECK((coded->largest_errors[i] > 0) == (bits > 0));
                CHECK(coded->largest_errors[i] < 0.01);
            }
        }
    }
}

TEST_CASE("the bytes of a mesh in memory") {
    const Mesh mesh = with_attributes("blob");
    CHECK(store_raw(mesh).bytes.size() == 2 * mesh.indices.size() + (12 + 12 + 8 + 16 + 3 + 8) * mesh.vertex_count);
    Mesh large = test::make_mesh({0, 1, 65536}, 65537);
    large.attributes.clear();
    CHECK(store_raw(large).bytes.size() == 12);
}

TEST_CASE("general compressors restore their input") {
    const std::vector<std::byte> zeros(100000, std::byte{0});
    CHECK(deflated_size(zeros) < 200);
    CHECK(zstd_size(zeros).value_or(0) < 200);
    CHECK(brotli_size(zeros).value_or(0) < 200);
}
