// Compares the index buffers that the device decodes with decode_lean and decode_packed, and checks its draw commands
// and the rotation of triangles.

#include <algorithm>
#include <array>
#include <cstring>
#include <map>

#include "lacedring/lacedring.hpp"
#include "lacedring/streams.hpp"
#include "tests/gpu/gpu_test.h"
#include "tests/support/meshes.h"

using namespace lacedring;
using namespace lacedring::test;

namespace {

std::vector<std::uint32_t> decoded_by_cpu(const gpu::Model& model, gpu::Source source) {
    std::vector<std::uint32_t> out;
    if (source == gpu::Source::lean) {
        const Result<LeanView> view = validate_lean(model.lean.words);
        REQUIRE_MESSAGE(view, view.error().message);
        out.resize(std::size_t{3} * view->slots());
        decode_lean(*view, out);
    } else {
        const Result<PackedView> view = validate_packed(model.packed.words);
        REQUIRE_MESSAGE(view, view.error().message);
        out.resize(std::size_t{3} * view->triangles);
        decode_packed(*view, out);
    }
    return out;
}

/// Keeps a renderer for each descriptor range, because lavapipe takes long to create pipelines.
struct DecodeTest : GpuTest {
    /// Checks both streams of a mesh. Adds the packed stream's parted and plain blocks to `blocks`.
    void check(const Mesh& mesh, std::uint64_t max_range, std::array<std::uint32_t, 2>* blocks = nullptr) {
        Result<gpu::Model> model = gpu::make_model(mesh, {.packed = true});
        if (!model || model->packed.triangle_order.empty()) return;  // nothing to draw: see test_compare.cpp
        check(*model, gpu::Source::lean, max_range);
        check(*model, gpu::Source::packed, max_range);
        small_read = read;
        if (blocks != nullptr) {
            (*blocks)[0] += model->packed.statistics.parted_blocks;
            (*blocks)[1] += model->packed.statistics.plain_blocks;
        }
        const Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
        REQUIRE(table);
        model->packed = encode_smallest_packed(*table, {}, {.passes = 2}, PackedProfile::cache).value().stream;
        check(*model, gpu::Source::packed, max_range);
    }

  private:
    gpu::Renderer& renderer(std::uint64_t max_range) {
        if (const auto found = renderers.find(max_range); found != renderers.end()) return found->second;
        gpu::RendererOptions options;
        options.width = options.height = 8;
        options.max_range = max_range;
        Result<gpu::Renderer> made = gpu::Renderer::create(*context, options);
        REQUIRE_MESSAGE(made, made.error().message);
        return renderers.emplace(max_range, std::move(made).value()).first->second;
    }

    void check(const gpu::Model& model, gpu::Source source, std::uint64_t max_range) {
        CAPTURE(static_cast<int>(source));
        gpu::Renderer& r = renderer(max_range);
        Result<gpu::Drawable> drawable = r.upload(model, source);
        REQUIRE_MESSAGE(drawable, drawable.error().message);
        const auto indices = r.read_indices(*drawable);
        REQUIRE_MESSAGE(indices, indices.error().message);
        const std::vector<std::uint32_t> expected = decoded_by_cpu(model, source);
        REQUIRE(indices->size() == expected.size());
        CHECK_MESSAGE(*indices == expected, "the compute path decodes the CPU's indices");
        check_draws(r, *drawable, expected.size());
        if (max_range != 0 && expected.size() * 4 > 2 * max_range) CHECK(drawable->decode.dispatches.size() > 1);

        Result<gpu::Drawable> pulled = r.upload(model, source, gpu::Path::pull);
        REQUIRE_MESSAGE(pulled, pulled.error().message);
        const auto slots = r.read_indices(*pulled);
        REQUIRE_MESSAGE(slots, slots.error().message);
        CHECK_MESSAGE(*slots == expected, "the pull path decodes the CPU's indices slot by slot");

        const auto words = r.words_read(*pulled);
        REQUIRE_MESSAGE(words, words.error().message);
        read = {4 * words->most, 12 * words->all / expected.size()};
    }

    static void check_draws(gpu::Renderer& r, const gpu::Drawable& drawable, std::size_t indices) {
        INFO("the draw commands cover all indices, once");
        std::vector<VkDrawIndexedIndirectCommand> commands(drawable.mesh.draws);
        REQUIRE(r.transfer().read(drawable.mesh.commands, 0, std::as_writable_bytes(std::span(commands))));
        std::uint64_t covered = 0;
        for (const VkDrawIndexedIndirectCommand& command : commands) {
            CHECK(command.firstIndex == covered);
            CHECK(command.instanceCount == 1);
            CHECK(command.vertexOffset == 0);
            CHECK(command.firstInstance == 0);
            covered += command.indexCount;
        }
        CHECK(covered == indices);
    }

    std::map<std::uint64_t, gpu::Renderer> renderers;

  protected:
    struct Read {
        std::uint64_t most = 0, mean = 0;  ///< bytes per triangle
    };
    Read read;        ///< of the last mesh
    Read small_read;  ///< of its packed stream of the small profile
};

}  // namespace

TEST_CASE_FIXTURE(DecodeTest, "named meshes decode as on the CPU") {
    for (const NamedMesh& named : named_meshes()) {
        CAPTURE(named.name);
        check(named.mesh, 0);
    }
}

TEST_CASE_FIXTURE(DecodeTest, "named meshes decode as on the CPU with many small descriptors") {
    for (const NamedMesh& named : named_meshes()) {
        CAPTURE(named.name);
        check(named.mesh, kSmallRange);
    }
}

TEST_CASE_FIXTURE(DecodeTest, "random soups decode as on the CPU") {
    std::array<std::uint32_t, 2> blocks{};
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        CAPTURE(seed);
        const auto size = static_cast<std::uint32_t>(seed * 7);
        check(random_soup(size + 2, 3 * size, seed), seed % 2 == 0 ? 0 : kSmallRange, &blocks);
        check(random_gluing(size + 2, 3 * size, seed), seed % 2 == 0 ? kSmallRange : 0, &blocks);
        check(random_gluing(10 + size, 150 + 20 * size, seed), seed % 3 == 0 ? kSmallRange : 0, &blocks);
    }
    CHECK(blocks[0] > 10);
    CHECK(blocks[1] > 10);
}

TEST_CASE_FIXTURE(DecodeTest, "larger generated meshes decode as on the CPU") {
    for (const GeneratorInfo& kind : generators()) {
        CAPTURE(kind.name);
        const Mesh mesh = generated(kind.name, 60000, 3);
        check(mesh, 0);
        check(mesh, 100000);
        // Meshes without long corridors read more.
        if (kind.name == std::string_view("parts") || kind.name == std::string_view("soup")) continue;
        CHECK(small_read.most <= 192);
        CHECK(small_read.mean <= 80);
    }
}

TEST_CASE_FIXTURE(GpuTest, "an exact picture rotates every triangle to begin with its smallest original vertex") {
    const Mesh mesh = generated("blob", 5000);
    const gpu::Model model = model_of(mesh);
    gpu::RendererOptions options;
    options.width = options.height = 32;
    options.max_range = kSmallRange;
    Result<gpu::Renderer> renderer = gpu::Renderer::create(*context, options);
    REQUIRE(renderer);
    const auto camera = gpu::make_camera(model, {}, 32, 32);
    REQUIRE(camera);
    const auto rotated = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        std::array<std::uint32_t, 3> t{a, b, c};
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        return t;
    };
    for (const gpu::Source source : {gpu::Source::plain, gpu::Source::lean, gpu::Source::packed}) {
        Result<gpu::Drawable> drawable = renderer->upload(model, source);
        REQUIRE(drawable);
        REQUIRE(renderer->draw(*drawable, model, *camera, true));
        auto indices = renderer->read_indices(*drawable);
        REQUIRE(indices);
        std::size_t triangles = 0;
        for (std::size_t slot = 0; slot < indices->size() / 3; ++slot) {
            std::array<std::uint32_t, 3> t{(*indices)[3 * slot], (*indices)[3 * slot + 1], (*indices)[3 * slot + 2]};
            if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
            std::uint32_t original = static_cast<std::uint32_t>(slot);
            if (source != gpu::Source::plain) {
                const bool lean = source == gpu::Source::lean;
                for (std::uint32_t& v : t) v = (lean ? model.lean.vertex_order : model.packed.vertex_order)[v];
                original = (lean ? model.lean.slot_triangle : model.packed.triangle_order)[slot];
            }
            const std::size_t at = std::size_t{3} * original;
            REQUIRE(t == rotated(mesh.indices[at], mesh.indices[at + 1], mesh.indices[at + 2]));
            ++triangles;
        }
        CHECK(triangles == mesh.triangle_count());
        // A raw picture would now show rotated triangles.
        CHECK(!renderer->draw(*drawable, model, *camera, false));
    }
}

TEST_CASE_FIXTURE(GpuTest, "ranges too small to work with are refused") {
    const Mesh mesh = generated("sphere", 20000);
    const gpu::Model model = model_of(mesh);
    for (const std::uint64_t range : {std::uint64_t{1}, kSmallRange - 1}) {
        gpu::RendererOptions options;
        options.width = options.height = 8;
        options.max_range = range;
        Result<gpu::Renderer> renderer = gpu::Renderer::create(*context, options);
        REQUIRE(renderer);
        for (const gpu::Source source : {gpu::Source::lean, gpu::Source::packed}) {
            const auto drawable = renderer->upload(model, source);
            REQUIRE(!drawable);
            CHECK(drawable.error().code == ErrorCode::invalid_argument);
        }
    }
}
