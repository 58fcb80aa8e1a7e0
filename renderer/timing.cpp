#include "renderer/timing.h"

#include <functional>
#include <optional>
#include <span>

#include "renderer/renderer.h"
#include "renderer/try.h"

namespace lr::gpu {
namespace {

/// Something to time, and where its times go.
struct Work {
    Times* times;
    std::function<void(VkCommandBuffer)> record;
};

/// Runs each piece of work between timestamps, in turns. The first round is not counted: pages are touched, shaders
/// compiled.
Result<void> run_in_turns(Commands& commands, std::uint32_t repeats, std::span<const Work> works) {
    for (std::uint32_t i = 0; i <= repeats; ++i) {
        for (const Work& work : works) {
            LR_ASSIGN(const VkCommandBuffer buffer, commands.begin());
            commands.start_timer();
            work.record(buffer);
            commands.stop_timer();
            LR_ASSIGN(const Elapsed elapsed, commands.run());
            if (i != 0) work.times->push_back(elapsed);
        }
    }
    return {};
}

}  // namespace

Result<DeviceTimes> measure_device(Context& context, const Model& model, const TimingOptions& options) {
    RendererOptions renderer_options;
    renderer_options.width = options.width;
    renderer_options.height = options.height;
    LR_ASSIGN(Renderer renderer, Renderer::create(context, renderer_options));
    LR_ASSIGN(Drawable plain, renderer.upload(model, Source::plain));
    LR_ASSIGN(Drawable lean, renderer.upload(model, Source::lean));
    std::optional<Drawable> packed;
    if (!model.packed.words.empty()) {
        LR_ASSIGN(packed, renderer.upload(model, Source::packed));
    }
    LR_ASSIGN(const Camera camera, make_camera(model, {}, options.width, options.height));
    renderer.painter().set_frame(model, camera, renderer.target());
    DeviceTimes out;
    out.index_bytes = std::uint64_t{12} * lean.mesh.slots;
    LR_ASSIGN(const Buffer copy, Buffer::create(context, "copy of the indices", out.index_bytes, 0));
    const auto draw = [&](VkCommandBuffer buffer, const Drawable& drawable) {
        renderer.painter().record(buffer, drawable.mesh, drawable.draw, renderer.target(), Painter::Ties::first_drawn);
    };
    const auto decode = [&](VkCommandBuffer buffer, Drawable& drawable) {
        drawable.mesh.decoded = false;
        renderer.decode(buffer, drawable);
    };
    std::vector<Work> works;
    const auto add = [&](Drawable& stream, DeviceTimes::Stream& times) {
        works.push_back({&times.decode, [&](VkCommandBuffer buffer) { decode(buffer, stream); }});
        works.push_back({&times.draw, [&](VkCommandBuffer buffer) { draw(buffer, stream); }});
        works.push_back({&times.decode_and_draw, [&](VkCommandBuffer buffer) {
                             decode(buffer, stream);
                             draw(buffer, stream);
                         }});
    };
    add(lean, out.lean);
    if (packed) add(*packed, out.packed);
    works.push_back({&out.draw_plain, [&](VkCommandBuffer buffer) { draw(buffer, plain); }});
    works.push_back({&out.copy, [&](VkCommandBuffer buffer) {
                         const VkBufferCopy region{0, 0, out.index_bytes};
                         vkCmdCopyBuffer(buffer, lean.mesh.indices.handle(), copy.handle(), 1, &region);
                     }});
    LR_TRY(run_in_turns(renderer.commands(), options.repeats, works));
    out.device_bytes = context.arena().peak();
    return out;
}

}  // namespace lr::gpu
