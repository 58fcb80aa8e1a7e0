#pragma once
// For tests of the corner operators in shaders: meshes, their tables, and functions that run a shader.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>

#include "lacedring/lacedring.hpp"
#include "lacedring/mesh_files.hpp"
#include "lacedring/topology.hpp"
#include "lrcore/base/vec3.h"
#include "renderer/draw/adjacency.h"
#include "shaders/adjacency/adjacency_shared.h"
#include "tests/gpu/gpu_test.h"
#include "tests/support/meshes.h"

namespace lacedring::test {

/// A mesh's LR tables and the map of their elements to its corner table (with split fans).
struct Tables {
    CornerTable table;
    std::vector<float> positions;  ///< by vertex of the corner table
    EncodedLr encoded;
    LrMap map;
    LrView view;
};

/// Null if the mesh has no LR tables.
inline std::unique_ptr<Tables> tables_of(const Mesh& mesh, std::vector<float> positions, bool warts) {
    Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
    if (!table) return nullptr;
    auto out = std::make_unique<Tables>();
    Result<EncodedLr> encoded = encode_lr(*table, {}, {.passes = 0}, warts);
    REQUIRE_MESSAGE(encoded, encoded.error().message);
    out->encoded = std::move(*encoded);
    const Result<LrStreamView<LrView>> stream = validate_lr(out->encoded.words);
    REQUIRE_MESSAGE(stream, stream.error().message);
    out->view = stream->view;

    out->table = std::move(*table);
    out->positions = std::move(positions);
    for (const VertexId v : split_fans(out->table)) {
        for (std::size_t i = 0; i < 3 && !out->positions.empty(); ++i) {
            out->positions.push_back(out->positions[3 * std::size_t{v.value} + i]);
        }
    }
    const Rings rings = expand_rings(out->table, {.one_per_shell = true});
    const Result<LrTable> lr = build_lr(out->table, rings, {.wart_skipping = warts}, &out->map);
    REQUIRE(lr);
    REQUIRE(std::ranges::equal(lr->lr, out->view.lr));
    return out;
}

struct Measured {
    std::size_t meshes = 0, corners = 0, vertices = 0, excluded = 0, rounded = 0, edges = 0, drawn = 0, near_edges = 0,
                other = 0;
    double worst = 0;
};

/// Shares pipelines between all meshes, because lavapipe takes long to create them.
struct AdjacencyTest : GpuTest {
    AdjacencyTest() {
        const std::array<gpu::Binding, 4> bindings{{{0}, {1}, {2}, {3}}};
        auto made = gpu::Layout::create(*context, "operators", bindings, VK_SHADER_STAGE_COMPUTE_BIT, 64);
        auto t = gpu::Transfer::create(*context);
        auto c = gpu::Commands::create(*context);
        REQUIRE((made && t && c));
        layout = std::move(*made);
        transfer.emplace(std::move(*t));
        commands.emplace(std::move(*c));
    }

    gpu::PipelineHandle pipeline(const gpu::Shader& shader, std::uint32_t constant = 0) {
        auto made = gpu::create_compute(*context, "adjacency test", layout, shader, std::span(&constant, 1));
        REQUIRE_MESSAGE(made, made.error().message);
        return std::move(*made);
    }
    gpu::Buffer buffer(std::size_t bytes) {
        auto made = gpu::Buffer::create(*context, "test", bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
        REQUIRE_MESSAGE(made, made.error().message);
        return std::move(*made);
    }
    gpu::Buffer buffer(std::span<const std::uint32_t> words) {
        gpu::Buffer out = buffer(words.size_bytes());
        if (!words.empty()) REQUIRE(transfer->upload(out, words));
        return out;
    }
    template <class T>
    std::vector<T> read(const gpu::Buffer& from, std::size_t count) {
        std::vector<T> out(count);
        if (count > 0) REQUIRE(transfer->read(from, 0, std::as_writable_bytes(std::span(out))));
        return out;
    }
    void run(const gpu::PipelineHandle& pipe, std::array<const gpu::Buffer*, 4> buffers, const void* push,
             std::uint32_t push_bytes, std::uint32_t invocations) {
        gpu::Descriptors descriptors(*context);
        const auto set = descriptors.allocate(layout);
        REQUIRE(set);
        for (std::uint32_t i = 0; i < 4; ++i) {
            descriptors.write(*set, i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, gpu::BufferRange{buffers[i]});
        }
        const auto recording = commands->begin();
        REQUIRE(recording);
        vkCmdBindPipeline(*recording, VK_PIPELINE_BIND_POINT_COMPUTE, pipe.get());
        vkCmdBindDescriptorSets(*recording, VK_PIPELINE_BIND_POINT_COMPUTE, layout.pipeline(), 0, 1, &*set, 0, nullptr);
        vkCmdPushConstants(*recording, layout.pipeline(), VK_SHADER_STAGE_COMPUTE_BIT, 0, push_bytes, push);
        vkCmdDispatch(*recording, (invocations + LR_COMPUTE_GROUP - 1) / LR_COMPUTE_GROUP, 1, 1);
        gpu::decode_barrier(*recording);
        REQUIRE(commands->run());
    }

    gpu::Layout layout;
    std::optional<gpu::Transfer> transfer;
    std::optional<gpu::Commands> commands;
    Measured measured;
};

/// Calls check(mesh, n) for every test mesh, with varying n.
template <class Check>
void every_mesh(const Check& check) {
    for (const NamedMesh& named : named_meshes()) {
        CAPTURE(named.name);
        check(named.mesh, 1);
    }
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        CAPTURE(seed);
        const auto n = static_cast<std::uint32_t>(seed);
        check(random_soup(4 + n % 29, 1 + 2 * n, seed), n);
        check(random_gluing(10 + n, 150 + 10 * n, seed), n);
    }
    for (const GeneratorInfo& kind : generators()) {
        CAPTURE(kind.name);
        check(generated(kind.name, 6000, 3), 1);
    }
    const auto checked = for_each_real_mesh([&](const std::string& path, const Result<Mesh>& mesh) {
        CAPTURE(path);
        REQUIRE(mesh);
        check(weld(*mesh, Weld::none), 1);
        check(weld(*mesh, Weld::position), 2);
    });
    CHECK_MESSAGE(checked.value_or(1) > 0, "the folder LACEDRING_MESHES has meshes");
}

using Point3 = detail::Vec3<double>;
using detail::cross, detail::dot, detail::length, detail::minus;

/// The positions that are drawn; empty if there is nothing to draw.
inline std::vector<float> model_positions(const Mesh& mesh) {
    Result<gpu::Model> model = gpu::make_model(mesh);
    return model ? std::move(model->positions) : std::vector<float>();
}

}  // namespace lacedring::test
