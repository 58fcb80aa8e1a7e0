#pragma once
// The fixture of all tests on the device: validation is on, and its messages fail the test.

#include <doctest/doctest.h>

#include "lrlab/generate/generate.h"
#include "renderer/draw/renderer.h"
#include "renderer/verify/compare.h"

namespace lacedring::test {

// The size of most pictures.
constexpr std::uint32_t kWidth = 160, kHeight = 120;

/// Fails if there is no device or no validation layer; never skips.
struct GpuTest {
    GpuTest() {
        Result<std::unique_ptr<gpu::Context>> made = gpu::Context::create({{}, true});
        REQUIRE_MESSAGE(made, made.error().message);
        context = std::move(made).value();
    }
    GpuTest(const GpuTest&) = delete;
    GpuTest& operator=(const GpuTest&) = delete;
    ~GpuTest() {
        if (context == nullptr) return;
        CHECK(context->validation().count() == 0);
        const std::vector<std::string> messages = context->validation().messages();
        for (std::size_t i = 0; i < std::min<std::size_t>(3, messages.size()); ++i) MESSAGE(messages[i]);
    }

    std::unique_ptr<gpu::Context> context;
};

inline Mesh generated(std::string_view kind, std::uint64_t triangles, std::uint64_t seed = 1) {
    Result<Mesh> mesh = generate(kind, triangles, seed);
    REQUIRE_MESSAGE(mesh, mesh.error().message);
    return std::move(mesh).value();
}

inline gpu::Model model_of(const Mesh& mesh) {
    Result<gpu::Model> model = gpu::make_model(mesh, {.packed = true});
    REQUIRE_MESSAGE(model, model.error().message);
    return std::move(model).value();
}

/// The smallest descriptor range.
constexpr std::uint64_t kSmallRange = 4096;

}  // namespace lacedring::test
