#pragma once
// The part of bench that needs a device: times and memory on it.

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

/// Costs of a way of drawing besides its times: see Way.
struct DrawCost {
    std::uint64_t connectivity_bytes = 0;
    std::uint64_t bytes_read = 0;
    std::optional<std::uint64_t> vertex_invocations;
};

struct GpuFigures {
    std::string device;
    std::vector<Candidate> decode;  ///< named after the streams, "vertices", "copy"
    /// Named as Way::name, and "lean_decode_every_frame", "packed_decode_every_frame".
    std::vector<Candidate> draw;
    std::vector<DrawCost> cost;  ///< one per entry of `draw`
    std::uint64_t device_bytes = 0;
    std::vector<std::pair<std::string, std::string>> absent;  ///< name of a missing way, reason
    std::size_t validation_messages = 0;                      ///< printed on standard error
};

/// Measures on the device that the command line chooses. A program built without Vulkan (no_gpu.cpp) has neither a
/// device nor these options.
class GpuBench {
  public:
    GpuBench();
    ~GpuBench();

    /// Adds --no-gpu and the options for the device.
    void add_options(CLI::App& command);

    /// Measures the streams with the optimizer's ring. Empty without a device: then `skipped` says why. Errors: those
    /// of the renderer; a missing device, if an option asks for one.
    Result<std::optional<GpuFigures>> measure(const LoadedMesh& mesh, const VertexOptions& vertices, int rounds,
                                              std::string& skipped) const;

  private:
    struct Options;
    std::unique_ptr<Options> options_;
};

}  // namespace lacedring::app
