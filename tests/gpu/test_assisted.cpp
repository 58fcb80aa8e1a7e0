// GPU-assisted validation checks the addresses that shaders read and write. It is slow; meshes are small.

#include "lrcore/codec/lean/lean_format.h"
#include "renderer/draw/adjacency.h"
#include "tests/gpu/gpu_test.h"
#include "tests/support/cut_mesh.h"

using namespace lacedring;
using namespace lacedring::test;

namespace {

constexpr std::uint32_t kPicture = 48;

std::unique_ptr<gpu::Context> assisted() {
    auto made = gpu::Context::create({.device = {}, .validation = true, .gpu_assisted = true});
    REQUIRE_MESSAGE(made, made.error().message);
    return std::move(made).value();
}

struct Range {
    VkDeviceAddress begin, end;
};

std::vector<Range> ranges_of(const gpu::Drawable& drawable) {
    std::vector<Range> out;
    for (const gpu::Buffer* buffer : {&drawable.mesh.stream, &drawable.mesh.vertices, &drawable.mesh.vertex_order,
                                      &drawable.mesh.vertex_stream, &drawable.mesh.seams, &drawable.mesh.homes,
                                      &drawable.mesh.copies, &drawable.mesh.copy_vertices, &drawable.mesh.positions}) {
        if (*buffer) out.push_back({buffer->address(), buffer->address() + buffer->size()});
    }
    if (drawable.adjacency) {
        for (const gpu::Buffer* buffer : {&drawable.adjacency->tables, &drawable.adjacency->positions}) {
            out.push_back({buffer->address(), buffer->address() + buffer->size()});
        }
    }
    return out;
}

/// The number of messages so far, without those that report an address within `ranges` as out of bounds. Layer 1.3.239
/// looks addresses up in a loop that some invocations leave early, and lavapipe 22.3 computes wrong values after such
/// loops.
std::size_t messages(gpu::Context& context, const std::vector<Range>& ranges) {
    std::size_t count = 0;
    for (const std::string& message : context.validation().messages()) {
        const std::string_view kOut = "Device address 0x";
        const std::size_t at = message.find(kOut);
        if (at != std::string::npos) {
            const VkDeviceAddress address = std::stoull(message.substr(at + kOut.size()), nullptr, 16);
            if (std::any_of(ranges.begin(), ranges.end(),
                            [&](const Range& r) { return address >= r.begin && address + 4 <= r.end; })) {
                continue;
            }
        }
        if (++count == 1) MESSAGE(message);
    }
    context.validation().clear();
    return count;
}

gpu::Drawable draw(gpu::Renderer& renderer, const gpu::Model& model, const gpu::Subject& subject) {
    auto drawable = renderer.upload(model, subject.source, subject.path);
    REQUIRE_MESSAGE(drawable, drawable.error().message);
    const auto camera = gpu::make_camera(model, {}, kPicture, kPicture);
    REQUIRE(camera);
    const auto picture = renderer.draw(*drawable, model, *camera, false);
    REQUIRE_MESSAGE(picture, picture.error().message);
    return std::move(*drawable);
}

}  // namespace

TEST_CASE("GPU-assisted validation is clean for every source and path, and reports a vertex beyond the last") {
    // One renderer for all meshes: lavapipe takes minutes to create pipelines that are not cached.
    const auto context = assisted();
    gpu::RendererOptions options;
    options.width = options.height = kPicture;
    options.max_range = kSmallRange;
    auto renderer = gpu::Renderer::create(*context, options);
    REQUIRE(renderer);
    for (const char* kind : {"parts", "soup"}) {
        const Mesh mesh = generated(kind, 1000);
        const gpu::Model model = gpu::make_model(mesh, {.packed = true, .vertices = VertexOptions{}}).value();
        for (const auto& [name, path, path_label] : gpu::kPaths) {
            if (path == gpu::Path::mesh && context->info().max_mesh_groups == 0) continue;
            for (const auto& [source_name, source, source_label] : gpu::kSources) {
                if (source == gpu::Source::plain) continue;
                // The other paths decode vertices like pull, and take long to instrument.
                if (source == gpu::Source::packed_vertices && path != gpu::Path::compute && path != gpu::Path::pull)
                    continue;
                CAPTURE(std::string(name));
                CAPTURE(std::string(source_name));
                const gpu::Drawable drawable = draw(*renderer, model, {source, path});
                CHECK(messages(*context, ranges_of(drawable)) == 0);
            }
        }
    }

    const CutMesh cut = cut_mesh(generated("parts", 1000), 1, 3);  // with seams
    gpu::ModelOptions all{.packed = true, .vertices = VertexOptions{}};
    all.surface = cut.surface;
    const gpu::Model with_seams = gpu::make_model(cut.mesh, all).value();
    for (const gpu::Path path : {gpu::Path::compute, gpu::Path::pull}) {
        for (const gpu::Source source : {gpu::Source::lean, gpu::Source::packed_vertices}) {
            const gpu::Drawable drawable = draw(*renderer, with_seams, {source, path});
            CHECK(messages(*context, ranges_of(drawable)) == 0);
        }
    }

    const Mesh sphere = generated("sphere", 200);
    gpu::Model bad = model_of(sphere);
    bad.lean.words[LR_LEAN_HEADER_WORDS + 20] = sphere.vertex_count;  // an invalid tip
    const gpu::Drawable drawable = draw(*renderer, bad, {gpu::Source::lean, gpu::Path::pull});
    CHECK(messages(*context, ranges_of(drawable)) > 0);
}

TEST_CASE("GPU-assisted validation is clean for shaders that read neighbors") {
    const auto context = assisted();
    const Mesh mesh = generated("parts", 1000);
    const gpu::Model model = model_of(mesh);
    gpu::RendererOptions options;
    options.view = gpu::View::silhouette;
    options.width = options.height = kPicture;
    auto renderer = gpu::Renderer::create(*context, options);
    REQUIRE(renderer);
    const gpu::Drawable drawable = draw(*renderer, model, {gpu::Source::lean, gpu::Path::compute});
    CHECK(messages(*context, ranges_of(drawable)) == 0);
}
