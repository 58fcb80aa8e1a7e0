#pragma once
// The part of bench that needs a device: its times and its memory.

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/bench/measure.h"
#include "app/cli/input.h"
#include "lacedring/base.hpp"
#include "lacedring/vertices.hpp"

namespace CLI {
class App;
}  // namespace CLI

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

/// The device, as the command line asks for it. A program that was built without Vulkan (no_gpu.cpp) has none, nor
/// options for it.
class GpuBench {
  public:
    GpuBench();
    ~GpuBench();

    /// --no-gpu, and those of a device.
    void add_options(CLI::App& command);

    /// With the streams that the program recommends, optimized. Nothing where there shall or can be no device: then
    /// `skipped` says why. Errors: those of the renderer, and of a device that was asked for.
    Result<std::optional<GpuFigures>> measure(const LoadedMesh& mesh, const VertexOptions& vertices, int rounds,
                                              std::string& skipped) const;

  private:
    struct Options;
    std::unique_ptr<Options> options_;
};

}  // namespace lacedring::app
