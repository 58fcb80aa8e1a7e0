// Tests Source::packed_vertices: pictures of positions that the device decodes equal those of the CPU's positions, and
// meshes of one lattice meet without cracks.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <tuple>

#include "tests/gpu/gpu_test.h"

using namespace lacedring;
using namespace lacedring::test;

namespace {

gpu::Model model_with(const Mesh& mesh, const VertexOptions& options) {
    Result<gpu::Model> model = gpu::make_model(mesh, {.packed = true, .vertices = options});
    REQUIRE_MESSAGE(model, model.error().message);
    return std::move(model).value();
}

VertexOptions lattice(std::uint32_t bits, float step = 0) {
    VertexOptions options;
    if (bits == 0 && step == 0) return options;  // lossless
    options.mapping = VertexMapping::lattice;
    options.bits = bits;
    options.step = step;
    return options;
}

struct PackedVertices : GpuTest {
    gpu::Renderer renderer(gpu::View view, std::uint64_t max_range, std::uint32_t width, std::uint32_t height) {
        gpu::RendererOptions options;
        options.view = view;
        options.width = width;
        options.height = height;
        options.max_range = max_range;
        Result<gpu::Renderer> out = gpu::Renderer::create(*context, options);
        REQUIRE_MESSAGE(out, out.error().message);
        return std::move(out).value();
    }

    /// `small`: with the paths that decode single vertices, which read half a block for each and are slow.
    std::vector<gpu::Subject> subjects(bool small) const {
        std::vector<gpu::Subject> out{{gpu::Source::packed_vertices, gpu::Path::compute}};
        if (!small) return out;
        for (const gpu::Path path : {gpu::Path::pull, gpu::Path::geometry, gpu::Path::mesh}) {
            if (path == gpu::Path::mesh && context->info().max_mesh_groups == 0) continue;
            out.push_back({gpu::Source::packed_vertices, path});
        }
        return out;
    }

    void check_same(gpu::Renderer& renderer, const gpu::Model& model, bool small) {
        const auto all = gpu::compare(renderer, model, subjects(small));
        REQUIRE_MESSAGE(all, all.error().message);
        for (std::size_t i = 0; i < all->size(); ++i) {
            CAPTURE(i);  // in subjects()
            const gpu::Comparison& c = (*all)[i];
            CHECK(c.pixels_different == 0);
            CHECK(c.triangle_ids_different == 0);
            CHECK(c.indices_equal_cpu);
            CHECK(c.vertices_equal_cpu == true);
            CHECK(!c.blank);
        }
    }
};

}  // namespace

TEST_CASE_FIXTURE(PackedVertices, "packed vertices have the same pictures by every path") {
    gpu::Renderer pictures = renderer(gpu::View::smooth, kSmallRange, 80, 60);  // one block per descriptor
    for (const char* kind : {"genus", "moebius", "parts", "soup"}) {
        CAPTURE(kind);
        for (const std::uint32_t bits : {0U, 12U}) {
            CAPTURE(bits);
            const Mesh mesh = generated(kind, 300, 2);
            const gpu::Model model = model_with(mesh, lattice(bits));
            CHECK((model.vertices.largest_error > 0) == (bits > 0));
            check_same(pictures, model, true);
        }
    }
    const Mesh mesh = generated("genus", 10000);  // has several groups of 16 blocks
    for (const std::uint32_t bits : {0U, 12U}) check_same(pictures, model_with(mesh, lattice(bits)), false);
}

TEST_CASE_FIXTURE(PackedVertices, "lines over packed vertices are drawn from the stream") {
    gpu::Renderer pictures = renderer(gpu::View::triangle_class, 0, 80, 60);
    const Mesh mesh = generated("blob", 600);
    const gpu::Model model = model_with(mesh, lattice(10));
    const auto camera = gpu::make_camera(model, {}, 80, 60);
    REQUIRE(camera);
    const auto drawn = [&](const gpu::Subject& subject) {
        Result<gpu::Drawable> drawable = pictures.upload(model, subject.source, subject.path);
        REQUIRE_MESSAGE(drawable, drawable.error().message);
        Result<gpu::Picture> picture = pictures.draw(*drawable, model, *camera, true);
        REQUIRE_MESSAGE(picture, picture.error().message);
        return std::move(picture).value();
    };
    const gpu::Picture plain = drawn({gpu::Source::plain, gpu::Path::compute});
    for (const gpu::Path path : {gpu::Path::compute, gpu::Path::pull}) {
        CHECK(gpu::difference(plain, drawn({gpu::Source::packed_vertices, path})).pixels == 0);
    }
}

TEST_CASE_FIXTURE(PackedVertices, "the comparison finds a vertex stream of other positions") {
    gpu::Renderer pictures = renderer(gpu::View::smooth, 0, 80, 60);
    const Mesh mesh = generated("sphere", 2000);
    gpu::Model model = model_with(mesh, lattice(8));
    model.vertices.words[7] += 1;  // moves all x by a step
    const auto moved = gpu::compare(pictures, model, subjects(false));
    REQUIRE(moved);
    CHECK(moved->front().pixels_different > 100);
    CHECK(!moved->front().same());
    model.vertices.words.clear();
    const auto none = gpu::compare(pictures, model, subjects(false));
    REQUIRE(!none);
    CHECK(none.error().code == ErrorCode::invalid_argument);
}

namespace {

Mesh mesh_with(std::vector<std::uint32_t> indices, std::span<const float> positions) {
    Mesh mesh;
    mesh.vertex_count = static_cast<std::uint32_t>(positions.size() / 3);
    mesh.indices = std::move(indices);
    Attribute position{"POSITION", ComponentType::f32, 3, false, {}};
    const auto bytes = std::as_bytes(positions);
    position.data.assign(bytes.begin(), bytes.end());
    mesh.attributes.push_back(std::move(position));
    return mesh;
}

/// A mesh cut along edges into two parts. The first part has the first triangles and vertices of the whole. The second
/// keeps the order of the whole's vertices, so that its triangles begin with the same vertex.
struct Cut {
    Mesh whole;
    std::array<Mesh, 2> parts;
    std::vector<std::uint32_t> second;  ///< by vertex of the second part: the whole's vertex

    /// first(center) tells whether a triangle with that center belongs to the first part.
    template <class First>
    Cut(const Mesh& mesh, const First& first) {
        const std::vector<float> all = positions_f32(mesh);
        std::array<std::vector<std::uint32_t>, 2> triangles;
        for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
            std::array<float, 3> center{};
            for (std::size_t i = 0; i < 9; ++i) center[i % 3] += all[3 * mesh.indices[t + i / 3] + i % 3] / 3;
            std::vector<std::uint32_t>& part = triangles[first(center) ? 0 : 1];
            part.insert(part.end(), &mesh.indices[t], &mesh.indices[t] + 3);
        }
        std::vector<std::uint32_t> number(mesh.vertex_count, UINT32_MAX), indices;
        std::vector<float> positions;
        for (auto& part : triangles) {
            for (std::uint32_t& v : part) {
                if (number[v] == UINT32_MAX) {
                    number[v] = static_cast<std::uint32_t>(positions.size() / 3);
                    positions.insert(positions.end(), &all[3 * std::size_t{v}], &all[3 * std::size_t{v}] + 3);
                }
                v = number[v];
            }
            if (&part == &triangles[0]) parts[0] = mesh_with(part, positions);
            indices.insert(indices.end(), part.begin(), part.end());
        }
        whole = mesh_with(std::move(indices), positions);
        second = triangles[1];
        std::sort(second.begin(), second.end());
        second.erase(std::unique(second.begin(), second.end()), second.end());
        std::vector<float> own;
        for (const std::uint32_t v : second)
            own.insert(own.end(), &positions[3 * std::size_t{v}], &positions[3 * std::size_t{v}] + 3);
        for (std::uint32_t& v : triangles[1]) {
            v = static_cast<std::uint32_t>(std::lower_bound(second.begin(), second.end(), v) - second.begin());
        }
        parts[1] = mesh_with(std::move(triangles[1]), own);
    }
};

/// Encodes a mesh; returns the positions that the device decodes, in the mesh's order, and the lattice's step.
std::pair<std::vector<float>, float> decoded_by_device(gpu::Renderer& renderer, const Mesh& mesh,
                                                       const VertexOptions& options) {
    const gpu::Model model = model_with(mesh, options);
    Result<gpu::Drawable> drawable = renderer.upload(model, gpu::Source::packed_vertices);
    REQUIRE_MESSAGE(drawable, drawable.error().message);
    const auto bits = renderer.read_positions(*drawable);
    REQUIRE_MESSAGE(bits, bits.error().message);
    std::vector<float> out(bits->size());
    for (std::size_t i = 0; i < bits->size(); ++i) {
        out[3 * std::size_t{model.packed.vertex_order[i / 3]} + i % 3] = std::bit_cast<float>((*bits)[i]);
    }
    return {std::move(out), view_vertices(model.vertices.words).value().step};
}

/// Compares the picture of both parts with that of the whole.
struct Together {
    std::uint64_t holes = 0;      ///< pixels of the whole where the parts show the background
    std::uint64_t cracks = 0;     ///< holes farther from the whole's outline than a lattice moves it
    std::uint64_t different = 0;  ///< pixels that differ
    std::uint64_t border = 0;     ///< vertices of both parts
    std::uint64_t open = 0;       ///< of these, vertices whose two positions differ
    std::array<float, 2> steps{};
};

Together drawn_together(gpu::Renderer& renderer, const Cut& cut, const VertexOptions& options, const Mesh& whole) {
    Together out;
    std::vector<float> positions, second;
    std::tie(positions, out.steps[0]) = decoded_by_device(renderer, cut.parts[0], options);
    std::tie(second, out.steps[1]) = decoded_by_device(renderer, cut.parts[1], options);
    const std::uint32_t own = cut.parts[0].vertex_count;
    for (std::size_t i = 0; i < cut.second.size(); ++i) {
        if (cut.second[i] >= own) continue;
        ++out.border;
        out.open += std::equal(&second[3 * i], &second[3 * i] + 3, &positions[3 * std::size_t{cut.second[i]}]) ? 0 : 1;
    }
    std::vector<std::uint32_t> indices = cut.parts[0].indices;
    for (const std::uint32_t v : cut.parts[1].indices) indices.push_back(own + v);
    positions.insert(positions.end(), second.begin(), second.end());
    const Mesh both = mesh_with(std::move(indices), positions);

    gpu::CameraOptions from_above;
    from_above.direction = {0.1, 0.2, 1};
    const auto reference = gpu::make_surface(whole);
    REQUIRE(reference);
    const auto [width, height] = renderer.target().extent();
    const auto camera = gpu::make_camera(*reference, from_above, width, height);
    REQUIRE(camera);
    const auto drawn = [&](const gpu::Model& model) {
        Result<gpu::Drawable> drawable = renderer.upload(model, gpu::Source::plain);
        REQUIRE_MESSAGE(drawable, drawable.error().message);
        Result<gpu::Picture> picture = renderer.draw(*drawable, model, *camera, true);
        REQUIRE_MESSAGE(picture, picture.error().message);
        return std::move(picture).value();
    };
    auto joined = gpu::make_surface(both);
    REQUIRE(joined);
    const gpu::Picture expected = drawn(*reference), picture = drawn(*joined);
    const gpu::Difference d = gpu::difference(expected, picture);
    REQUIRE(d.covered * 4 > expected.pixels());
    out.different = d.pixels;
    constexpr std::uint32_t kFar = 4;
    const auto inside = [&](std::uint32_t x, std::uint32_t y) {
        if (x < kFar || y < kFar || x + kFar >= width || y + kFar >= height) return false;
        for (std::uint32_t j = y - kFar; j <= y + kFar; ++j) {
            for (std::uint32_t i = x - kFar; i <= x + kFar; ++i) {
                if (expected.triangles[std::size_t{j} * width + i] == 0) return false;
            }
        }
        return true;
    };
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            const std::size_t i = std::size_t{y} * width + x;
            if (expected.triangles[i] == 0 || picture.triangles[i] != 0) continue;
            ++out.holes;
            out.cracks += inside(x, y) ? 1 : 0;
        }
    }
    return out;
}

}  // namespace

TEST_CASE_FIXTURE(PackedVertices,
                  "two meshes that share a border meet without a crack on one lattice, and crack on two") {
    gpu::Renderer pictures = renderer(gpu::View::flat, 0, 320, 240);
    const Mesh mesh = generated("terrain", 3000);
    const std::vector<float> p = positions_f32(mesh);
    std::array<float, 3> low{p[0], p[1], p[2]}, high = low;
    for (std::size_t i = 0; i < p.size(); ++i) {
        low[i % 3] = std::min(low[i % 3], p[i]);
        high[i % 3] = std::max(high[i % 3], p[i]);
    }
    // The first part is a quarter of the terrain: its own lattice is twice as fine.
    const Cut cut(mesh, [&](const std::array<float, 3>& c) {
        return c[0] < (low[0] + high[0]) / 2 && c[1] < (low[1] + high[1]) / 2;
    });
    const float step = std::exp2(std::ceil(std::log2(high[0] - low[0]))) / 128;
    const VertexOptions given = lattice(0, step);
    const std::vector<float> exact = positions_f32(cut.whole);
    const auto encoded = encode_vertices({ComponentType::f32, 3, false, std::as_bytes(std::span(exact))}, given);
    REQUIRE(encoded);
    std::vector<float> quantized(exact.size());
    decode_vertices(view_vertices(encoded->words).value(), std::as_writable_bytes(std::span(quantized)));
    const Mesh whole = mesh_with(cut.whole.indices, quantized);

    INFO("first with the same step for both parts, then with the same bits");
    const Together one = drawn_together(pictures, cut, given, whole);
    CHECK(one.steps[0] == step);
    CHECK(one.steps[1] == step);
    CHECK(one.border > 20);
    CHECK(one.open == 0);
    CHECK(one.holes == 0);
    CHECK(one.different == 0);

    const Together two = drawn_together(pictures, cut, lattice(7), whole);
    CHECK(two.steps[0] != two.steps[1]);
    CHECK(two.open * 2 > two.border);
    CHECK(two.cracks > 5);
    CHECK(two.different > 0);
}
