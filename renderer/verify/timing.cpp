#include "renderer/verify/timing.h"

#include <functional>
#include <list>
#include <optional>
#include <span>
#include <utility>

#include "lrlab/rivals/codecs.h"
#include "renderer/draw/renderer.h"
#include "renderer/vk/try.h"

namespace lacedring::gpu {
namespace {

/// Something to time, and where its times go.
struct Work {
    Times* times;
    std::function<void(VkCommandBuffer)> record;
};

/// Runs each piece of work between timestamps, in turns. The first round is not counted: pages are touched, shaders
/// compiled.
Result<void> run_in_turns(Commands& commands, const TimingOptions& options, std::span<const Work> works) {
    const std::uint32_t repeats = options.repeats;
    const auto total = static_cast<std::uint32_t>((repeats + 1) * works.size());
    std::uint32_t done = 0;
    for (std::uint32_t i = 0; i <= repeats; ++i) {
        for (const Work& work : works) {
            LR_ASSIGN(const VkCommandBuffer buffer, commands.begin());
            commands.start_timer();
            work.record(buffer);
            commands.stop_timer();
            LR_ASSIGN(const Elapsed elapsed, commands.run());
            if (i != 0) work.times->push_back(elapsed);
            if (options.progress) options.progress(++done, total);
        }
    }
    return {};
}

/// A model whose index list is in the rival's best order, and vertices in the order of their use.
struct BestOrder {
    std::vector<std::uint32_t> indices;
    Model model;

    BestOrder(const Model& from, std::vector<std::uint32_t> order) : indices(std::move(order)) {
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

/// A way, and what it is drawn from.
struct Uploaded {
    Way way;
    Drawable drawable;
    Uploaded(std::string name, Drawable d) : drawable(std::move(d)) {
        way.name = std::move(name);
        way.source = drawable.mesh.source;
        way.path = drawable.mesh.path;
    }
};

Result<void> count_bytes(Renderer& renderer, Uploaded& uploaded, std::size_t stream_bytes) {
    Way& way = uploaded.way;
    const GpuMesh& mesh = uploaded.drawable.mesh;
    const std::uint64_t index_bytes = std::uint64_t{12} * mesh.slots;
    if (way.path == Path::compute) {
        way.connectivity_bytes = index_bytes;  // the stream may go once it is decoded
        way.bytes_read = index_bytes;
        return {};
    }
    LR_ASSIGN(const WordsRead words, renderer.words_read(uploaded.drawable));
    const std::uint64_t times = way.path == Path::pull ? 3 : 1;
    way.connectivity_bytes = stream_bytes;
    way.bytes_read = sizeof(std::uint32_t) * words.all * times;
    if (mesh.pulls_copies()) {  // instead of the stream, which is decoded before
        LR_TRY(renderer.read_copies(uploaded.drawable));
        way.connectivity_bytes = index_bytes;
        way.bytes_read = index_bytes * times;
    }
    return {};
}

}  // namespace

Result<DeviceTimes> measure_device(Context& context, const Model& model, const TimingOptions& options) {
    RendererOptions renderer_options;
    renderer_options.width = options.width;
    renderer_options.height = options.height;
    LR_ASSIGN(Renderer renderer, Renderer::create(context, renderer_options));
    std::list<Uploaded> all;  // their places are kept
    const auto add = [&](std::string name, const Model& of, Source source, Path path) -> Result<void> {
        LR_ASSIGN(Drawable drawable, renderer.upload(of, source, path));
        all.emplace_back(std::move(name), std::move(drawable));
        return count_bytes(renderer, all.back(), connectivity_bytes(of, source));
    };
    LR_TRY(add("plain", model, Source::plain, Path::compute));
    DeviceTimes out;
    std::optional<BestOrder> best;  // must outlive the upload
    if (Result<std::vector<std::uint32_t>> order = best_cache_order(model.indices, model.vertex_count())) {
        best.emplace(model, std::move(*order));
        LR_TRY(add("plain_best_order", best->model, Source::plain, Path::compute));
    } else {
        out.absent.emplace_back("plain_best_order", order.error().message);
    }
    for (const auto& [path_name, path] : kPaths) {
        if (path == Path::mesh && context.info().max_mesh_groups == 0) continue;
        const std::string suffix = path == Path::compute ? "" : std::string("_") + path_name;
        for (const auto& [name, source] : kSources) {
            if (source == Source::plain || !has_source(model, source)) continue;
            if (is_slow(source, path, model.triangle_count())) {
                out.absent.emplace_back(name + suffix, "more than " + std::to_string(kMostPulled) +
                                                           " triangles; each corner decodes half a block of vertices");
                continue;
            }
            LR_TRY(add(name + suffix, model, source, path));
        }
    }
    LR_ASSIGN(const Camera camera, make_camera(model, {}, options.width, options.height));
    renderer.painter().set_frame(model, camera, renderer.target());

    const auto draw = [&](VkCommandBuffer buffer, const Drawable& drawable) {
        renderer.painter().record(buffer, drawable.mesh, drawable.draw, renderer.target(), Painter::Ties::first_drawn);
    };
    const auto decode = [&](VkCommandBuffer buffer, Drawable& drawable) {
        drawable.mesh.decoded = false;
        renderer.decode(buffer, drawable);
    };
    std::vector<Work> works;
    const Buffer* lean_indices = nullptr;
    for (Uploaded& uploaded : all) {
        Drawable& drawable = uploaded.drawable;
        Way& way = uploaded.way;
        if (way.path == Path::compute && way.source != Source::plain) {
            works.push_back({&way.decode, [&](VkCommandBuffer buffer) { decode(buffer, drawable); }});
            works.push_back({&way.decode_and_draw, [&](VkCommandBuffer buffer) {
                                 decode(buffer, drawable);
                                 draw(buffer, drawable);
                             }});
        }
        works.push_back({&way.draw, [&](VkCommandBuffer buffer) { draw(buffer, drawable); }});
        if (drawable.mesh.source == Source::packed_vertices && way.path == Path::compute) {
            works.push_back(
                {&out.vertices, [&](VkCommandBuffer buffer) { renderer.decode_vertices(buffer, drawable); }});
        }
        if (way.name == "lean") {
            lean_indices = &drawable.mesh.indices;
            out.index_bytes = std::uint64_t{12} * drawable.mesh.slots;
        }
    }
    LR_ASSIGN(const Buffer copy, Buffer::create(context, "copy of the indices", out.index_bytes, 0));
    works.push_back({&out.copy, [&](VkCommandBuffer buffer) {
                         const VkBufferCopy region{0, 0, out.index_bytes};
                         vkCmdCopyBuffer(buffer, lean_indices->handle(), copy.handle(), 1, &region);
                     }});
    LR_TRY(run_in_turns(renderer.commands(), options, works));
    for (Uploaded& uploaded : all) {
        if (uploaded.way.path != Path::mesh && context.info().statistics) {
            LR_ASSIGN(uploaded.way.vertex_invocations, renderer.vertex_invocations(uploaded.drawable));
        }
        out.ways.push_back(std::move(uploaded.way));
    }
    out.device_bytes = context.arena().peak();
    return out;
}

}  // namespace lacedring::gpu
