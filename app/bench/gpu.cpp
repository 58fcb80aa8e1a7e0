#include "app/bench/gpu.h"

#include <CLI/CLI.hpp>

#include "app/bench/device_times.h"
#include "app/cli/gpu_options.h"
#include "app/cli/progress.h"
#include "renderer/vk/device_error.h"

namespace lacedring::app {
namespace {

Candidate candidate(std::string name, const Times& times) {
    Candidate c{std::move(name), {}, {}, {}};
    for (const gpu::Elapsed& elapsed : times) {
        c.seconds.push_back(elapsed.wall);
        if (elapsed.gpu) c.gpu_seconds.push_back(*elapsed.gpu);
    }
    return c;
}

Result<GpuFigures> measure_gpu(const LoadedMesh& mesh, const VertexOptions& vertices,
                               const gpu::ContextOptions& options, int rounds) {
    OptimizeOptions optimize;
    optimize.progress = progress_bar("optimizing the ring", optimize.passes);
    const Result<gpu::Model> model = gpu::make_model(
        mesh.mesh, {.packed = true, .vertices = vertices, .optimize = std::move(optimize), .surface = mesh.surface});
    if (!model) return model.error();
    const Result<std::unique_ptr<gpu::Context>> context = gpu::Context::create(options);
    if (!context) return context.error();
    TimingOptions timing;
    timing.repeats = static_cast<std::uint32_t>(rounds);
    const Result<DeviceTimes> times = [&] {
        std::optional<ProgressBar> bar;
        timing.progress = [&bar](std::uint32_t done, std::uint32_t total) {
            if (!bar) bar.emplace("drawing", total);
            bar->show(done);
        };
        return measure_device(**context, *model, timing);
    }();
    GpuFigures figures;
    figures.validation_messages = print_validation(**context);
    if (!times) return times.error();
    figures.device = (*context)->info().name;
    for (const Way& way : times->ways) {
        figures.draw.push_back(candidate(way.name, way.draw));
        figures.cost.push_back({way.connectivity_bytes, way.bytes_read, way.vertex_invocations});
        if (way.decode.empty()) continue;
        figures.decode.push_back(candidate(way.name, way.decode));
        const std::uint64_t stream = gpu::connectivity_bytes(*model, way.source);
        figures.draw.push_back(candidate(way.name + "_decode_every_frame", way.decode_and_draw));
        figures.cost.push_back({way.connectivity_bytes + stream, way.bytes_read + stream, way.vertex_invocations});
    }
    figures.decode.push_back(candidate("vertices", times->vertices));
    figures.decode.back().vertices = true;
    figures.decode.push_back(candidate("copy", times->copy));
    figures.device_bytes = times->device_bytes;
    figures.absent = times->absent;
    return figures;
}

}  // namespace

struct GpuBench::Options {
    bool off = false;
    gpu::ContextOptions context;
};

GpuBench::GpuBench() : options_(std::make_unique<Options>()) {}
GpuBench::~GpuBench() = default;

void GpuBench::add_options(CLI::App& command) {
    command.add_flag("--no-gpu", options_->off, "measure nothing on the GPU");
    add_device_options(command, options_->context);
}

Result<std::optional<GpuFigures>> GpuBench::measure(const LoadedMesh& mesh, const VertexOptions& vertices, int rounds,
                                                    std::string& skipped) const {
    if (options_->off) {
        skipped = "--no-gpu";
        return std::optional<GpuFigures>();
    }
    Result<GpuFigures> figures = measure_gpu(mesh, vertices, options_->context, rounds);
    if (figures) return std::optional(std::move(*figures));
    if (figures.error().code != gpu::kNoDevice || asks_for_device(options_->context)) return figures.error();
    skipped = figures.error().message;
    return std::optional<GpuFigures>();
}

}  // namespace lacedring::app
