#include "tests/support/cuts.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <span>
#include <utility>

#include "tests/support/shapes.h"

namespace lacedring::test {

CutSurface cut_by_chart(std::vector<std::uint32_t> triangles, std::uint32_t vertices,
                        const std::function<std::uint32_t(std::uint32_t corner)>& chart_of) {
    CutSurface out{std::move(triangles), {}, vertices};
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> numbers;  // of the copies
    for (std::uint32_t c = 0; c < out.triangles.size(); ++c) {
        const auto number = static_cast<std::uint32_t>(7 * numbers.size() + 3);
        out.copies.push_back(numbers.emplace(std::pair(out.triangles[c], chart_of(c)), number).first->second);
    }
    return out;
}

CutSurface cut(const std::vector<std::uint32_t>& triangles, std::uint32_t vertices, std::uint32_t how,
               std::uint64_t seed) {
    std::uint64_t state = seed;
    std::uint32_t chart = 0;
    return cut_by_chart(triangles, vertices, [&](std::uint32_t c) {
        if (how == 1) chart = c / 3 / 37 % 5;
        if (how == 2 && c % 3 == 0) chart = random_below(state, 4) / 3;
        if (how == 3) chart = c / 3;
        if (how == 4) chart = random_below(state, 1 + random_below(state, 5));
        return chart;
    });
}

CutMesh cut_mesh(const Mesh& whole, std::uint32_t how, std::uint64_t seed) {
    const CutSurface surface = cut(whole.indices, whole.vertex_count, how, seed);
    const std::vector<float> all = positions_f32(whole);
    CutMesh out;
    out.surface_vertices = whole.vertex_count;
    std::vector<float> positions, normals;
    std::uint64_t state = seed;
    const auto add = [&](std::uint32_t v) {
        out.surface.push_back(v);
        std::array<float, 3> normal{};
        for (float& x : normal) x = static_cast<float>(random_below(state, 2000)) / 1000 - 0.9995F;
        const float length = std::hypot(normal[0], normal[1], normal[2]);
        for (std::size_t i = 0; i < 3; ++i) {
            positions.push_back(all[3 * std::size_t{v} + i]);
            normals.push_back(normal[i] / length);
        }
    };
    add(0);
    std::map<std::uint32_t, std::uint32_t> numbers;  // of the copies
    for (std::size_t k = 0; k < surface.copies.size(); ++k) {
        const auto number = static_cast<std::uint32_t>(out.surface.size());
        const auto [at, is_new] = numbers.emplace(surface.copies[k], number);
        if (is_new) add(whole.indices[k]);
        out.mesh.indices.push_back(at->second);
    }
    out.mesh.vertex_count = static_cast<std::uint32_t>(out.surface.size());
    const auto put = [&](const char* name, std::span<const float> values) {
        const auto bytes = std::as_bytes(values);
        out.mesh.attributes.push_back({name, ComponentType::f32, 3, false, {bytes.begin(), bytes.end()}});
    };
    put("POSITION", positions);
    put("NORMAL", normals);
    return out;
}

}  // namespace lacedring::test
