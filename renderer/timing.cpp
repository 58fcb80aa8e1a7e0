#include "renderer/timing.h"

#include "renderer/renderer.h"
#include "renderer/try.h"

namespace lr::gpu {
namespace {

/// Runs what `record` records, between timestamps. The first run is not counted: pages are touched, shaders compiled.
template <class Record>
Result<Times> repeat(Commands& commands, std::uint32_t repeats, const Record& record) {
    Times times;
    for (std::uint32_t i = 0; i <= repeats; ++i) {
        LR_ASSIGN(const VkCommandBuffer buffer, commands.begin());
        commands.start_timer();
        record(buffer);
        commands.stop_timer();
        LR_ASSIGN(const Elapsed elapsed, commands.run());
        if (i != 0) times.push_back(elapsed);
    }
    return times;
}

}  // namespace

Result<DeviceTimes> measure_device(Context& context, const Model& model, const TimingOptions& options) {
    RendererOptions renderer_options;
    renderer_options.width = options.width;
    renderer_options.height = options.height;
    LR_ASSIGN(Renderer renderer, Renderer::create(context, renderer_options));
    LR_ASSIGN(Drawable plain, renderer.upload(model, Source::plain));
    LR_ASSIGN(Drawable lean, renderer.upload(model, Source::lean));
    LR_ASSIGN(const Camera camera, make_camera(model, {}, options.width, options.height));
    renderer.painter().set_frame(model, camera);
    Commands& commands = renderer.commands();
    const auto decode = [&](VkCommandBuffer buffer) {
        lean.mesh.decoded = false;
        renderer.decode(buffer, lean);
    };
    const auto draw = [&](VkCommandBuffer buffer, const Drawable& drawable) {
        renderer.painter().record(buffer, drawable.mesh, drawable.draw, renderer.target(), Painter::Ties::first_drawn);
    };
    DeviceTimes out;
    out.index_bytes = std::uint64_t{12} * lean.mesh.slots;
    LR_ASSIGN(out.decode, repeat(commands, options.repeats, decode));
    LR_ASSIGN(out.draw_plain, repeat(commands, options.repeats, [&](VkCommandBuffer buffer) { draw(buffer, plain); }));
    LR_ASSIGN(out.draw_lean, repeat(commands, options.repeats, [&](VkCommandBuffer buffer) { draw(buffer, lean); }));
    LR_ASSIGN(out.decode_and_draw, repeat(commands, options.repeats, [&](VkCommandBuffer buffer) {
                  decode(buffer);
                  draw(buffer, lean);
              }));
    LR_ASSIGN(const Buffer copy, Buffer::create(context, "copy of the indices", out.index_bytes, 0));
    LR_ASSIGN(out.copy, repeat(commands, options.repeats, [&](VkCommandBuffer buffer) {
                  const VkBufferCopy region{0, 0, out.index_bytes};
                  vkCmdCopyBuffer(buffer, lean.mesh.indices.handle(), copy.handle(), 1, &region);
              }));
    out.device_bytes = context.arena().peak();
    return out;
}

}  // namespace lr::gpu
