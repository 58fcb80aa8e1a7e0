// GpuBench of a program built without Vulkan: no device.

#include "app/bench/gpu.h"

namespace lacedring::app {

struct GpuBench::Options {};

GpuBench::GpuBench() = default;
GpuBench::~GpuBench() = default;

void GpuBench::add_options(CLI::App&) {}

Result<std::optional<GpuFigures>> GpuBench::measure(const LoadedMesh&, const VertexOptions&, int,
                                                    std::string& skipped) const {
    skipped = "built without Vulkan";
    return std::optional<GpuFigures>();
}

}  // namespace lacedring::app
