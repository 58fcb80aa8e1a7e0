#include "app/bench/device_times.h"

#include <functional>
#include <list>
#include <optional>
#include <span>
#include <utility>

#include "lrlab/rivals/codecs.h"
#include "renderer/draw/renderer.h"
#include "renderer/vk/handle.h"
#include "renderer/vk/try.h"

namespace lacedring::app {
namespace {

/// Commands to time, and the vector that receives their times.
struct Work {
    Times* times;
    std::function<void(VkCommandBuffer)> record;
};

/// Runs the works in turn, each between timestamps. The first round is not counted: it touches pages and compiles
/// shaders.
Result<void> run_in_turns(gpu::Commands& commands, const TimingOptions& options, std::span<const Work> works) {
    const std::uint32_t repeats = options.repeats;
    const auto total = static_cast<std::uint32_t>((repeats + 1) * works.size());
    std::uint32_t done = 0;
    for (std::uint32_t i = 0; i <= repeats; ++i) {
        for (const Work& work : works) {
            LR_ASSIGN(const VkCommandBuffer buffer, commands.begin());
            commands.start_timer();
            work.record(buffer);
            commands.stop_timer();
            LR_ASSIGN(const gpu::Elapsed elapsed, commands.run());
            if (i != 0) work.times->push_back(elapsed);
            if (options.progress) options.progress(++done, total);
        }
    }
    return {};
}

/// A copy of a model with its index list in meshoptimizer's best order and its vertices in order of use.
struct BestOrder {
    std::vector<std::uint32_t> indices;
    gpu::Model model;

    BestOrder(const gpu::Model& from, std::vector<std::uint32_t> order) : indices(std::move(order)) {
        std::vector<std::uint32_t> number(from.vertex_count(), UINT32_MAX);
        std::uint32_t next = 0;
        model.positions.resize(from.positions.size());
        model.normals.resize(from.normals.size());
        const auto move = [&](std::uint32_t v) {
            for (std::size_t k = 0; k < 3; ++k) {
                model.positions[3 * std::size_t{next} + k] = from.positions[3 * std::size_t{v} + k];
                model.normals[3 * std::size_t{next} + k] = from.normals[3 * std::size_t{v} + k];
            }
            number[v] = next++;
        };
        for (std::uint32_t& v : indices) {
            if (number[v] == UINT32_MAX) move(v);
            v = number[v];
        }
        for (std::uint32_t v = 0; v < number.size(); ++v) {
            if (number[v] == UINT32_MAX) move(v);
        }
        model.indices = indices;
        model.surface.vertex_count = from.vertex_count();
    }
};

/// A way, and its model on the device.
struct Uploaded {
    Way way;
    gpu::Drawable drawable;
    Uploaded(std::string name, gpu::Drawable d) : drawable(std::move(d)) {
        way.name = std::move(name);
        way.source = drawable.mesh.source;
        way.path = drawable.mesh.path;
    }
};

Result<void> count_bytes(gpu::Renderer& renderer, Uploaded& uploaded, std::size_t stream_bytes) {
    Way& way = uploaded.way;
    const gpu::GpuMesh& mesh = uploaded.drawable.mesh;
    const std::uint64_t index_bytes = std::uint64_t{12} * mesh.slots;
    if (way.path == gpu::Path::compute) {
        way.connectivity_bytes = index_bytes;  // the stream may be freed after decoding
        way.bytes_read = index_bytes;
        return {};
    }
    LR_ASSIGN(const gpu::WordsRead words, renderer.words_read(uploaded.drawable));
    const std::uint64_t times = way.path == gpu::Path::pull ? 3 : 1;
    way.connectivity_bytes = stream_bytes;
    way.bytes_read = sizeof(std::uint32_t) * words.all * times;
    if (mesh.pulls_copies()) {  // the stream is decoded before; shaders read indices
        LR_TRY(renderer.read_copies(uploaded.drawable));
        way.connectivity_bytes = index_bytes;
        way.bytes_read = index_bytes * times;
    }
    return {};
}

/// Counts the runs of vertex shaders for one picture in one pass. Needs DeviceInfo::statistics, and a decoded drawable.
Result<std::uint64_t> vertex_invocations(gpu::Renderer& renderer, const gpu::Drawable& drawable) {
    VkQueryPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    info.queryType = VK_QUERY_TYPE_PIPELINE_STATISTICS;
    info.queryCount = 1;
    info.pipelineStatistics = VK_QUERY_PIPELINE_STATISTIC_VERTEX_SHADER_INVOCATIONS_BIT;
    VkQueryPool pool = VK_NULL_HANDLE;
    LR_TRY_VK(vkCreateQueryPool(renderer.context().device(), &info, nullptr, &pool));
    const gpu::QueryPoolHandle queries(renderer.context().device(), pool);
    LR_ASSIGN(const VkCommandBuffer commands, renderer.commands().begin());
    vkCmdResetQueryPool(commands, pool, 0, 1);
    vkCmdBeginQuery(commands, pool, 0, 0);
    renderer.painter().record(commands, drawable.mesh, drawable.draw, renderer.target(),
                              gpu::Painter::Ties::first_drawn);
    vkCmdEndQuery(commands, pool, 0);
    LR_TRY(renderer.commands().run());
    std::uint64_t count = 0;
    LR_TRY_VK(vkGetQueryPoolResults(renderer.context().device(), pool, 0, 1, sizeof(count), &count, sizeof(count),
                                    VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT));
    return count;
}

}  // namespace

Result<DeviceTimes> measure_device(gpu::Context& context, const gpu::Model& model, const TimingOptions& options) {
    gpu::RendererOptions renderer_options;
    renderer_options.width = options.width;
    renderer_options.height = options.height;
    LR_ASSIGN(gpu::Renderer renderer, gpu::Renderer::create(context, renderer_options));
    std::list<Uploaded> all;  // elements must not move
    const auto add = [&](std::string name, const gpu::Model& of, gpu::Source source, gpu::Path path) -> Result<void> {
        LR_ASSIGN(gpu::Drawable drawable, renderer.upload(of, source, path));
        all.emplace_back(std::move(name), std::move(drawable));
        return count_bytes(renderer, all.back(), gpu::connectivity_bytes(of, source));
    };
    LR_TRY(add("plain", model, gpu::Source::plain, gpu::Path::compute));
    DeviceTimes out;
    std::optional<BestOrder> best;  // must outlive the upload
    if (Result<std::vector<std::uint32_t>> order = best_cache_order(model.indices, model.vertex_count())) {
        best.emplace(model, std::move(*order));
        LR_TRY(add("plain_best_order", best->model, gpu::Source::plain, gpu::Path::compute));
    } else {
        out.absent.emplace_back("plain_best_order", order.error().message);
    }
    for (const auto& [path_name, path, path_label] : gpu::kPaths) {
        if (path == gpu::Path::mesh && context.info().max_mesh_groups == 0) continue;
        const std::string suffix = path == gpu::Path::compute ? "" : std::string("_") + path_name;
        for (const auto& [name, source, label] : gpu::kSources) {
            if (source == gpu::Source::plain || !gpu::has_source(model, source)) continue;
            if (gpu::is_slow(source, path, model.triangle_count())) {
                out.absent.emplace_back(name + suffix, "more than " + std::to_string(gpu::kMostPulled) +
                                                           " triangles; each corner decodes half a block of vertices");
                continue;
            }
            LR_TRY(add(name + suffix, model, source, path));
        }
    }
    LR_ASSIGN(const gpu::Camera camera, gpu::make_camera(model, {}, options.width, options.height));
    renderer.painter().set_frame(model, camera, renderer.target());

    const auto draw = [&](VkCommandBuffer buffer, const gpu::Drawable& drawable) {
        renderer.painter().record(buffer, drawable.mesh, drawable.draw, renderer.target(),
                                  gpu::Painter::Ties::first_drawn);
    };
    const auto decode = [&](VkCommandBuffer buffer, gpu::Drawable& drawable) {
        drawable.mesh.decoded = false;
        renderer.decode(buffer, drawable);
    };
    std::vector<Work> works;
    const gpu::Buffer* lean_indices = nullptr;
    for (Uploaded& uploaded : all) {
        gpu::Drawable& drawable = uploaded.drawable;
        Way& way = uploaded.way;
        if (way.path == gpu::Path::compute && way.source != gpu::Source::plain) {
            works.push_back({&way.decode, [&](VkCommandBuffer buffer) { decode(buffer, drawable); }});
            works.push_back({&way.decode_and_draw, [&](VkCommandBuffer buffer) {
                                 decode(buffer, drawable);
                                 draw(buffer, drawable);
                             }});
        }
        works.push_back({&way.draw, [&](VkCommandBuffer buffer) { draw(buffer, drawable); }});
        if (drawable.mesh.source == gpu::Source::packed_vertices && way.path == gpu::Path::compute) {
            works.push_back(
                {&out.vertices, [&](VkCommandBuffer buffer) { renderer.decode_vertices(buffer, drawable); }});
        }
        if (way.name == "lean") {
            lean_indices = &drawable.mesh.indices;
            out.index_bytes = std::uint64_t{12} * drawable.mesh.slots;
        }
    }
    LR_ASSIGN(const gpu::Buffer copy, gpu::Buffer::create(context, "copy of the indices", out.index_bytes, 0));
    works.push_back({&out.copy, [&](VkCommandBuffer buffer) {
                         const VkBufferCopy region{0, 0, out.index_bytes};
                         vkCmdCopyBuffer(buffer, lean_indices->handle(), copy.handle(), 1, &region);
                     }});
    LR_TRY(run_in_turns(renderer.commands(), options, works));
    for (Uploaded& uploaded : all) {
        if (uploaded.way.path != gpu::Path::mesh && context.info().statistics) {
            LR_ASSIGN(uploaded.way.vertex_invocations, vertex_invocations(renderer, uploaded.drawable));
        }
        out.ways.push_back(std::move(uploaded.way));
    }
    out.device_bytes = context.arena().peak();
    return out;
}

}  // namespace lacedring::app
