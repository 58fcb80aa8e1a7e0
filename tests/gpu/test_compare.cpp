// The streams' pictures are the plain path's, bit for bit, and a blank picture is no proof of it.

#include <cstring>

#include "tests/gpu/gpu_test.h"
#include "tests/support/meshes.h"

using namespace lr;
using namespace lr::test;

namespace {

constexpr gpu::Source kStreams[] = {gpu::Source::lean, gpu::Source::packed};

gpu::Comparison compared(gpu::Context& context, const gpu::Model& model, gpu::Source source = gpu::Source::lean,
                         std::uint64_t max_range = 0) {
    gpu::CompareOptions options;
    options.width = 160;
    options.height = 120;
    options.max_range = max_range;
    Result<gpu::Comparison> out = gpu::compare(context, model, {source}, options);
    REQUIRE_MESSAGE(out, out.error().message);
    return std::move(out).value();
}

void check_same(const gpu::Comparison& c) {
    CHECK(c.pixels_different == 0);
    CHECK(c.max_channel_difference == 0);
    CHECK(c.triangle_ids_different == 0);
    CHECK(c.indices_equal_cpu);
    CHECK(c.views >= 6);
}

Mesh from_points(std::vector<float> points, std::vector<std::uint32_t> indices) {
    Mesh mesh;
    mesh.vertex_count = static_cast<std::uint32_t>(points.size() / 3);
    mesh.indices = std::move(indices);
    Attribute position{"POSITION", ComponentType::f32, 3, false, {}};
    position.data.resize(points.size() * sizeof(float));
    std::memcpy(position.data.data(), points.data(), position.data.size());
    mesh.attributes.push_back(std::move(position));
    return mesh;
}

}  // namespace

TEST_CASE_FIXTURE(GpuTest, "every generated mesh gives the same pictures") {
    for (const GeneratorInfo& kind : generators()) {
        CAPTURE(kind.name);
        const Mesh mesh = generated(kind.name, 4000, 2);
        const gpu::Model model = model_of(mesh);
        for (const std::uint64_t range : {std::uint64_t{0}, small_range(mesh)}) {
            CAPTURE(range);
            for (const gpu::Source source : kStreams) {
                const gpu::Comparison c = compared(*context, model, source, range);
                check_same(c);
                CHECK(!c.blank);
                CHECK(c.distinct_ids > 1000);
                CHECK(c.covered_pixels > 6 * 160 * 120 / 20);
            }
        }
    }
}

TEST_CASE_FIXTURE(GpuTest, "raw pictures of clean surfaces differ by the rounding of normals only") {
    for (const char* kind : {"sphere", "torus", "genus", "blob"}) {
        CAPTURE(kind);
        const Mesh mesh = generated(kind, 4000, 1);
        const gpu::Comparison c = compared(*context, model_of(mesh));
        CHECK(c.raw_max_channel_difference <= 1);
        CHECK(c.raw_pixels_different * 1000 <= c.covered_pixels);
    }
}

TEST_CASE_FIXTURE(GpuTest, "meshes of every local shape give the same pictures") {
    for (const NamedMesh& named : named_meshes()) {
        if (named.mesh.triangle_count() > 400) continue;
        CAPTURE(named.name);
        const Result<gpu::Model> model = gpu::make_model(named.mesh, {.packed = true});
        if (!model || model->lean.slot_triangle.empty()) continue;
        for (const gpu::Source source : kStreams) check_same(compared(*context, *model, source));
    }
}

TEST_CASE_FIXTURE(GpuTest, "triangles in the same place, in any order and rotation, give the same pictures") {
    Mesh mesh = generated("blob", 1000);
    const std::vector<std::uint32_t> once = mesh.indices;
    for (std::size_t i = once.size(); i >= 3; i -= 3) {  // again, backwards and rotated
        for (const std::size_t k : {std::size_t{2}, std::size_t{3}, std::size_t{1}})
            mesh.indices.push_back(once[i - k]);
    }
    for (std::size_t i = 0; i < once.size(); i += 3) {  // and turned round
        for (const std::size_t k : {std::size_t{2}, std::size_t{1}, std::size_t{0}})
            mesh.indices.push_back(once[i + k]);
    }
    const gpu::Model model = model_of(mesh);
    for (const gpu::Source source : kStreams) {
        const gpu::Comparison c = compared(*context, model, source);
        check_same(c);
        // The smallest number wins, so only the first copy of each is ever seen.
        CHECK(c.distinct_ids <= once.size() / 3);
        CHECK(!c.blank);
    }
}

TEST_CASE_FIXTURE(GpuTest, "a mesh far from the origin, tiny or large, gives the same pictures") {
    for (const float scale : {1e-20F, 1e-3F, 1e15F}) {
        CAPTURE(scale);
        Mesh mesh = generated("torus", 1000);
        std::vector<float> p = positions_f32(mesh);
        for (float& x : p) x = x * scale + 5 * scale;
        std::memcpy(mesh.attributes[0].data.data(), p.data(), p.size() * sizeof(float));
        const gpu::Comparison c = compared(*context, model_of(mesh));
        check_same(c);
        CHECK(!c.blank);
    }
}

TEST_CASE_FIXTURE(GpuTest, "a blank picture cannot pass") {
    // Triangles without area: nothing is drawn, and nothing differs.
    const Mesh mesh = from_points({0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0}, {0, 1, 2, 1, 3, 2});
    const gpu::Comparison c = compared(*context, model_of(mesh));
    CHECK(c.pixels_different == 0);
    CHECK(c.covered_pixels == 0);
    CHECK(c.blank);
    CHECK(!c.same());
}

TEST_CASE_FIXTURE(GpuTest, "nothing to draw is an error") {
    const auto no_model = [](const Mesh& mesh) {
        const auto model = gpu::make_model(mesh);
        return !model && model.error().code == ErrorCode::unsupported;
    };
    CHECK(no_model(from_points({0, 0, 0}, {})));
    CHECK(no_model(from_points({1, 1, 1}, {0, 0, 0})));
    const Mesh degenerate = from_points({0, 0, 0, 1, 0, 0, 1, 1, 0}, {0, 1, 1, 2, 1, 2});
    for (const gpu::Source source : kStreams) {
        const auto c = gpu::compare(*context, model_of(degenerate), {source}, {});
        REQUIRE(!c);
        CHECK(c.error().code == ErrorCode::unsupported);
    }
    const Mesh sphere = generated("sphere", 100);
    const auto without = gpu::make_model(sphere);
    REQUIRE(without);
    const auto none = gpu::compare(*context, *without, {gpu::Source::packed}, {});
    REQUIRE(!none);
    CHECK(none.error().code == ErrorCode::invalid_argument);
}
