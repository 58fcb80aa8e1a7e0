#pragma once
// Helpers that pack and unpack scenes.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lacedring/scene.hpp"
#include "tests/lrio/gltf_maker.h"
#include "tests/support/cut_mesh.h"

namespace lacedring::test {

inline std::span<const std::byte> bytes_of(const std::string& text) {
    return std::as_bytes(std::span(text));
}

inline std::string glb_of(const SceneFile& scene) {
    const auto bytes = make_glb_file(scene);
    REQUIRE(bytes);
    return {reinterpret_cast<const char*>(bytes->data()), bytes->size()};
}

inline SceneFile must_pack(const std::string& glb, const PackOptions& options, PackReport* report = nullptr) {
    auto packed = pack_scene(bytes_of(glb), {}, options, {}, report);
    REQUIRE_MESSAGE(packed, packed.error().message);
    return std::move(*packed);
}

inline SceneFile must_unpack(const std::string& glb, UnpackReport* report = nullptr) {
    auto scene = unpack_scene(bytes_of(glb), {}, "", {}, report);
    REQUIRE_MESSAGE(scene, scene.error().message);
    return std::move(*scene);
}

inline Mesh mesh_of_glb(const std::string& glb) {
    auto mesh = read_mesh(bytes_of(glb), "x.glb");
    REQUIRE_MESSAGE(mesh, mesh.error().message);
    return std::move(*mesh);
}

/// The JSON document of a GLB.
inline nlohmann::json document_of(const std::string& glb) {
    std::uint32_t size = 0;
    std::memcpy(&size, glb.data() + 12, 4);
    return nlohmann::json::parse(glb.substr(20, size));
}

inline PackOptions lossless() {
    PackOptions options;
    options.bits = {};
    return options;
}

/// Options of lossless packing.
struct NamedOptions {
    const char* name;
    PackOptions options;
};

inline std::vector<NamedOptions> lossless_ways() {
    std::vector<NamedOptions> out(6, {"lossless", lossless()});
    out[1].name = "kept order";
    out[1].options.keep_order = true;
    out[2].name = "fallback";
    out[2].options.fallback = true;
    out[3].name = "packed document";
    out[3].options.json = SceneJson::packed;
    out[4].name = "packed document and kept order";
    out[4].options.json = SceneJson::packed;
    out[4].options.keep_order = true;
    out[5].name = "fallback and kept order";
    out[5].options.fallback = true;
    out[5].options.keep_order = true;
    return out;
}

inline bool same_triangles(const Mesh& a, const Mesh& b) {
    ValueNumbers numbers;
    return triangles_by_values(a, numbers) == triangles_by_values(b, numbers);
}

/// Adds values in a buffer view of their own and returns the number of their accessor. Rows are `stride` bytes apart;
/// 0: without padding.
template <class T>
int add_rows(GltfMaker& maker, int component_type, const char* type, const std::vector<T>& values,
             std::size_t components, std::size_t stride = 0, const std::string& more = "") {
    std::string bytes;
    for (std::size_t i = 0; i < values.size(); ++i) {
        put(bytes, values[i]);
        if (stride > 0 && (i + 1) % components == 0) bytes.append(stride - components * sizeof(T), '\x7f');
    }
    const int view = maker.add_view(bytes, static_cast<int>(stride));
    return maker.add_accessor(fmt::format(R"("bufferView":{},"componentType":{},"count":{},"type":"{}"{})", view,
                                          component_type, values.size() / components, type, more));
}

/// A triangulated grid of size * size distinct points.
struct GridScene {
    std::vector<float> positions, texcoords;
    std::vector<std::uint32_t> indices;
    std::string bounds;

    GridScene(std::uint32_t size, float at) {
        for (std::uint32_t i = 0; i < size * size; ++i) {
            const auto x = static_cast<float>(i % size), y = static_cast<float>(i / size);
            positions.insert(positions.end(), {at + x, y * 0.37F, std::sin(x + 2 * y)});
            texcoords.insert(texcoords.end(), {x / 7, y / 9});
        }
        for (std::uint32_t i = 0; i + size < size * size; ++i) {
            if (i % size == size - 1) continue;
            indices.insert(indices.end(), {i, i + 1, i + size, i + 1, i + size + 1, i + size});
        }
        std::string low, high;
        for (std::size_t c = 0; c < 3; ++c) {
            float least = INFINITY, most = -INFINITY;
            for (std::size_t i = c; i < positions.size(); i += 3) {
                least = std::min(least, positions[i]);
                most = std::max(most, positions[i]);
            }
            low += fmt::format("{}{}", c == 0 ? "" : ",", least);
            high += fmt::format("{}{}", c == 0 ? "" : ",", most);
        }
        bounds = fmt::format(R"(,"min":[{}],"max":[{}])", low, high);
    }

    template <class T>
    std::vector<T> indices_as() const {
        std::vector<T> out;
        for (const std::uint32_t v : indices) out.push_back(static_cast<T>(v));
        return out;
    }
};

}  // namespace lacedring::test
