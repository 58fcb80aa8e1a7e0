#include <vector>

#include "renderer/vk/device_error.h"
#include "tests/gpu/gpu_test.h"

using namespace lacedring;
using namespace lacedring::test;

TEST_CASE("a missing device is an error that lists the available ones") {
    const auto context = gpu::Context::create({"no such device", false});
    REQUIRE(!context);
    CHECK(context.error().code == gpu::kNoDevice);
    CHECK(context.error().message.find("not named \"no such device\"") != std::string::npos);
    CHECK(context.error().message.find('\n') == std::string::npos);
    const auto any = gpu::Context::create({});
    REQUIRE(any);
    CHECK(context.error().message.find((*any)->info().name) != std::string::npos);
}

TEST_CASE("lavapipe is found by that name, although its driver is named llvmpipe") {
    const auto any = gpu::Context::create({});
    REQUIRE(any);
    if (!(*any)->info().driver.starts_with("llvmpipe")) return;
    for (const char* name : {"lavapipe", "LavaPipe", "llvmpipe"}) {
        CAPTURE(name);
        const auto named = gpu::Context::create({name, false});
        REQUIRE_MESSAGE(named, named.error().message);
        CHECK((*named)->info().driver == (*any)->info().driver);
    }
}

TEST_CASE_FIXTURE(GpuTest, "a device is found by a part of its name, in upper or lower case") {
    std::string part = context->info().name.substr(0, 5);
    for (char& c : part) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    const auto again = gpu::Context::create({part, false});
    REQUIRE_MESSAGE(again, again.error().message);
    CHECK((*again)->info().name == context->info().name);
    CHECK((*again)->info().api.rfind("1.", 0) == 0);
}

TEST_CASE_FIXTURE(GpuTest, "buffers share few blocks, do not overlap, and freed ranges are joined") {
    std::vector<gpu::Buffer> buffers;
    for (std::uint32_t i = 0; i < 500; ++i) {
        auto buffer = gpu::Buffer::create(*context, "small", 1000 + 37 * i, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                          gpu::Memory::upload);
        REQUIRE_MESSAGE(buffer, buffer.error().message);
        std::fill_n(buffer->mapped(), buffer->size(), static_cast<std::byte>(i));
        buffers.push_back(std::move(buffer).value());
        if (i % 3 == 0) buffers.erase(buffers.begin() + static_cast<std::ptrdiff_t>(buffers.size() / 2));
    }
    for (const gpu::Buffer& buffer : buffers) {
        const std::byte first = buffer.mapped()[0];
        for (std::uint64_t i = 0; i < buffer.size(); ++i) REQUIRE(buffer.mapped()[i] == first);
    }
    CHECK(context->arena().block_count() <= 2);
    const VkDeviceSize held = context->arena().held();
    buffers.clear();
    // All is one free range again: a buffer of the total size needs no new block.
    const auto large =
        gpu::Buffer::create(*context, "large", held / 2, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Memory::upload);
    REQUIRE(large);
    CHECK(context->arena().held() == held);
}

TEST_CASE_FIXTURE(GpuTest, "the block of a single large buffer is freed with the buffer") {
    const VkDeviceSize held = context->arena().held();
    {
        const auto large =
            gpu::Buffer::create(*context, "large", VkDeviceSize{100} << 20, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
        REQUIRE(large);
        CHECK(context->arena().held() > held);
    }
    CHECK(context->arena().held() == held);
}

TEST_CASE_FIXTURE(GpuTest, "a buffer larger than the device's memory is an error") {
    const auto buffer =
        gpu::Buffer::create(*context, "huge", context->info().max_buffer_size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    REQUIRE(!buffer);
    CHECK(buffer.error().code == gpu::kNoDevice);
    CHECK(buffer.error().message.find("huge") != std::string::npos);
    const auto target = gpu::Target::create(*context, {context->limits().maxImageDimension2D + 1, 1});
    REQUIRE(!target);
    CHECK(target.error().code == gpu::kNoDevice);
}

TEST_CASE_FIXTURE(GpuTest, "bytes written to the device in pieces are read back") {
    auto transfer = gpu::Transfer::create(*context);
    REQUIRE(transfer);
    std::vector<std::uint32_t> values((std::size_t{20} << 20) / 4 + 3);
    for (std::uint32_t i = 0; i < values.size(); ++i) values[i] = i * 2654435761U;
    const auto buffer = gpu::Buffer::create(*context, "values", 4 * values.size(), 0);
    REQUIRE(buffer);
    REQUIRE(transfer->upload(*buffer, std::span<const std::uint32_t>(values)));
    std::vector<std::uint32_t> back(values.size());
    REQUIRE(transfer->read(*buffer, 0, std::as_writable_bytes(std::span(back))));
    CHECK(back == values);
    CHECK(!transfer->read(*buffer, 8, std::as_writable_bytes(std::span(back))));
}

TEST_CASE("a mesh takes at most the predicted device memory, and none if that exceeds the limit") {
    const Mesh mesh = generated("blob", 200000);
    const gpu::Model model = gpu::make_model(mesh, {.packed = true, .vertices = VertexOptions{}}).value();
    auto context = gpu::Context::create({{}, true});
    REQUIRE(context);
    gpu::RendererOptions options;
    options.width = options.height = 16;
    for (const gpu::View view : {gpu::View::smooth, gpu::View::triangle_class, gpu::View::wire}) {
        options.view = view;
        auto renderer = gpu::Renderer::create(**context, options);
        REQUIRE(renderer);
        for (const auto& [name, source, label] : gpu::kSources) {
            CAPTURE(std::string(name));
            for (const gpu::Path path : {gpu::Path::compute, gpu::Path::pull}) {
                if (source == gpu::Source::plain && path != gpu::Path::compute) continue;
                const std::uint64_t said = renderer->device_bytes(model, source, path);
                const std::uint64_t before = (*context)->arena().used();
                const auto drawable = renderer->upload(model, source, path);
                REQUIRE(drawable);
                const std::uint64_t taken = (*context)->arena().used() - before;
                CHECK(taken <= said + 8 * 256);  // buffers are rounded up
                // The prediction counts lines as if none were shared and all vertices were on rings.
                const bool edges = view == gpu::View::wire;
                CHECK(said <= taken + 24000 + (edges ? 12 * mesh.triangle_count() : 2 * mesh.vertex_count));
            }
        }
    }
    CHECK((*context)->validation().count() == 0);

    auto small = gpu::Context::create({.device = {}, .validation = true, .gpu_assisted = false, .memory = 38U << 20});
    REQUIRE(small);
    options.view = gpu::View::smooth;
    auto renderer = gpu::Renderer::create(**small, options);
    REQUIRE_MESSAGE(renderer, renderer.error().message);
    const std::uint64_t used = (*small)->arena().used(), held = (*small)->arena().held();
    REQUIRE(used + renderer->device_bytes(model, gpu::Source::lean) > 38U << 20);
    const auto drawable = renderer->upload(model, gpu::Source::lean);
    REQUIRE_FALSE(drawable);
    CHECK(drawable.error().code == gpu::kNoDevice);
    CHECK(drawable.error().message.find("MiB") != std::string::npos);
    CHECK((*small)->arena().used() == used);
    CHECK((*small)->arena().held() == held);
}
