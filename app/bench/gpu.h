#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/bench/measure.h"
#include "app/cli/input.h"
#include "lacedring/base.hpp"
#include "lacedring/vertices.hpp"
#include "renderer/vk/context.h"

namespace lacedring::app {

/// A way of drawing, beside its times: see Way.
struct DrawCost {
    std::uint64_t connectivity_bytes = 0;
    std::uint64_t bytes_read = 0;
    std::optional<std::uint64_t> vertex_invocations;
};

struct GpuFigures {
    std::string device;
    std::vector<Candidate> decode;  ///< the streams' names, "vertices", "copy": wall and GPU seconds
    std::vector<Candidate> draw;    ///< Way's names, and "lean_decode_every_frame", "packed_decode_every_frame"
    std::vector<DrawCost> cost;     ///< of each of `draw`
    std::uint64_t device_bytes = 0;
    std::vector<std::pair<std::string, std::string>> absent;  ///< name of a missing way, reason
    std::size_t validation_messages = 0;                      ///< printed on standard error
};

/// With the streams that the program recommends, optimised. Errors: kNoDevice, and those of the renderer.
Result<GpuFigures> measure_gpu(const LoadedMesh& mesh, const VertexOptions& vertices,
                               const gpu::ContextOptions& options, int rounds);

}  // namespace lacedring::app
