#pragma once
// Measures decoding and drawing on the device, for tests and bench.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/mesh/gpu_mesh.h"
#include "renderer/mesh/model.h"
#include "renderer/vk/commands.h"
#include "renderer/vk/context.h"

namespace lacedring::app {

/// One entry a repetition, after one that is not counted.
using Times = std::vector<gpu::Elapsed>;

struct TimingOptions {
    std::uint32_t repeats = 5;
    std::uint32_t width = 1280;
    std::uint32_t height = 720;
    /// Told after each submission, outside the times, how many of how many are done.
    std::function<void(std::uint32_t done, std::uint32_t total)> progress = {};
};

/// One way to draw the model.
struct Way {
    std::string name;  ///< "plain", "plain_best_order", "lean", "lean_pull", "packed_mesh", ...
    gpu::Source source = gpu::Source::plain;
    gpu::Path path = gpu::Path::compute;
    Times draw;             ///< of Path::compute: decoded before
    Times decode;           ///< to index buffer and draw commands, and vertices. Path::compute of a stream only, as is
                            ///< the next
    Times decode_and_draw;  ///< both, each time
    std::uint64_t connectivity_bytes =
        0;                         ///< that must stay on the device to draw again: index buffer, or stream, or both
    std::uint64_t bytes_read = 0;  ///< of these, by shaders or as indices, for one picture
    /// Vertex shader runs for one picture, where the device counts them; not of Path::mesh.
    std::optional<std::uint64_t> vertex_invocations;
};

struct DeviceTimes {
    std::vector<Way> ways;
    Times vertices;                  ///< decoding of Source::packed_vertices' vertex stream alone
    Times copy;                      ///< vkCmdCopyBuffer of lean's index buffer. Trust its wall time only on lavapipe
    std::uint64_t index_bytes = 0;   ///< of lean's index buffer
    std::uint64_t device_bytes = 0;  ///< device memory held at most
    std::vector<std::pair<std::string, std::string>> absent;  ///< name of a missing way, reason
};

/// Every source and path that model and device have, and the index list again in the order that meshoptimizer thinks
/// best for the vertex cache, vertices in the order of their use (absent where that order takes too long). Pictures are
/// drawn in one pass with smooth normals, from the default camera, and not read back. Every repetition is one
/// submission, waited for; all kinds take turns. Device memory: all of them at the same time.
Result<DeviceTimes> measure_device(gpu::Context& context, const gpu::Model& model, const TimingOptions& options = {});

}  // namespace lacedring::app
