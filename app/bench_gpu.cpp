#include "app/bench_gpu.h"

#include "renderer/timing.h"

namespace lr::app {
namespace {

Candidate candidate(const char* name, const gpu::Times& times) {
    Candidate c{name, {}, {}, {}};
    for (const gpu::Elapsed& elapsed : times) {
        c.seconds.push_back(elapsed.wall);
        if (elapsed.gpu) c.gpu_seconds.push_back(*elapsed.gpu);
    }
    return c;
}

}  // namespace

Result<GpuFigures> measure_gpu(const Mesh& mesh, const gpu::ContextOptions& options, int rounds) {
    const Result<gpu::Model> model = gpu::make_model(mesh, {.packed = true});
    if (!model) return model.error();
    const Result<std::unique_ptr<gpu::Context>> context = gpu::Context::create(options);
    if (!context) return context.error();
    gpu::TimingOptions timing;
    timing.repeats = static_cast<std::uint32_t>(rounds);
    const Result<gpu::DeviceTimes> times = gpu::measure_device(**context, *model, timing);
    if (!times) return times.error();
    GpuFigures figures;
    figures.device = (*context)->info().name;
    figures.decode = {candidate("lean", times->lean.decode), candidate("packed", times->packed.decode),
                      candidate("copy", times->copy)};
    figures.draw = {candidate("plain", times->draw_plain), candidate("lean", times->lean.draw),
                    candidate("packed", times->packed.draw),
                    candidate("lean_decode_every_frame", times->lean.decode_and_draw),
                    candidate("packed_decode_every_frame", times->packed.decode_and_draw)};
    figures.device_bytes = times->device_bytes;
    return figures;
}

}  // namespace lr::app
