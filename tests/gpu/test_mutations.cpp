// Tests of the tests: what must not pass does not pass.

#include "lrcore/lean/lean_format.h"
#include "tests/gpu/gpu_test.h"

using namespace lr;
using namespace lr::test;

namespace {

gpu::Comparison compared(gpu::Context& context, const gpu::Model& model) {
    gpu::CompareOptions options;
    options.width = 320;
    options.height = 240;
    Result<gpu::Comparison> out = gpu::compare(context, model, options);
    REQUIRE_MESSAGE(out, out.error().message);
    return std::move(out).value();
}

/// Payload slots whose word fits, spread over the stream.
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

void check_found(gpu::Context& context, const gpu::Model& model) {
    const gpu::Comparison c = compared(context, model);
    CHECK(!c.same());
    CHECK(c.indices_equal_cpu);  // both decode the wrong stream alike: it is the picture that tells
    CHECK(c.pixels_different > 0);
    CHECK(c.triangle_ids_different > 0);
}

}  // namespace

TEST_CASE_FIXTURE(GpuTest, "one wrong word of the stream is seen") {
    const Mesh mesh = generated("blob", 3000, 5);
    const gpu::Model good = model_of(mesh);
    REQUIRE(compared(*context, good).same());

    SUBCASE("a tip") {
        for (const std::uint32_t slot : slots_where(good, 4, [](const LeanView&view, std::uint32_t i) {
                 return i < view.ring_slots() && (view.payload[i] & ~LR_LEAN_TIP_MASK) == 0;
             })) {
            CAPTURE(slot);
            gpu::Model bad = model_of(mesh);
            std::uint32_t& word = bad.lean.words[LR_LEAN_HEADER_WORDS + slot];
            word = (word + mesh.vertex_count / 2) % mesh.vertex_count;
            check_found(*context, bad);
        }
    }
    SUBCASE("a tip, by one") {
        gpu::Model bad = model_of(mesh);
        const auto slots = slots_where(good, 1, [](const LeanView& view, std::uint32_t i) {
            return i > 500 && i < view.ring_slots() && (view.payload[i] & ~LR_LEAN_TIP_MASK) == 0 &&
                   view.payload[i] > 10;
        });
        --bad.lean.words[LR_LEAN_HEADER_WORDS + slots[0]];
        check_found(*context, bad);
    }
    SUBCASE("a wart bit") {
        for (const std::uint32_t slot : slots_where(good, 4, [](const LeanView&view, std::uint32_t i) {
                 return i < view.ring_slots() && (view.payload[i] & LR_LEAN_WART_FLAG) != 0;
             })) {
            CAPTURE(slot);
            gpu::Model bad = model_of(mesh);
            bad.lean.words[LR_LEAN_HEADER_WORDS + slot] ^= LR_LEAN_WART_FLAG;
            check_found(*context, bad);
        }
    }
    SUBCASE("a vertex of a T0") {
        const Result<LeanView> view = view_lean(good.lean.words);
        REQUIRE(view);
        REQUIRE(view->verbatim >= 3);
        for (std::uint32_t k = 0; k < 3; ++k) {
            gpu::Model bad = model_of(mesh);
            std::uint32_t& word = bad.lean.words[LR_LEAN_HEADER_WORDS + view->ring_slots() + 3 * k + k];
            word = (word + mesh.vertex_count / 2) % mesh.vertex_count;
            check_found(*context, bad);
        }
    }
    SUBCASE("a flip bit") {
        gpu::Model bad = model_of(mesh);
        const auto slots = slots_where(good, 1, [](const LeanView& view, std::uint32_t i) {
            return i > 700 && i < view.ring_slots() && (view.payload[i] & ~LR_LEAN_TIP_MASK) == 0;
        });
        bad.lean.words[LR_LEAN_HEADER_WORDS + slots[0]] ^= LR_LEAN_FLIP_FLAG;
        const gpu::Comparison c = compared(*context, bad);
        CHECK(c.triangle_ids_different > 0);  // its other side is seen; its colours are the same
        CHECK(!c.same());
    }
    SUBCASE("the order of the vertices") {
        gpu::Model bad = model_of(mesh);
        std::swap(bad.lean.vertex_order[100], bad.lean.vertex_order[900]);
        CHECK(!compared(*context, bad).same());
    }
    SUBCASE("the triangles of two slots") {
        gpu::Model bad = model_of(mesh);
        const auto slots = slots_where(good, 2, [](const LeanView&, std::uint32_t) { return true; });
        std::swap(bad.lean.slot_triangle[slots[0]], bad.lean.slot_triangle[slots[1]]);
        CHECK(!compared(*context, bad).same());
    }
}

TEST_CASE("validation sees a missing barrier between the decoder and the draw") {
    const Mesh mesh = generated("sphere", 2000);
    const gpu::Model model = model_of(mesh);
    auto context = gpu::Context::create({{}, true});
    REQUIRE_MESSAGE(context, context.error().message);
    gpu::CompareOptions options;
    options.width = 160;
    options.height = 120;
    REQUIRE(gpu::compare(**context, model, options));
    REQUIRE((*context)->validation().count() == 0);
    options.omit_decode_barrier = true;
    REQUIRE(gpu::compare(**context, model, options));
    const std::vector<std::string> messages = (*context)->validation().messages();
    REQUIRE(!messages.empty());
    CHECK(messages[0].find("SYNC-HAZARD") != std::string::npos);
}
