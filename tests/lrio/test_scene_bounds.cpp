// Tests the bounds (min, max) of accessors in packed and unpacked scenes.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/lrio/scene_files.h"
#include "tests/support/capture.h"

using namespace lacedring;
using nlohmann::json;
using test::GltfMaker;
using test::GridScene;

TEST_CASE("bounds of positions are those of the decoded values, also of few vertices") {
    for (const float at : {5.0F, -5.0F}) {
        for (std::uint32_t vertices = 3; vertices <= 9; ++vertices) {
            CAPTURE(at);
            CAPTURE(vertices);
            GltfMaker maker;
            std::vector<float> values;
            std::vector<std::uint8_t> fan;
            for (std::uint32_t v = 0; v < vertices; ++v) {
                const auto x = static_cast<float>(v);
                values.insert(values.end(), {at + std::sin(x), at + std::cos(x), at + 0.1F * x});
                if (v > 1) fan.insert(fan.end(), {0, static_cast<std::uint8_t>(v - 1), static_cast<std::uint8_t>(v)});
            }
            const int positions = test::add_rows(maker, 5126, "VEC3", values, 3);
            const int list = test::add_rows(maker, 5121, "SCALAR", fan, 1);
            const std::string glb = maker.glb_file(test::mesh_of(
                fmt::format(R"({{"attributes":{{"POSITION":{}}},"indices":{}}})", positions, list), test::one_node));
            PackOptions options = test::lossless();
            options.json = SceneJson::plain;
            const std::string packed = test::glb_of(test::must_pack(glb, options));
            for (const std::string& scene : {packed, test::glb_of(test::must_unpack(packed))}) {
                const json accessor = test::document_of(scene)["accessors"][0];
                for (std::size_t c = 0; c < 3; ++c) {
                    float low = values[c], high = values[c];
                    for (std::size_t i = c; i < values.size(); i += 3) {
                        low = std::min(low, values[i]);
                        high = std::max(high, values[i]);
                    }
                    CHECK(accessor["min"][c].get<float>() == low);
                    CHECK(accessor["max"][c].get<float>() == high);
                }
            }
        }
    }
}

TEST_CASE("morph targets with NaN or infinity are restored; with infinity they have no bounds") {
    for (const float odd : {static_cast<float>(NAN), -static_cast<float>(INFINITY)}) {
        for (const std::size_t where : {0U, 7U}) {
            CAPTURE(odd);
            CAPTURE(where);
            GltfMaker maker;
            const GridScene grid(3, 0);
            std::vector<float> moved(27, 0.5F);
            moved[where] = odd;
            const int positions = test::add_rows(maker, 5126, "VEC3", grid.positions, 3, 0, grid.bounds);
            const int target = test::add_rows(maker, 5126, "VEC3", moved, 3);
            const int list = test::add_rows(maker, 5121, "SCALAR", grid.indices_as<std::uint8_t>(), 1);
            const std::string glb = maker.glb_file(test::mesh_of(
                fmt::format(R"({{"attributes":{{"POSITION":{}}},"targets":[{{"POSITION":{}}}],"indices":{}}})",
                            positions, target, list),
                test::one_node));
            for (const auto& [name, options] : test::lossless_ways()) {
                CAPTURE_COPY(name);
                const std::string packed = test::glb_of(test::must_pack(glb, options));
                CHECK(is_packed_scene(test::bytes_of(packed)));
                const std::string unpacked = test::glb_of(test::must_unpack(packed));
                const json accessor = test::document_of(unpacked)["accessors"][1];  // throws if it is not JSON
                CHECK(accessor.contains("min") == !std::isinf(odd));
                CHECK(test::same_triangles(test::mesh_of_glb(unpacked), test::mesh_of_glb(glb)));
            }
        }
    }
}
