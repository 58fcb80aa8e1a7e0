// Compares the integers and floats that shaders/decode/vertex_decode.comp and lacedring_vertices.glsl decode with the
// CPU's, bit for bit.

#include <array>
#include <bit>
#include <cstring>
#include <map>
#include <random>

#include "lacedring/vertices.hpp"
#include "renderer/vk/pipeline.h"
#include "shaders/shared.h"
#include "spirv/vertex_decode_comp.h"
#include "tests/gpu/gpu_test.h"
#include "tests/support/meshes.h"

using namespace lacedring;
using namespace lacedring::test;

namespace {

struct VertexDecode : GpuTest {
    VertexDecode() {
        const gpu::Binding binding{0};
        auto made = gpu::Layout::create(*context, "vertices", std::span(&binding, 1), VK_SHADER_STAGE_COMPUTE_BIT,
                                        sizeof(gpu::VertexConstants));
        REQUIRE(made);
        layout = std::move(*made);
    }

    VkPipeline pipeline_of(const VertexView& view, bool integers) {
        const std::array<std::uint32_t, 3> constants{view.integers, integers ? 1U : 0U,
                                                     integers ? 0U : static_cast<std::uint32_t>(view.mapping)};
        gpu::PipelineHandle& pipeline = pipelines[constants];
        if (!pipeline) {
            auto made = gpu::create_compute(*context, "vertices", layout, spirv_vertex_decode_comp, constants);
            REQUIRE(made);
            pipeline = std::move(*made);
        }
        return pipeline.get();
    }

    /// Decodes integers or their values; each vertex has `stride` words.
    std::vector<std::uint32_t> decoded(const VertexView& view, bool integers, std::uint32_t stride) {
        constexpr VkBufferUsageFlags kUsage =
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
        std::vector<std::uint32_t> out(std::size_t{stride} * view.vertices);
        const auto stream = gpu::Buffer::create(*context, "stream", view.words.size_bytes(), kUsage);
        const auto values = gpu::Buffer::create(*context, "values", 4 * out.size(), kUsage);
        auto commands = gpu::Commands::create(*context);
        auto transfer = gpu::Transfer::create(*context);
        REQUIRE((stream && values && commands && transfer));
        REQUIRE(transfer->upload(*stream, view.words));
        gpu::Descriptors descriptors(*context);
        const auto set = descriptors.allocate(layout);
        REQUIRE(set);
        descriptors.write(*set, 0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {&*values});
        const auto buffer = commands->begin();
        REQUIRE(buffer);
        const gpu::VertexConstants constants{0, view.blocks(), stride, 0, stream->address_words()};
        vkCmdBindPipeline(*buffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_of(view, integers));
        vkCmdBindDescriptorSets(*buffer, VK_PIPELINE_BIND_POINT_COMPUTE, layout.pipeline(), 0, 1, &*set, 0, nullptr);
        vkCmdPushConstants(*buffer, layout.pipeline(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(constants), &constants);
        vkCmdDispatch(*buffer, (view.blocks() + LR_VERTEX_GROUP_SIZE - 1) / LR_VERTEX_GROUP_SIZE, 1, 1);
        gpu::decode_barrier(*buffer);
        REQUIRE(commands->run());
        REQUIRE(transfer->read(*values, 0, std::as_writable_bytes(std::span(out))));
        return out;
    }

    void check(const VertexValues& values, const VertexOptions& options) {
        const Result<EncodedVertices> encoded = encode_vertices(values, options);
        REQUIRE_MESSAGE(encoded, encoded.error().message);
        const Result<VertexView> view = validate_vertices(encoded->words);
        REQUIRE(view);
        CAPTURE(static_cast<int>(view->mapping));
        std::vector<std::uint32_t> want(std::size_t{view->integers} * view->vertices);
        for (std::uint32_t block = 0; block < view->blocks(); ++block) {
            decode_vertex_block(*view, block,
                                std::span(want).subspan(std::size_t{block} * kVertexBlock * view->integers));
        }
        CHECK_MESSAGE(decoded(*view, true, view->integers) == want, "the integers are the CPU's");
        std::vector<std::byte> bytes(view->decoded_bytes());
        decode_vertices(*view, bytes);
        std::vector<std::uint32_t> floats(bytes.size() / 4);
        std::memcpy(floats.data(), bytes.data(), bytes.size());
        if (view->mapping != VertexMapping::octahedral) {
            CHECK_MESSAGE(decoded(*view, false, view->integers) == floats, "the values are the CPU's");
            return;
        }
        const std::vector<std::uint32_t> got = decoded(*view, false, 3);
        INFO("directions, divided by their length, are the CPU's");
        for (std::size_t v = 0; v < view->vertices; ++v) {
            double length = 0;
            const auto at = [&](std::size_t c) {
                return static_cast<double>(static_cast<std::int32_t>(got[3 * v + c]));
            };
            for (std::size_t c = 0; c < 3; ++c) length += at(c) * at(c);
            for (std::size_t c = 0; c < 3; ++c) {
                REQUIRE(std::bit_cast<float>(floats[view->components * v + c]) ==
                        static_cast<float>(at(c) / std::sqrt(length)));
            }
        }
    }

    gpu::Layout layout;
    std::map<std::array<std::uint32_t, 3>, gpu::PipelineHandle> pipelines;  ///< by specialization constants
};

}  // namespace

TEST_CASE_FIXTURE(VertexDecode, "vertex streams decode on the device as on the CPU") {
    std::mt19937 random(4);
    for (const char* kind : {"blob", "terrain"}) {
        const Mesh mesh = generated(kind, 9000);
        const Attribute& positions = *find_attribute(mesh, "POSITION");
        const VertexValues values{positions.type, positions.components, false, positions.data};
        for (const std::uint32_t bits : {4U, 14U, 22U})
            check(values, {.mapping = VertexMapping::lattice, .bits = bits});
        check(values, {.mapping = VertexMapping::octahedral, .bits = 10});
        check(values, {});
    }
    for (std::uint32_t components = 1; components <= 4; ++components) {
        CAPTURE(components);
        for (const std::uint32_t vertices : {1U, 2U, 127U, 128U, 129U, 2100U}) {
            CAPTURE(vertices);
            std::vector<float> decimals, any;
            for (std::uint32_t i = 0; i < vertices * components; ++i) {
                const double scale = i % 7 == 0 ? 1e-3 : 2000;
                decimals.push_back(
                    static_cast<float>(std::round(scale * (static_cast<double>(random()) / 4e9 - 0.5)) / 1000));
                if (i % 150 == 100) decimals.back() = 1e-12F;  // an exception
                any.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(random())));
            }
            const auto type = ComponentType::f32;
            check({type, static_cast<std::uint8_t>(components), false, std::as_bytes(std::span(decimals))}, {});
            check({type, static_cast<std::uint8_t>(components), false, std::as_bytes(std::span(any))}, {});
        }
    }
}
