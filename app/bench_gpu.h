#pragma once
#include <vector>

#include "app/measure.h"
#include "lrcore/base/result.h"
#include "lrcore/mesh/mesh.h"
#include "renderer/context.h"

namespace lr::app {

struct GpuFigures {
    std::string device;
    std::vector<Candidate> decode;  ///< "lean", "packed", "copy": wall and GPU seconds
    std::vector<Candidate> draw;    ///< "plain", and "lean", "packed", also with "_decode_every_frame"
    std::uint64_t device_bytes = 0;
};

/// Errors: no_device, and those of the renderer.
Result<GpuFigures> measure_gpu(const Mesh& mesh, const gpu::ContextOptions& options, int rounds);

}  // namespace lr::app
