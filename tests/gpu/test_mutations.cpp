// Tests of the comparison: it finds a single wrong word or bit of a stream.

#include <cstring>

#include "lacedring/streams.hpp"
#include "lrcore/base/random.h"
#include "lrcore/codec/lean/lean_format.h"
#include "lrcore/codec/packed/packed_format.h"
#include "tests/gpu/gpu_test.h"
#include "tests/support/meshes.h"

using namespace lacedring;
using namespace lacedring::test;

namespace {

/// A renderer for all mutations of a mesh, because lavapipe takes long to create pipelines.
gpu::Renderer mutation_renderer(gpu::Context& context) {
    gpu::RendererOptions options;
    options.width = 320;
    options.height = 240;
    Result<gpu::Renderer> renderer = gpu::Renderer::create(context, options);
    REQUIRE_MESSAGE(renderer, renderer.error().message);
    return std::move(renderer).value();
}

gpu::Comparison comparison_of(gpu::Renderer& renderer, const gpu::Model& model,
                              gpu::Source source = gpu::Source::lean) {
    const gpu::Subject subject{source};
    Result<std::vector<gpu::Comparison>> out = gpu::compare(renderer, model, std::span(&subject, 1));
    REQUIRE_MESSAGE(out, out.error().message);
    return std::move(out->front());
}

/// `count` slots for which fits(view, slot) holds, spread over the stream.
template <class Fits>
std::vector<std::uint32_t> slots_where(const gpu::Model& model, std::size_t count, const Fits& fits) {
    const Result<LeanView> view = view_lean(model.lean.words);
    REQUIRE(view);
    std::vector<std::uint32_t> all;
    for (std::uint32_t slot = 0; slot < view->slots(); ++slot) {
        if (model.lean.slot_triangle[slot] != UINT32_MAX && fits(*view, slot)) all.push_back(slot);
    }
    REQUIRE(all.size() >= count);
    std::vector<std::uint32_t> out;
    for (std::size_t i = 0; i < count; ++i) out.push_back(all[i * all.size() / count]);
    return out;
}

void check_found(gpu::Renderer& renderer, const gpu::Model& model, gpu::Source source = gpu::Source::lean) {
    const gpu::Comparison c = comparison_of(renderer, model, source);
    CHECK_MESSAGE(!c.same(), "the comparison finds the change");
    CHECK_MESSAGE(c.indices_equal_cpu, "device and CPU decode the same wrong stream");
    CHECK_MESSAGE(c.pixels_different > 0, "colors differ");
    CHECK_MESSAGE(c.triangle_ids_different > 0, "triangle numbers differ");
}

}  // namespace

TEST_CASE_FIXTURE(GpuTest, "the comparison finds one wrong word of a lean stream") {
    gpu::Renderer renderer = mutation_renderer(*context);

    const Mesh mesh = generated("blob", 3000, 5);
    const gpu::Model good = model_of(mesh);
    REQUIRE(comparison_of(renderer, good).same());

    {
        INFO("a tip");
        for (const std::uint32_t slot : slots_where(good, 4, [](const LeanView&view, std::uint32_t i) {
                 return i < view.ring_slots() && (view.payload[i] & ~LR_LEAN_TIP_MASK) == 0;
             })) {
            CAPTURE(slot);
            gpu::Model bad = model_of(mesh);
            std::uint32_t& word = bad.lean.words[LR_LEAN_HEADER_WORDS + slot];
            word = (word + mesh.vertex_count / 2) % mesh.vertex_count;
            check_found(renderer, bad);
        }
    }
    {
        INFO("a tip changed by one");
        gpu::Model bad = model_of(mesh);
        const auto slots = slots_where(good, 1, [](const LeanView& view, std::uint32_t i) {
            return i > 500 && i < view.ring_slots() && (view.payload[i] & ~LR_LEAN_TIP_MASK) == 0 &&
                   view.payload[i] > 10;
        });
        --bad.lean.words[LR_LEAN_HEADER_WORDS + slots[0]];
        check_found(renderer, bad);
    }
    {
        INFO("a wart bit");
        for (const std::uint32_t slot : slots_where(good, 4, [](const LeanView&view, std::uint32_t i) {
                 return i < view.ring_slots() && (view.payload[i] & LR_LEAN_WART_FLAG) != 0;
             })) {
            CAPTURE(slot);
            gpu::Model bad = model_of(mesh);
            bad.lean.words[LR_LEAN_HEADER_WORDS + slot] ^= LR_LEAN_WART_FLAG;
            check_found(renderer, bad);
        }
    }
    {
        INFO("a vertex of a T0");
        const Result<LeanView> view = view_lean(good.lean.words);
        REQUIRE(view);
        REQUIRE(view->verbatim >= 3);
        for (std::uint32_t k = 0; k < 3; ++k) {
            gpu::Model bad = model_of(mesh);
            std::uint32_t& word = bad.lean.words[LR_LEAN_HEADER_WORDS + view->ring_slots() + 3 * k + k];
            word = (word + mesh.vertex_count / 2) % mesh.vertex_count;
            check_found(renderer, bad);
        }
    }
    {
        INFO("a flip bit");
        gpu::Model bad = model_of(mesh);
        const auto slots = slots_where(good, 1, [](const LeanView& view, std::uint32_t i) {
            return i > 700 && i < view.ring_slots() && (view.payload[i] & ~LR_LEAN_TIP_MASK) == 0;
        });
        bad.lean.words[LR_LEAN_HEADER_WORDS + slots[0]] ^= LR_LEAN_FLIP_FLAG;
        const gpu::Comparison c = comparison_of(renderer, bad);
        // The other side of the triangle has the same color.
        CHECK(c.triangle_ids_different > 0);
        CHECK(!c.same());
    }
    {
        INFO("the order of the vertices");
        gpu::Model bad = model_of(mesh);
        std::swap(bad.lean.vertex_order[100], bad.lean.vertex_order[900]);
        CHECK(!comparison_of(renderer, bad).same());
    }
    {
        INFO("the triangles of two slots");
        gpu::Model bad = model_of(mesh);
        const auto slots = slots_where(good, 2, [](const LeanView&, std::uint32_t) { return true; });
        std::swap(bad.lean.slot_triangle[slots[0]], bad.lean.slot_triangle[slots[1]]);
        CHECK(!comparison_of(renderer, bad).same());
    }
}

namespace {

std::vector<std::uint32_t> decoded(const gpu::Model& model) {
    const Result<PackedView> view = view_packed(model.packed.words);
    REQUIRE(view);
    std::vector<std::uint32_t> out(std::size_t{3} * view->triangles);
    decode_packed(*view, out);
    return out;
}

/// Flips single bits of words [begin, end) of the packed stream: `flips` bits, spread over the words, each of which
/// leaves a valid stream of another mesh. The comparison must find each. `one_index`: only bits that change one index.
void check_flips_found(gpu::Renderer& renderer, const Mesh& mesh, std::size_t begin, std::size_t end, std::size_t flips,
                       bool one_index = false) {
    gpu::Model model = model_of(mesh);
    const std::vector<std::uint32_t> good = decoded(model);
    std::vector<std::uint32_t>& words = model.packed.words;
    const auto fits = [&] {
        words[LR_PACKED_WORD_CHECKSUM] = packed_checksum(words);
        if (!validate_packed(words)) return false;
        const std::vector<std::uint32_t> bad = decoded(model);
        std::size_t different = 0;
        for (std::size_t i = 0; i < good.size(); ++i) different += good[i] != bad[i] ? 1 : 0;
        return one_index ? different == 1 : different > 0;
    };
    const gpu::Subject subject{gpu::Source::packed};
    std::size_t found = 0, bit = 0;
    for (std::size_t part = 0; part < flips; ++part) {
        for (bit = std::max(bit, 32 * (begin + (end - begin) * part / flips)); bit < 32 * end; ++bit) {
            CAPTURE(bit);
            words[bit / 32] ^= 1U << (bit % 32);
            const bool chosen = fits();
            if (chosen) {
                const auto all = gpu::compare(renderer, model, std::span(&subject, 1));
                REQUIRE_MESSAGE(all, all.error().message);
                const gpu::Comparison& c = all->front();
                CHECK(!c.same());
                CHECK(c.indices_equal_cpu);
                // The other side of a triangle has the same color.
                CHECK(c.triangle_ids_different > 0);
            }
            words[bit / 32] ^= 1U << (bit % 32);
            if (chosen) break;
        }
        if (bit++ < 32 * end) ++found;
    }
    CHECK(found == flips);
}

}  // namespace

TEST_CASE_FIXTURE(GpuTest, "the comparison finds one wrong bit of a packed stream") {
    gpu::Renderer renderer = mutation_renderer(*context);

    const Mesh mesh = generated("blob", 6000, 5);
    const gpu::Model good = model_of(mesh);
    REQUIRE(comparison_of(renderer, good, gpu::Source::packed).same());
    const Result<PackedView> view = view_packed(good.packed.words);
    REQUIRE(view);
    const std::size_t turns = LR_PACKED_HEADER_WORDS, groups = view->groups_word();

    {
        INFO("a turn");
        check_flips_found(renderer, mesh, turns, view->table_word(), 5);
    }
    {
        INFO("a bit of the records that leaves them valid");
        check_flips_found(renderer, mesh, groups, view->words.size(), 12);
    }
    {
        INFO("a record's first edge");
        gpu::Model bad = model_of(mesh);
        std::uint32_t* head = bad.packed.words.data() + groups;
        std::uint64_t bits = 0;
        std::memcpy(&bits, head, sizeof bits);
        // Adds one to both vertices. They follow the head's fixed bits and one bit for each block except the first.
        bits += (1 + (std::uint64_t{1} << view->vertex_bits)) << (LR_PACKED_HEAD_BITS + LR_PACKED_GROUP - 1);
        std::memcpy(head, &bits, sizeof bits);
        check_found(renderer, bad, gpu::Source::packed);
    }
    {
        // The table makes the second group begin where the first does. Vertices may be out of range: nothing is drawn.
        INFO("the table of groups");
        gpu::Model bad = model_of(mesh);
        bad.packed.words[view->table_word()] = 0;
        Result<gpu::Drawable> drawable = renderer.upload(bad, gpu::Source::packed);
        REQUIRE_MESSAGE(drawable, drawable.error().message);
        const auto indices = renderer.read_indices(*drawable);
        REQUIRE(indices);
        CHECK(*indices != decoded(good));
    }
    {
        INFO("the order of the vertices");
        gpu::Model bad = model_of(mesh);
        std::swap(bad.packed.vertex_order[100], bad.packed.vertex_order[900]);
        CHECK(!comparison_of(renderer, bad, gpu::Source::packed).same());
    }
    {
        INFO("the order of the triangles");
        gpu::Model bad = model_of(mesh);
        std::swap(bad.packed.triangle_order[1000], bad.packed.triangle_order[4000]);
        CHECK(!comparison_of(renderer, bad, gpu::Source::packed).same());
    }
}

TEST_CASE_FIXTURE(GpuTest, "the comparison finds a wrong far vertex of a packed stream") {
    gpu::Renderer renderer = mutation_renderer(*context);

    const Mesh mesh = generated("terrain", 6000, 5);
    const gpu::Model good = model_of(mesh);
    REQUIRE(good.packed.statistics.events[LR_PACKED_FAR] > 10);
    REQUIRE(comparison_of(renderer, good, gpu::Source::packed).same());
    const Result<PackedView> view = view_packed(good.packed.words);
    REQUIRE(view);
    check_flips_found(renderer, mesh, view->groups_word(), view->words.size(), 3, true);
}

TEST_CASE_FIXTURE(GpuTest, "damaged packed streams neither hang nor write beyond their triangles") {
    detail::SplitMix64 random(20261124);
    gpu::RendererOptions options;
    options.width = options.height = 8;
    Result<gpu::Renderer> renderer = gpu::Renderer::create(*context, options);
    REQUIRE(renderer);
    int refused = 0;
    for (int trial = 0; trial < 200; ++trial) {
        CAPTURE(trial);
        gpu::Model model = model_of(random_gluing(60, 100 + random.below(900), static_cast<std::uint64_t>(trial)));
        std::vector<std::uint32_t>& words = model.packed.words;
        const std::size_t body = LR_PACKED_HEADER_WORDS;
        for (std::uint32_t k = 0; k <= random.below(20); ++k) {
            words[body + random.below(static_cast<std::uint32_t>(words.size() - body))] ^= 1U << random.below(32);
        }
        Result<gpu::Drawable> drawable = renderer->upload(model, gpu::Source::packed);
        // A damaged table of doubles changes the number of triangles.
        if (!drawable) {
            ++refused;
            continue;
        }
        REQUIRE(renderer->read_indices(*drawable));
    }
    CHECK(refused < 50);
}

TEST_CASE("validation reports a missing barrier between decoder and draw") {
    const Mesh mesh = generated("sphere", 2000);
    const gpu::Model model = model_of(mesh);
    auto context = gpu::Context::create({{}, true});
    REQUIRE_MESSAGE(context, context.error().message);
    gpu::RendererOptions options;
    options.width = 160;
    options.height = 120;
    Result<gpu::Renderer> renderer = gpu::Renderer::create(**context, options);
    REQUIRE(renderer);
    const gpu::Camera camera = gpu::make_camera(model, {}, options.width, options.height).value();
    Result<gpu::Drawable> drawable = renderer->upload(model, gpu::Source::lean);
    REQUIRE(drawable);
    REQUIRE(renderer->draw(*drawable, model, camera, false));
    REQUIRE((*context)->validation().count() == 0);
    // Records decoder and draw without the barrier between them.
    const gpu::LeanDecoder decoder = gpu::LeanDecoder::create(**context).value();
    const LeanView view = view_lean(model.lean.words).value();
    const gpu::DecodePlan plan = decoder.plan(drawable->descriptors, drawable->mesh, view).value();
    const VkCommandBuffer commands = renderer->commands().begin().value();
    decoder.record(commands, plan);
    renderer->painter().record(commands, drawable->mesh, drawable->draw, renderer->target(),
                               gpu::Painter::Ties::first_drawn);
    REQUIRE(renderer->commands().run());
    const std::vector<std::string> messages = (*context)->validation().messages();
    REQUIRE(!messages.empty());
    CHECK(messages[0].find("SYNC-HAZARD") != std::string::npos);
}
