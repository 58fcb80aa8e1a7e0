// Compares the copies that shaders/decode/seam_decode.comp and lacedring_seams.glsl decode with decode_seams, corner by
// corner, and the pictures of meshes with seams from all sources.

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include "lacedring/lacedring.hpp"
#include "lacedring/mesh_files.hpp"
#include "lacedring/seams.hpp"
#include "renderer/decode/seam_decoder.h"
#include "renderer/draw/adjacency.h"
#include "tests/gpu/gpu_test.h"
#include "tests/support/cut_mesh.h"
#include "tests/support/cuts.h"
#include "tests/support/meshes.h"
#include "tests/support/shapes.h"

using namespace lacedring;
using namespace lacedring::test;

namespace {

struct SeamDecode : GpuTest {
    SeamDecode() {
        auto made = gpu::SeamDecoder::create(*context);
        REQUIRE_MESSAGE(made, made.error().message);
        decoder = std::move(*made);
    }

    std::vector<std::uint32_t> read(const gpu::Buffer& buffer, std::size_t count) {
        std::vector<std::uint32_t> out(count);
        auto transfer = gpu::Transfer::create(*context);
        REQUIRE(transfer);
        REQUIRE(transfer->read(buffer, 0, std::as_writable_bytes(std::span(out))));
        return out;
    }

    struct Decoded {
        std::vector<std::uint32_t> homes, copies, copy_vertices;
    };
    /// `triangles`: as the decoder of the connectivity writes them.
    Decoded decoded(const SeamView& view, const std::vector<std::uint32_t>& triangles, std::uint64_t max_range) {
        constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
        constexpr VkBufferUsageFlags kAddress = kUsage | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
        const std::size_t padded = (triangles.size() + 11) / 12 * 12;
        gpu::GpuMesh mesh;
        mesh.max_range = max_range;
        const auto make = [&](gpu::Buffer& buffer, std::size_t words, VkBufferUsageFlags usage) {
            auto made = gpu::Buffer::create(*context, "seams", 4 * words, usage);
            REQUIRE(made);
            buffer = std::move(*made);
        };
        make(mesh.seams, view.words.size(), kAddress);
        make(mesh.homes, std::size_t{view.vertices} + 1, kAddress);
        make(mesh.copy_vertices, view.copies, kAddress);
        make(mesh.indices, padded, kUsage);
        make(mesh.copies, padded, kUsage);
        auto transfer = gpu::Transfer::create(*context);
        auto commands = gpu::Commands::create(*context);
        REQUIRE((transfer && commands));
        REQUIRE(transfer->upload(mesh.seams, view.words));
        REQUIRE(transfer->upload(mesh.indices, std::span<const std::uint32_t>(triangles)));
        gpu::Descriptors descriptors(*context);
        const auto plan = decoder.plan(descriptors, mesh, view);
        REQUIRE_MESSAGE(plan, plan.error().message);
        if (max_range == kSmallRange) {
            CHECK(plan->vertices.dispatches.size() == (view.vertices + 511) / 512);
            CHECK(plan->triangles.dispatches.size() == view.blocks());
        }
        const auto buffer = commands->begin();
        REQUIRE(buffer);
        decoder.record(*buffer, *plan);
        gpu::decode_barrier(*buffer);
        REQUIRE(commands->run());
        Decoded out{read(mesh.homes, std::size_t{view.vertices} + 1), read(mesh.copies, padded),
                    read(mesh.copy_vertices, view.copies)};
        for (; out.copies.size() > triangles.size(); out.copies.pop_back()) REQUIRE(out.copies.back() == 0);
        return out;
    }

    /// Compares homes, copies and vertices of copies with the CPU's. mesh.triangles is UINT32_MAX in slots without
    /// triangle.
    void check(const CutSurface& mesh, std::uint64_t max_range) {
        const Result<EncodedSeams> encoded = encode_seams(mesh.triangles, mesh.vertices, mesh.copies);
        REQUIRE_MESSAGE(encoded, encoded.error().message);
        const Result<SeamView> view = validate_seams(encoded->words, mesh.triangles, mesh.vertices);
        REQUIRE_MESSAGE(view, view.error().message);
        std::vector<std::uint32_t> copies(mesh.triangles.size()), first(std::size_t{view->vertices} + 1);
        decode_seams(*view, mesh.triangles, copies);
        first_copies(*view, first);
        std::vector<std::uint32_t> triangles = mesh.triangles;
        for (std::size_t k = 0; k < copies.size(); k += 3) {
            if (mesh.triangles[k] != UINT32_MAX) continue;
            std::fill_n(&copies[k], 3, 0);
            // A lean slot without a triangle repeats two vertices of the preceding triangle.
            const std::uint32_t a = k == 0 ? 0 : triangles[k - 2], b = k == 0 ? 0 : triangles[k - 1];
            triangles[k] = triangles[k + 1] = a;
            triangles[k + 2] = b;
        }
        const Decoded device = decoded(*view, triangles, max_range);
        CHECK_MESSAGE(device.copies == copies, "each corner has the CPU's copy");
        bool right = true;
        for (std::size_t v = 0; v < first.size(); ++v) right &= device.homes[v] >> 1 == first[v];
        CHECK_MESSAGE(right, "each vertex has the CPU's first copy");
        std::vector<std::uint32_t> vertices(view->copies);
        for (std::uint32_t v = 0; v < view->vertices; ++v) vertices[first[v]] = v;
        for (std::size_t k = 0; k < copies.size(); ++k) {
            if (mesh.triangles[k] != UINT32_MAX) vertices[copies[k]] = mesh.triangles[k];
        }
        CHECK_MESSAGE(device.copy_vertices == vertices, "each copy has the CPU's vertex");
    }

    /// Cuts the slots of both streams in the way `how` (cuts.h), and checks them.
    void check(const Mesh& mesh, std::uint32_t how, std::uint64_t max_range) {
        for (const Format format : {Format::lean, Format::packed}) {
            CAPTURE(name_of(format));
            const Result<Encoded> encoded = encode(mesh.indices, mesh.vertex_count, {.format = format, .effort = 0});
            REQUIRE_MESSAGE(encoded, encoded.error().message);
            const Result<StreamView> view = validate(encoded->words);
            REQUIRE(view);
            if (view->slots() == 0) continue;
            check(cut(slot_triangles(*view), view->vertices(), how, mesh.triangle_count()), max_range);
        }
    }

    gpu::SeamDecoder decoder;
};

constexpr std::uint64_t kLargeRange = 1 << 27;

}  // namespace

TEST_CASE_FIXTURE(SeamDecode, "seams of named meshes decode as on the CPU") {
    std::uint32_t n = 0;
    for (const NamedMesh& named : named_meshes()) {
        CAPTURE(named.name);
        for (std::uint32_t k = 0; k < 2; ++k, ++n) check(named.mesh, n % kCuts, n % 7 < 3 ? kSmallRange : kLargeRange);
    }
}

TEST_CASE_FIXTURE(SeamDecode, "seams of triangles in random order decode as on the CPU") {
    for (std::uint32_t n = 0; n < 30; ++n) {
        CAPTURE(n);
        const Mesh soup = random_soup(3 + 17 * n, 40 * n + 1, n + 1, false),
                   glued = random_gluing(40 + 9 * n, 30 * n + 1, n);
        for (const Mesh& mesh : {soup, glued}) {
            std::vector<std::uint32_t> triangles;
            for (std::size_t k = 0; k < mesh.indices.size(); k += 3) {
                const std::uint32_t a = mesh.indices[k], b = mesh.indices[k + 1], c = mesh.indices[k + 2];
                if (a != b && b != c && c != a) triangles.insert(triangles.end(), {a, b, c});
            }
            if (!triangles.empty())
                check(cut(triangles, mesh.vertex_count, n % kCuts, n), n % 2 == 0 ? kSmallRange : kLargeRange);
        }
    }
}

TEST_CASE_FIXTURE(SeamDecode, "seams of larger meshes, of several groups of blocks, decode as on the CPU") {
    std::uint32_t how = 0;
    for (const GeneratorInfo& kind : generators()) {
        CAPTURE(kind.name);
        check(generated(kind.name, 40000, 3), how++ % kCuts, kLargeRange);
    }
    const Shape wheel = fan(700, true);  // a vertex of 700 copies
    check(make_mesh(wheel.triangles, wheel.vertices), 3, kSmallRange);
    for (how = 0; how < kCuts; ++how) {
        CAPTURE(how);
        check(generated("blob", 20000), how, kSmallRange);
        check(generated("genus", 60000), how, 100000);
    }
}

TEST_CASE_FIXTURE(SeamDecode, "damaged seam sections neither hang nor write beyond their blocks") {
    SplitMix64 random(20261127);
    const Mesh mesh = generated("blob", 3000);
    const Result<Encoded> encoded = encode(mesh.indices, mesh.vertex_count, {.format = Format::packed, .effort = 0});
    REQUIRE(encoded);
    const std::vector<std::uint32_t> triangles = slot_triangles(validate(encoded->words).value());
    for (std::uint32_t trial = 0; trial < 100; ++trial) {
        CAPTURE(trial);
        const CutSurface surface = cut(triangles, mesh.vertex_count, 1 + trial % 4, trial);
        std::vector<std::uint32_t> words =
            encode_seams(surface.triangles, surface.vertices, surface.copies).value().words;
        for (std::uint32_t k = 0; k <= trial % 20; ++k) {
            words[2 + random.below(static_cast<std::uint32_t>(words.size() - 2))] ^= 1U << random.below(32);
        }
        SeamView view;
        view.words = words;
        view.vertices = surface.vertices;
        view.triangles = static_cast<std::uint32_t>(triangles.size() / 3);
        view.copies = 3 * view.triangles;
        decoded(view, triangles, kSmallRange);
    }
}

namespace {

gpu::Model model_of(const CutMesh& cut, const VertexOptions& options = {}) {
    gpu::ModelOptions all{.packed = true, .vertices = options};
    all.surface = cut.surface;
    Result<gpu::Model> made = gpu::make_model(cut.mesh, all);
    REQUIRE_MESSAGE(made, made.error().message);
    return std::move(made).value();
}

struct SeamPictures : GpuTest {
    gpu::Renderer renderer(gpu::View view, std::uint64_t max_range) {
        gpu::RendererOptions options;
        options.view = view;
        options.width = 80;
        options.height = 60;
        options.max_range = max_range;
        Result<gpu::Renderer> out = gpu::Renderer::create(*context, options);
        REQUIRE_MESSAGE(out, out.error().message);
        return std::move(out).value();
    }

    /// All sources with all paths. `small`: with those that are slow.
    std::vector<gpu::Subject> subjects(bool small) const {
        std::vector<gpu::Subject> out;
        for (const auto source : {gpu::Source::lean, gpu::Source::packed, gpu::Source::packed_vertices}) {
            for (const gpu::Named<gpu::Path>& named : gpu::kPaths) {
                if (named.value == gpu::Path::mesh && context->info().max_mesh_groups == 0) continue;
                if (gpu::is_slow(source, named.value, small ? 0 : UINT32_MAX)) continue;
                out.push_back({source, named.value});
            }
        }
        return out;
    }

    void check_same(gpu::Renderer& pictures, const gpu::Model& model, bool small) {
        const std::vector<gpu::Subject> drawn = subjects(small);
        const auto all = gpu::compare(pictures, model, drawn);
        REQUIRE_MESSAGE(all, all.error().message);
        for (std::size_t i = 0; i < all->size(); ++i) {
            CAPTURE(static_cast<int>(drawn[i].source));
            CAPTURE(static_cast<int>(drawn[i].path));
            const gpu::Comparison& c = (*all)[i];
            CHECK(c.pixels_different == 0);
            CHECK(c.triangle_ids_different == 0);
            CHECK(c.indices_equal_cpu);
            CHECK(c.vertices_equal_cpu.value_or(true));
            CHECK(!c.blank);
        }
    }

    static VertexOptions lattice() {
        VertexOptions options;
        options.mapping = VertexMapping::lattice;
        options.bits = 12;
        return options;
    }
};

}  // namespace

TEST_CASE_FIXTURE(SeamPictures, "meshes with seams have the same pictures from all sources by every path") {
    gpu::Renderer pictures = renderer(gpu::View::smooth, kSmallRange);
    std::uint64_t seed = 1;
    for (const char* kind : {"blob", "moebius", "parts", "soup"}) {
        CAPTURE(kind);
        // Half of the ways to cut, alternately.
        for (std::uint32_t how = static_cast<std::uint32_t>(seed % 2); how < kCuts; how += 2) {
            CAPTURE(how);
            const CutMesh cut = cut_mesh(generated(kind, 300, 2), how, ++seed);
            check_same(pictures, model_of(cut, how % 2 == 0 ? VertexOptions{} : lattice()), true);
        }
    }
    const CutMesh glued = cut_mesh(random_gluing(200, 500, 3), 2, 5);
    check_same(pictures, model_of(glued), true);
    gpu::Renderer large = renderer(gpu::View::smooth, 0);
    const CutMesh cut = cut_mesh(generated("genus", 40000), 1, 3);
    check_same(large, model_of(cut, lattice()), false);
}

TEST_CASE_FIXTURE(SeamPictures,
                  "a file with a seam in its texture has the same pictures from all sources by every path") {
    const Result<Mesh> mesh = read_mesh((std::filesystem::path(LACEDRING_ASSETS) / "globe.glb").string());
    REQUIRE_MESSAGE(mesh, mesh.error().message);
    CutMesh globe{*mesh, find_surface(*mesh)};
    CHECK(globe.surface.has_seams());
    move_to_surface(globe.mesh, globe.surface);  // replaces -0 by 0
    gpu::Renderer pictures = renderer(gpu::View::smooth, 0);
    check_same(pictures, model_of(globe), true);
}

TEST_CASE_FIXTURE(SeamPictures, "all views of meshes with seams are the same from all sources by every path") {
    const CutMesh cut = cut_mesh(generated("blob", 600), 1, 7);
    const gpu::Model model = model_of(cut);
    for (const gpu::View view :
         {gpu::View::triangle_class, gpu::View::ring, gpu::View::wire, gpu::View::seams, gpu::View::silhouette}) {
        CAPTURE(static_cast<int>(view));
        gpu::Renderer pictures = renderer(view, 0);
        const auto camera = gpu::make_camera(model, {}, 80, 60);
        REQUIRE(camera);
        const auto drawn = [&](const gpu::Model& of, const gpu::Subject& subject) {
            Result<gpu::Drawable> drawable = pictures.upload(of, subject.source, subject.path);
            REQUIRE_MESSAGE(drawable, drawable.error().message);
            Result<gpu::Picture> picture = pictures.draw(*drawable, of, *camera, true);
            REQUIRE_MESSAGE(picture, picture.error().message);
            return std::move(picture).value();
        };
        const gpu::Picture plain = drawn(model, {gpu::Source::plain, gpu::Path::compute});
        for (const gpu::Subject& subject : subjects(true)) {
            CHECK(gpu::difference(plain, drawn(model, subject)).pixels == 0);
        }
        INFO("the outline is that of the mesh without seams");
        if (view != gpu::View::silhouette) continue;
        const Mesh whole = generated("blob", 600);
        CHECK(gpu::difference(plain, drawn(test::model_of(whole), {})).pixels == 0);
    }
}

TEST_CASE_FIXTURE(SeamPictures, "the device computes the CPU's normals of the surface for a mesh with seams") {
    const CutMesh cut = cut_mesh(generated("blob", 3000), 1, 7);
    const gpu::Model model = model_of(cut);
    auto transfer = gpu::Transfer::create(*context);
    auto commands = gpu::Commands::create(*context);
    const auto normals = gpu::VertexNormals::create(*context);
    REQUIRE((transfer && commands && normals));
    const auto adjacency = gpu::upload_adjacency(*context, *transfer, model);
    REQUIRE_MESSAGE(adjacency, adjacency.error().message);
    const auto made = normals->compute(*commands, *adjacency);
    REQUIRE_MESSAGE(made, made.error().message);
    std::vector<float> got(std::size_t{3} * adjacency->vertices);
    REQUIRE(transfer->read(*made, 0, std::as_writable_bytes(std::span(got))));
    const std::vector<float> positions = gpu::surface_positions(model);
    const CornerTable table = build_corner_table(gpu::surface_triangles(model), model.surface.vertex_count).value();
    CHECK(table.topology.border_edges == 0);
    const std::vector<float> expected = vertex_normals(table, Positions(std::span<const float>(positions)));
    float worst = 0;
    for (std::size_t v = 0; v < adjacency->vertices; ++v) {
        const std::size_t u = model.surface_of(adjacency->vertex_order[v]);
        for (std::size_t i = 0; i < 3; ++i) worst = std::max(worst, std::abs(got[3 * v + i] - expected[3 * u + i]));
    }
    CHECK(worst < 1e-5F);
}

TEST_CASE_FIXTURE(SeamPictures, "the comparison finds a wrong seam section") {
    const CutMesh cut = cut_mesh(generated("blob", 3000), 1, 7);
    const gpu::Model good = model_of(cut);
    gpu::Renderer pictures = renderer(gpu::View::smooth, 0);
    const auto same = [&](const gpu::Model& model) {
        const std::array<gpu::Subject, 1> subject{{{gpu::Source::packed, gpu::Path::compute}}};
        const auto all = gpu::compare(pictures, model, subject);
        REQUIRE_MESSAGE(all, all.error().message);
        return all->front().same();
    };
    CHECK(same(good));
    gpu::Model bad = model_of(cut);
    std::swap(bad.packed_seams.copy_order[100], bad.packed_seams.copy_order[900]);
    CHECK(!same(bad));
    bad = model_of(cut);
    bad.packed_seams.words.push_back(0);
    CHECK(!gpu::compare(pictures, bad, std::array<gpu::Subject, 1>{{{gpu::Source::packed, gpu::Path::compute}}}));
}
