#include "tests/support/meshes.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include "lacedring/mesh_files.hpp"
#include "lrlab/generate/generate.h"
#include "tests/support/shapes.h"

namespace lacedring::test {

Mesh make_mesh(std::vector<std::uint32_t> indices, std::uint32_t vertex_count) {
    Mesh mesh;
    mesh.vertex_count = vertex_count;
    mesh.indices = std::move(indices);
    std::vector<float> positions;
    SplitMix64 random(vertex_count);
    for (std::uint32_t v = 0; v < vertex_count; ++v) {
        const auto unit = [&] { return static_cast<float>(random.below(1U << 24)) * (1.0F / 8388608.0F) - 1.0F; };
        const float x = unit();
        const float y = unit();
        positions.insert(positions.end(), {x, y, static_cast<float>(v) / 1024.0F});
    }
    Attribute position{"POSITION", ComponentType::f32, 3, false, {}};
    position.data.resize(positions.size() * sizeof(float));
    if (!positions.empty()) std::memcpy(position.data.data(), positions.data(), position.data.size());
    mesh.attributes.push_back(std::move(position));
    return mesh;
}

Mesh make_mesh(std::span<const std::array<std::uint32_t, 3>> triangles, std::uint32_t vertex_count) {
    std::vector<std::uint32_t> indices;
    for (const auto& t : triangles) indices.insert(indices.end(), t.begin(), t.end());
    return make_mesh(std::move(indices), vertex_count);
}

Mesh random_soup(std::uint32_t vertices, std::uint32_t triangles, std::uint64_t seed, bool degenerate) {
    std::vector<std::uint32_t> indices;
    SplitMix64 random(seed);
    while (indices.size() < std::size_t{3} * triangles) {
        const std::uint32_t a = random.below(vertices);
        const std::uint32_t b = random.below(vertices);
        const std::uint32_t c = random.below(vertices);
        if (!degenerate && vertices >= 3 && (a == b || b == c || c == a)) continue;
        indices.insert(indices.end(), {a, b, c});
    }
    return make_mesh(std::move(indices), vertices);
}

Mesh random_gluing(std::uint32_t vertices, std::uint32_t triangles, std::uint64_t seed) {
    std::vector<std::uint32_t> indices;
    SplitMix64 random(seed);
    std::uint32_t used = 3;
    for (std::uint32_t t = 0; t < triangles; ++t) {
        if (t == 0) {
            indices = {0, 1, 2};
            continue;
        }
        // Mostly glued to one of the last triangles, which makes fans and strips. The tip is a new, a recent or any
        // vertex.
        const std::uint32_t reach = random.below(4) == 0 ? t : std::min(t, 6U);
        const std::uint32_t base = t - 1 - random.below(reach);
        const std::uint32_t side = random.below(3);
        std::uint32_t a = indices[3 * base + (side + 1) % 3];
        std::uint32_t b = indices[3 * base + side];
        std::uint32_t tip = 0;
        const std::uint32_t choice = random.below(8);
        if (choice < 4 && used < vertices) {
            tip = used++;
        } else if (choice < 7) {
            tip = indices[random.below(3 * std::min(t, 8U)) + 3 * (t - std::min(t, 8U))];
        } else {
            tip = random.below(used);
        }
        if (random.below(12) == 0) std::swap(a, b);
        indices.insert(indices.end(), {a, b, tip});
    }
    return make_mesh(std::move(indices), vertices);
}

std::optional<std::size_t> for_each_real_mesh(
    const std::function<void(const std::string& path, const Result<Mesh>& mesh)>& visit) {
    const char* folder = std::getenv("LACEDRING_MESHES");
    if (folder == nullptr) return std::nullopt;
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string extension = entry.path().extension().string();
        if (extension == ".tsv" || extension == ".bin") continue;
        visit(entry.path().string(), read_mesh(entry.path()));
        ++count;
    }
    return count;
}

std::vector<std::array<std::uint32_t, 3>> oriented_triangles(std::span<const std::uint32_t> indices) {
    std::vector<std::array<std::uint32_t, 3>> out;
    out.reserve(indices.size() / 3);
    for (std::size_t i = 0; i + 3 <= indices.size(); i += 3) {
        std::array<std::uint32_t, 3> t{indices[i], indices[i + 1], indices[i + 2]};
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        out.push_back(t);
    }
    std::sort(out.begin(), out.end());
    return out;
}

namespace {

/// `shape` with the triangles `more` added.
Shape with(Shape shape, std::vector<Triangle> more) {
    shape.triangles.insert(shape.triangles.end(), more.begin(), more.end());
    return shape;
}

std::vector<std::pair<std::string, Shape>> tiny_shapes() {
    return {
        {"one triangle", {3, {{0, 1, 2}}}},
        {"one triangle and a degenerate one", {4, {{0, 1, 2}, {1, 1, 3}}}},
        {"degenerate triangles only", {3, {{0, 0, 1}, {2, 1, 2}, {1, 1, 1}, {0, 2, 2}}}},
        {"no triangles", {5, {}}},
        {"no vertices", {0, {}}},
        {"two triangles on an edge", {4, {{0, 1, 2}, {2, 1, 3}}}},
        {"two triangles on an edge, one turned", {4, {{0, 1, 2}, {1, 2, 3}}}},
        {"two triangles back to back", {3, {{0, 1, 2}, {0, 2, 1}}}},
        {"one triangle twice", {3, {{0, 1, 2}, {1, 2, 0}}}},
        {"one triangle twice each way", {3, {{0, 1, 2}, {1, 2, 0}, {2, 1, 0}, {0, 2, 1}}}},
        {"one triangle seven times",
         {3, {{0, 1, 2}, {0, 1, 2}, {1, 2, 0}, {2, 1, 0}, {0, 1, 2}, {0, 2, 1}, {2, 0, 1}}}},
        {"bow-tie", {5, {{0, 1, 2}, {0, 3, 4}}}},
        {"three triangles in a row of bow-ties", {7, {{0, 1, 2}, {2, 3, 4}, {4, 5, 6}}}},
        {"bow-tie ring", {6, {{0, 1, 2}, {2, 3, 4}, {4, 5, 0}}}},
        {"three triangles on an edge", {5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}}},
        {"three triangles on an edge, alike", {5, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}}},
        {"four triangles on an edge", {6, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {1, 0, 5}}}},
        {"four triangles on an edge, alike", {6, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {0, 1, 5}}}},
        {"flap on a back to back pair", {4, {{0, 1, 2}, {0, 2, 1}, {0, 1, 3}}}},
        {"isolated vertices", {12, {{2, 7, 4}, {7, 2, 9}, {4, 7, 11}}}},
        {"quad and triangle apart", {7, {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}}}},
        {"smallest Moebius strip", {5, {{0, 1, 2}, {1, 2, 3}, {2, 3, 4}, {3, 4, 0}, {4, 0, 1}}}},
        {"tetrahedron less one", {4, {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}}}},
        {"tetrahedron with a wall", with({5, tetrahedron().triangles}, {{0, 1, 4}})},
        {"triangle of four on its edge midpoints", subdivide({3, {{0, 1, 2}}})},
    };
}

std::vector<std::pair<std::string, Shape>> surface_shapes() {
    std::vector<std::pair<std::string, Shape>> out{
        {"tetrahedron", tetrahedron()},
        {"octahedron", octahedron()},
        {"cube", cube()},
        {"cube, some turned", turn_some(cube(), 3)},
        {"fan", fan(7, false)},
        {"disc", fan(7, true)},
        {"disc of three", fan(3, true)},
        {"strip", strip(20)},
        {"strip of two", strip(2)},
        {"strip of three", strip(3)},
        {"grid", grid(6, 5, false, false, false)},
        {"grid, shuffled", shuffle(grid(9, 7, false, false, false), 5)},
        {"grid, every triangle turned at random", turn_some(shuffle(grid(9, 7, false, false, false), 6), 2)},
        {"annulus", grid(8, 2, true, false, false)},
        {"thin annulus", grid(3, 1, true, false, false)},
        {"disc with holes", grid_with_holes(9, 7)},
        {"genus 1 plate", plate(1)},
        {"genus 2 plate", plate(2)},
        {"genus 5 plate", plate(5)},
        {"smallest torus", smallest_torus()},
        {"torus", grid(7, 5, true, true, false)},
        {"Klein bottle", grid(7, 6, true, true, true)},
        {"projective plane", projective_plane()},
        {"projective plane, subdivided", subdivide(subdivide(projective_plane()))},
        {"sphere with its poles pinched together", pinch(bipyramid(9), 1, 0)},
        {"octahedron with two opposite vertices joined", pinch(octahedron(), 4, 2)},
        {"octahedron with two neighbors joined", pinch(octahedron(), 3, 2)},
        {"torus pinched twice", pinch(pinch(grid(8, 8, true, true, false), 0, 36), 5, 51)},
        {"two tetrahedra at a vertex", pinch(beside(tetrahedron(), tetrahedron()), 4, 0)},
        {"two tetrahedra on an edge", pinch(pinch(beside(tetrahedron(), tetrahedron()), 4, 0), 5, 1)},
        {"two tetrahedra on a triangle", pinch(pinch(pinch(beside(tetrahedron(), tetrahedron()), 4, 0), 5, 1), 6, 2)},
        {"cube in a torus beside a strip", beside(beside(cube(), smallest_torus()), strip(5))},
        {"octahedron, every triangle twice", with(octahedron(), octahedron().triangles)},
        {"octahedron and its reverse", with(octahedron(), turn_some(octahedron(), 1).triangles)},
        {"grid, both sides", double_some(grid(9, 7, false, false, false), 1, true)},
        {"torus, every third triangle twice", shuffle(double_some(grid(20, 20, true, true, false), 3, false), 4)},
        {"grid, four times", double_some(double_some(grid(6, 5, false, false, false), 1, true), 1, false)},
        {"triangle subdivided", subdivide(subdivide(subdivide({3, {{0, 1, 2}}})))},
        {"octahedron subdivided", subdivide(subdivide(subdivide(octahedron())))},
        {"triangle in triangles", stack_all(stack_all(stack_all(stack_all({3, {{0, 1, 2}}}))))},
        {"Apollonian network", stack_all(stack_all(stack_all(stack_all(tetrahedron()))))},
        {"random stack", stack_random(tetrahedron(), 600, 4)},
        {"spiral stack", stack_spiral(tetrahedron(), 300)},
        {"stacked grid", stack_all(grid(10, 10, false, false, false))},
        {"twice stacked torus", stack_all(stack_all(grid(6, 6, true, true, false)))},
        {"bipyramid of three", bipyramid(3)},
        {"bipyramid of 500", bipyramid(500)},
        {"double fan of 1", double_fan(1)},
        {"double fan of 200", double_fan(200)},
        {"double fan, shuffled", shuffle(double_fan(200), 8)},
        {"star of 10000", fan(10000, true)},
        {"open star of 10000", fan(10000, false)},
    };
    for (const std::uint32_t length : {3U, 4U, 5U, 6U, 50U}) {
        out.emplace_back(fmt::format("Moebius strip of {}", length), grid(length, 1, true, false, true));
    }
    out.emplace_back("wide Moebius strip", grid(20, 5, true, false, true));
    out.emplace_back("wide Moebius strip, some turned", turn_some(grid(20, 6, true, false, true), 4));
    out.emplace_back("annulus with a twisted numbering", shuffle(turn_some(grid(12, 1, true, false, false), 3), 2));
    Shape loose{};
    Shape pairs{};
    for (int i = 0; i < 1000; ++i) {
        loose = {loose.vertices + 3, std::move(loose.triangles)};
        loose.triangles.push_back({loose.vertices - 3, loose.vertices - 2, loose.vertices - 1});
    }
    for (int i = 0; i < 300; ++i) pairs = beside(pairs, strip(2));
    out.emplace_back("a thousand loose triangles", loose);
    out.emplace_back("three hundred quads", pairs);
    out.emplace_back("loose triangles that all meet in one vertex", [] {
        Shape shape{1, {}};
        for (std::uint32_t i = 0; i < 200; ++i) shape.triangles.push_back({0, 1 + 2 * i, 2 + 2 * i});
        shape.vertices = 401;
        return shape;
    }());
    out.emplace_back("book of 50 pages", [] {
        Shape shape{52, {}};
        for (std::uint32_t i = 0; i < 50; ++i)
            shape.triangles.push_back({i % 3 == 0 ? 1U : 0U, i % 3 == 0 ? 0U : 1U, 2 + i});
        return shape;
    }());
    return out;
}

}  // namespace

std::vector<NamedMesh> named_meshes() {
    std::vector<NamedMesh> out;
    for (const auto& shapes : {tiny_shapes(), surface_shapes()}) {
        for (const auto& [name, shape] : shapes) out.push_back({name, make_mesh(shape.triangles, shape.vertices)});
    }
    for (const GeneratorInfo& info : generators()) {
        for (const auto& [triangles, seed] :
             {std::pair{1U, 1U}, {60U, 2U}, {500U, 1U}, {500U, 2U}, {kSanitized ? 1000U : 5000U, 3U}}) {
            Result<Mesh> mesh = generate(info.name, triangles, seed);
            if (!mesh) std::abort();  // tests/lrlab/test_generate.cpp reports the error
            out.push_back({fmt::format("{} {} seed {}", info.name, triangles, seed), std::move(*mesh)});
        }
    }
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
        out.push_back({fmt::format("random soup {}", seed), random_soup(5 + 20 * seed, 100 * seed, seed)});
        out.push_back({fmt::format("random gluing {}", seed), random_gluing(100 * seed, 300 * seed, seed)});
    }
    return out;
}

}  // namespace lacedring::test
