// Tests reading glTF materials and the attributes that they need.
#include <doctest/doctest.h>

#include "lacedring/materials.hpp"
#include "tests/lrio/gltf_maker.h"

using namespace lacedring;
using namespace lacedring::test;

namespace {

struct Drawn {
    Mesh mesh;
    Materials materials;
    ReadReport report;
};

Drawn must_read(const std::string& file) {
    Drawn out;
    auto mesh = read_mesh(std::as_bytes(std::span(file)), "x.glb", {}, &out.report, &out.materials);
    const std::string message = mesh ? std::string() : mesh.error().message;
    CAPTURE(message);
    REQUIRE(mesh.has_value());
    out.mesh = std::move(*mesh);
    return out;
}

/// A mesh, placed twice, of two primitives of two triangles each: one bare; one with a material, texture coordinates
/// and colors of bytes. `rest`: further members of the document, as JSON that begins with a comma.
std::string scene(const std::string& material, const std::string& rest) {
    GltfMaker maker;
    maker.floats("VEC3", square, 3);                                                                                // 0
    maker.add<std::uint16_t>(5123, "SCALAR", {0, 1, 2, 0, 2, 3}, 1);                                                // 1
    maker.add<std::uint8_t>(5121, "VEC2", {0, 0, 255, 0, 255, 255, 0, 51}, 2, true);                                // 2
    maker.add<std::uint8_t>(5121, "VEC4", {255, 0, 0, 255, 0, 255, 0, 51, 0, 0, 255, 255, 102, 0, 0, 0}, 4, true);  // 3
    const std::string image = "an image, or not";
    const int view = maker.add_view(image, 0);
    return maker.glb_file(R"("nodes":[{"mesh":0},{"mesh":0,"translation":[0,0,2]}],"meshes":[{"primitives":[
        {"attributes":{"POSITION":0},"indices":1},
        {"attributes":{"POSITION":0,"TEXCOORD_0":2,"COLOR_0":3},"indices":1,"material":0}]}],
        "images":[{"bufferView":)" +
                          std::to_string(view) +
                          R"(,"mimeType":"image/png"},{"uri":"../outside.png"},{"uri":"data:,here"}],"materials":[)" +
                          material + "]" + rest);
}

}  // namespace

TEST_CASE("materials: properties, textures, and the attributes that they need") {
    const std::string textures = R"(,"samplers":[{"wrapS":33071,"wrapT":33648,"magFilter":9728},{}],
        "textures":[{"source":0,"sampler":0},{"source":1},{"source":2,"sampler":1},{"extensions":{"EXT_texture_webp":{}}}])";
    const auto [mesh, materials, report] = must_read(scene(R"({"pbrMetallicRoughness":{
        "baseColorFactor":[0.5,0.25,1,0.75],"metallicFactor":0.5,"roughnessFactor":0.125,
        "baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":{"offset":[1,2],"scale":[3,4]}}},
        "metallicRoughnessTexture":{"index":1}},
        "normalTexture":{"index":2,"scale":2,"texCoord":1},"occlusionTexture":{"index":3,"strength":0.5},
        "emissiveFactor":[0,0.5,1],"alphaMode":"MASK","alphaCutoff":0.25,"doubleSided":true,
        "extensions":{"KHR_materials_unlit":{},"KHR_materials_emissive_strength":{"emissiveStrength":2},
                      "KHR_materials_sheen":{}}})",
                                                           textures));
    REQUIRE(materials.materials.size() == 4);
    SUBCASE("each triangle has its material; without normals, the flat twin") {
        CHECK(materials.of_triangle == std::vector<std::uint32_t>{2, 2, 3, 3, 2, 2, 3, 3});
        CHECK_FALSE(materials.materials[0].flat);
        CHECK((materials.materials[2].flat && materials.materials[3].flat));
    }
    const Material& m = materials.materials[3];
    SUBCASE("factors, alpha and flags of the material") {
        CHECK(m.base_color == std::array<float, 4>{0.5F, 0.25F, 1, 0.75F});
        CHECK(m.emissive == std::array<float, 3>{0, 1, 2});
        CHECK(m.metallic == 0.5F);
        CHECK(m.roughness == 0.125F);
        CHECK(m.normal_scale == 2);
        CHECK(m.occlusion == 0.5F);
        CHECK(m.cutoff == 0.25F);
        CHECK(m.alpha == AlphaMode::mask);
        CHECK((m.double_sided && m.unlit));
    }
    SUBCASE("a primitive without a material is white") {
        CHECK(materials.materials[1].base_color == std::array<float, 4>{1, 1, 1, 1});
    }
    SUBCASE("the base color texture has an image, wrapping, a filter and a transform") {
        CHECK(m.base.image == 0);
        CHECK(m.base.wrap_u == TextureWrap::clamp);
        CHECK(m.base.wrap_v == TextureWrap::mirror);
        CHECK(m.base.nearest);
        CHECK(m.base.transform == std::array<float, 6>{3, 0, 1, 0, 4, 2});
    }
    SUBCASE("other textures have images, sets of coordinates and wrapping") {
        CHECK(m.metallic_roughness.image == 1);
        CHECK(m.normal.image == 2);
        CHECK(m.normal.set == 1);
        CHECK(m.normal.wrap_u == TextureWrap::repeat);
        CHECK(m.occluding.image == TextureUse::kNone);
    }
    SUBCASE("images in buffer views and data URIs are kept, one outside the folder is empty") {
        REQUIRE(materials.images.size() == 3);
        CHECK(materials.images[0].size() == 16);
        CHECK(materials.images[1].empty());
        CHECK(materials.images[2].size() == 4);
    }
    SUBCASE("the report names missing images and unknown extensions") {
        const auto said = [&left_out = report.left_out](std::string_view text) {
            return std::ranges::any_of(left_out, [&](const std::string& s) { return s.find(text) != s.npos; });
        };
        CHECK(said("image 1: '../outside.png'"));
        CHECK(said("1 texture without an image"));
        CHECK(said("'KHR_materials_sheen'"));
        CHECK(!said("material "));
    }
    SUBCASE("vertices have colors and texture coordinates; white and 0 where the file has none") {
        const std::vector<float> colors = values_of<float>(mesh, "COLOR_0"), uv = values_of<float>(mesh, "TEXCOORD_0");
        REQUIRE(colors.size() == std::size_t{4} * mesh.vertex_count);
        REQUIRE(uv.size() == std::size_t{2} * mesh.vertex_count);
        REQUIRE(mesh.vertex_count == 16);
        CHECK(std::vector(colors.begin(), colors.begin() + 4) == std::vector<float>{1, 1, 1, 1});
        CHECK(std::vector(colors.begin() + 16, colors.begin() + 24) == std::vector<float>{1, 0, 0, 1, 0, 1, 0, 0.2F});
        CHECK(std::vector(uv.begin(), uv.begin() + 2) == std::vector<float>{0, 0});
        CHECK(std::vector(uv.begin() + 14, uv.begin() + 16) == std::vector<float>{0, 0.2F});
    }
}

TEST_CASE("materials: if not requested, colors are left out and the report says so") {
    const std::string file = scene("{}", "");
    ReadReport report;
    const auto mesh = read_mesh(std::as_bytes(std::span(file)), "x.glb", {}, &report);
    REQUIRE(mesh.has_value());
    CHECK(find_attribute(*mesh, "COLOR_0") == nullptr);
    CHECK(std::ranges::find(report.left_out, "1 material") != report.left_out.end());
}

TEST_CASE("materials: malformed ones are refused with their number") {
    for (const char* material :
         {"3", R"({"alphaCutoff":"x"})", R"({"emissiveFactor":[1,2]})", R"({"emissiveFactor":[1,2,"x"]})",
          R"({"doubleSided":1})", R"({"normalTexture":{"index":0}})", R"({"normalTexture":{}})",
          R"({"pbrMetallicRoughness":{"metallicFactor":1e39}})"}) {
        CAPTURE(material);
        const std::string file = scene(material, "");
        Materials materials;
        const auto mesh = read_mesh(std::as_bytes(std::span(file)), "x.glb", {}, nullptr, &materials);
        REQUIRE(!mesh.has_value());
        CHECK(mesh.error().message.starts_with("glTF: material 0: "));
    }
}
