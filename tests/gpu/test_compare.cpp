// Compares the pictures of streams with those of the plain index list, bit for bit.

#include <cstdlib>
#include <cstring>

#include "tests/gpu/gpu_test.h"
#include "tests/support/meshes.h"

using namespace lacedring;
using namespace lacedring::test;

namespace {

// For triangles at the same place, each of which covers every pixel.
constexpr std::uint32_t kTinyWidth = 64, kTinyHeight = 48;

/// Every source with every path that the device supports.
std::vector<gpu::Subject> all_subjects(const gpu::Context& context) {
    std::vector<gpu::Subject> out;
    for (const gpu::Named<gpu::Path>& named : gpu::kPaths) {
        if (named.value == gpu::Path::mesh && context.info().max_mesh_groups == 0) continue;
        for (const gpu::Source source : {gpu::Source::lean, gpu::Source::packed}) out.push_back({source, named.value});
    }
    return out;
}

/// A renderer for many models, because lavapipe takes long to create pipelines.
gpu::Renderer small_renderer(gpu::Context& context, std::uint64_t max_range = 0, std::uint32_t width = kWidth,
                             std::uint32_t height = kHeight) {
    gpu::RendererOptions options;
    options.width = width;
    options.height = height;
    options.max_range = max_range;
    Result<gpu::Renderer> out = gpu::Renderer::create(context, options);
    REQUIRE_MESSAGE(out, out.error().message);
    return std::move(out).value();
}

std::vector<gpu::Comparison> compared(gpu::Renderer& renderer, const gpu::Model& model) {
    auto out = gpu::compare(renderer, model, all_subjects(renderer.context()));
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

void check_same(const std::vector<gpu::Comparison>& all) {
    for (std::size_t i = 0; i < all.size(); ++i) {
        CAPTURE(i);  // in all_subjects
        check_same(all[i]);
    }
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

TEST_CASE_FIXTURE(GpuTest, "generated meshes have the same pictures by every path") {
    gpu::Renderer renderer = small_renderer(*context);
    for (const GeneratorInfo& kind : generators()) {
        CAPTURE(kind.name);
        const Mesh mesh = generated(kind.name, 4000, 2);
        const gpu::Model model = model_of(mesh);
        const std::vector<gpu::Comparison> all = compared(renderer, model);
        check_same(all);
        CHECK(!all[0].blank);
        CHECK(all[0].distinct_ids > 1000);
        CHECK(all[0].covered_pixels > 6 * kWidth * kHeight / 20);
        // Raw pictures of manifold meshes differ only by the rounding of normals.
        const std::string_view name = kind.name;
        if (name != "sphere" && name != "torus" && name != "genus" && name != "blob") continue;
        for (const gpu::Comparison& c : all) {
            CHECK(c.raw_max_channel_difference <= 1);
            CHECK(c.raw_pixels_different * 1000 <= c.covered_pixels);
        }
    }
}

TEST_CASE_FIXTURE(GpuTest, "meshes decoded in many parts have the same pictures by every path") {
    gpu::Renderer renderer = small_renderer(*context, kSmallRange);
    for (const char* kind : {"parts", "terrain"}) {
        CAPTURE(kind);
        const Mesh mesh = generated(kind, 4000, 2);
        check_same(compared(renderer, model_of(mesh)));
    }
}

TEST_CASE("mesh shaders are available where the environment requires them") {
    if (std::getenv("LACEDRING_REQUIRE_MESH") == nullptr) return;
    const auto context = gpu::Context::create({{}, true});
    REQUIRE(context);
    CHECK((*context)->info().max_mesh_groups > 0);
}

TEST_CASE_FIXTURE(GpuTest, "meshes of every local shape have the same pictures") {
    gpu::Renderer renderer = small_renderer(*context);
    for (const NamedMesh& named : named_meshes()) {
        if (named.mesh.triangle_count() > 400) continue;
        CAPTURE(named.name);
        const Result<gpu::Model> model = gpu::make_model(named.mesh, {.packed = true});
        if (!model || model->lean.slot_triangle.empty()) continue;
        check_same(compared(renderer, *model));
    }
}

TEST_CASE_FIXTURE(GpuTest, "coinciding triangles in any order and rotation have the same pictures") {
    Mesh mesh = generated("blob", 400);
    const std::vector<std::uint32_t> once = mesh.indices;
    for (std::size_t i = once.size(); i >= 3; i -= 3) {  // again, in reverse order and rotated
        for (const std::size_t k : {std::size_t{2}, std::size_t{3}, std::size_t{1}})
            mesh.indices.push_back(once[i - k]);
    }
    for (std::size_t i = 0; i < once.size(); i += 3) {  // then all triangles flipped
        for (const std::size_t k : {std::size_t{2}, std::size_t{1}, std::size_t{0}})
            mesh.indices.push_back(once[i + k]);
    }
    gpu::Renderer renderer = small_renderer(*context);
    const std::vector<gpu::Comparison> all = compared(renderer, model_of(mesh));
    check_same(all);
    // The triangle of the smallest number is visible: only the first copy of each.
    CHECK(all[0].distinct_ids <= once.size() / 3);
    CHECK(!all[0].blank);
}

TEST_CASE_FIXTURE(GpuTest, "a mesh far from the origin, tiny or large, has the same pictures") {
    gpu::Renderer renderer = small_renderer(*context);
    for (const float scale : {1e-20F, 1e-3F, 1e15F}) {
        CAPTURE(scale);
        Mesh mesh = generated("torus", 1000);
        std::vector<float> p = positions_f32(mesh);
        for (float& x : p) x = x * scale + 5 * scale;
        std::memcpy(mesh.attributes[0].data.data(), p.data(), p.size() * sizeof(float));
        const std::vector<gpu::Comparison> all = compared(renderer, model_of(mesh));
        check_same(all);
        CHECK(!all[0].blank);
    }
}

TEST_CASE_FIXTURE(GpuTest, "a blank picture is reported, and does not count as different") {
    INFO("triangles without area, coinciding triangles, then another visible triangle");
    const Mesh mesh = from_points({0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0}, {0, 1, 2, 1, 3, 2});
    gpu::Renderer renderer = small_renderer(*context, 0, kTinyWidth, kTinyHeight);
    for (const gpu::Comparison& c : compared(renderer, model_of(mesh))) {
        CHECK(c.pixels_different == 0);
        CHECK(c.covered_pixels == 0);
        CHECK(c.blank);
        CHECK(c.same());
    }
    // Of coinciding triangles one is visible.
    std::vector<std::uint32_t> indices;
    for (int i = 0; i < 2000; ++i) indices.insert(indices.end(), {0, 1, 2});
    const Mesh coinciding = from_points({0, 0, 0, 1, 0, 0, 0, 1, 0}, indices);
    gpu::Model model = model_of(coinciding);
    for (const gpu::Comparison& c : compared(renderer, model)) {
        CHECK_MESSAGE(c.covered_pixels > 2000, "as many pixels as triangles");
        CHECK(c.distinct_ids == 1);
        CHECK(c.blank);
        CHECK(c.same());
    }
    // The comparison finds that another triangle is visible.
    for (std::uint32_t& t : model.lean.slot_triangle) t = t == 0 ? 2001U : t;
    const auto wrong =
        gpu::compare(renderer, model, std::vector<gpu::Subject>{{gpu::Source::lean, gpu::Path::compute}});
    REQUIRE(wrong);
    CHECK(wrong->front().blank);
    CHECK(!wrong->front().same());
}

TEST_CASE_FIXTURE(GpuTest, "nothing to draw is an error") {
    const auto no_model = [](const Mesh& mesh) {
        const auto model = gpu::make_model(mesh);
        return !model && model.error().code == ErrorCode::unsupported;
    };
    CHECK(no_model(from_points({0, 0, 0}, {})));
    CHECK(no_model(from_points({1, 1, 1}, {0, 0, 0})));
    const Mesh degenerate = from_points({0, 0, 0, 1, 0, 0, 1, 1, 0}, {0, 1, 1, 2, 1, 2});
    for (const gpu::Subject& subject : all_subjects(*context)) {
        const auto c = gpu::compare(*context, model_of(degenerate), subject, {});
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
