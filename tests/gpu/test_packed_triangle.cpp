// Compares lr_packed_triangle of shaders/include/lacedring.glsl, which decodes a single triangle, with decode_packed.

#include <array>

#include "lacedring/lacedring.hpp"
#include "lacedring/streams.hpp"
#include "renderer/vk/pipeline.h"
#include "spirv/packed_triangle_comp.h"
#include "tests/gpu/gpu_test.h"
#include "tests/support/meshes.h"

using namespace lacedring;
using namespace lacedring::test;

namespace {

struct RandomAccess : GpuTest {
    RandomAccess() {
        const std::array<gpu::Binding, 2> bindings{{{0}, {1}}};
        auto made = gpu::Layout::create(*context, "triangles", bindings, VK_SHADER_STAGE_COMPUTE_BIT, 4);
        REQUIRE(made);
        layout = std::move(*made);
        auto pipe = gpu::create_compute(*context, "triangles", layout, spirv_packed_triangle_comp);
        REQUIRE(pipe);
        pipeline = std::move(*pipe);
    }

    /// The triangles decoded one by one, then decoded four at a time.
    std::vector<std::uint32_t> decoded(std::span<const std::uint32_t> words, std::uint32_t triangles) {
        constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
        constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        std::vector<std::uint32_t> out(std::size_t{6} * triangles);
        const auto stream = gpu::Buffer::create(*context, "stream", words.size_bytes(), kUsage);
        const auto indices = gpu::Buffer::create(*context, "indices", 4 * out.size(), kUsage);
        auto commands = gpu::Commands::create(*context);
        auto transfer = gpu::Transfer::create(*context);
        REQUIRE((stream && indices && commands && transfer));
        REQUIRE(transfer->upload(*stream, words));
        gpu::Descriptors descriptors(*context);
        const auto set = descriptors.allocate(layout);
        REQUIRE(set);
        descriptors.write(*set, 0, kStorage, {&*stream});
        descriptors.write(*set, 1, kStorage, {&*indices});
        const auto buffer = commands->begin();
        REQUIRE(buffer);
        vkCmdBindPipeline(*buffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.get());
        vkCmdBindDescriptorSets(*buffer, VK_PIPELINE_BIND_POINT_COMPUTE, layout.pipeline(), 0, 1, &*set, 0, nullptr);
        vkCmdDispatch(*buffer, (triangles + 63) / 64, 1, 1);
        gpu::decode_barrier(*buffer);
        REQUIRE(commands->run());
        REQUIRE(transfer->read(*indices, 0, std::as_writable_bytes(std::span(out))));
        return out;
    }

    void check(const Mesh& mesh) {
        const Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
        REQUIRE(table);
        const Result<PackedChoice> encoded = encode_smallest_packed(*table, {}, {.passes = 0});
        REQUIRE(encoded);
        const EncodedPacked& stream = encoded->stream;
        const Result<PackedView> view = validate_packed(stream.words);
        REQUIRE(view);
        if (view->triangles == 0) return;
        std::vector<std::uint32_t> expected(std::size_t{3} * view->triangles);
        decode_packed(*view, expected);
        expected.insert(expected.end(), expected.begin(), expected.end());
        CHECK(decoded(stream.words, view->triangles) == expected);
    }

    gpu::Layout layout;
    gpu::PipelineHandle pipeline;
};

}  // namespace

TEST_CASE_FIXTURE(RandomAccess, "single triangles of a packed stream decode as on the CPU") {
    for (const NamedMesh& named : named_meshes()) {
        CAPTURE(named.name);
        check(named.mesh);
    }
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        CAPTURE(seed);
        const auto n = static_cast<std::uint32_t>(seed);
        check(random_gluing(10 + n, 150 + 40 * n, seed));
        check(random_soup(300, 300, seed, false));
    }
    check(generated("blob", 20000));
    check(generated("genus", 20000));
}
