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

/// One entry per repetition. A first repetition is run, but not counted.
using Times = std::vector<gpu::Elapsed>;

struct TimingOptions {
    std::uint32_t repeats = 5;
    std::uint32_t width = 1280;
    std::uint32_t height = 720;
    /// Called after each submission, outside the timed part.
    std::function<void(std::uint32_t done, std::uint32_t total)> progress = {};
};

/// One way to draw the model.
struct Way {
    std::string name;  ///< "plain", "plain_best_order", "lean", "lean_pull", "packed_mesh", ...
    gpu::Source source = gpu::Source::plain;
    gpu::Path path = gpu::Path::compute;
    Times draw;  ///< without decoding
    /// Decoding to index buffer, draw commands and vertices; only for streams by Path::compute.
    Times decode;
    /// Decoding and drawing in one submission; only for streams by Path::compute.
    Times decode_and_draw;
    /// Connectivity that must stay on the device to draw again: index buffer or stream.
    std::uint64_t connectivity_bytes = 0;
    /// Bytes of connectivity read for one picture, by shaders or as indices.
    std::uint64_t bytes_read = 0;
    /// Vertex shader runs for one picture, if the device counts them; empty for Path::mesh.
    std::optional<std::uint64_t> vertex_invocations;
};

struct DeviceTimes {
    std::vector<Way> ways;
    /// Decoding only the vertex stream of Source::packed_vertices.
    Times vertices;
    /// vkCmdCopyBuffer of lean's index buffer. Its wall time is meaningful only on lavapipe.
    Times copy;
    std::uint64_t index_bytes = 0;                            ///< of lean's index buffer
    std::uint64_t device_bytes = 0;                           ///< peak of device memory
    std::vector<std::pair<std::string, std::string>> absent;  ///< name of a missing way, reason
};

/// Measures every source and path that the model and the device have, and the index list in meshoptimizer's best order
/// for the vertex cache with vertices in order of use (absent if that order takes too long to compute). Pictures are
/// drawn in one pass with smooth normals and the default camera, and not read back. Each repetition is one submission
/// that is waited for; the kinds of work take turns. All ways are in device memory at the same time.
Result<DeviceTimes> measure_device(gpu::Context& context, const gpu::Model& model, const TimingOptions& options = {});

}  // namespace lacedring::app
