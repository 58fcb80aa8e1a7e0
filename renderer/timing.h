#pragma once
// How long the device takes. For `lacedring bench`.

#include <vector>

#include "renderer/commands.h"
#include "renderer/context.h"
#include "renderer/model.h"

namespace lr::gpu {

/// One entry a repetition, after one that is not counted.
using Times = std::vector<Elapsed>;

struct TimingOptions {
    std::uint32_t repeats = 5;
    std::uint32_t width = 1280;
    std::uint32_t height = 720;
};

struct DeviceTimes {
    /// Of one stream.
    struct Stream {
        Times decode;           ///< to index buffer and draw commands
        Times draw;             ///< indexed indirect, decoded before
        Times decode_and_draw;  ///< both, each time
    };
    Stream lean;
    Stream packed;                   ///< empty where the model has none
    Times copy;                      ///< vkCmdCopyBuffer of lean's index buffer. Trust its wall time only on lavapipe
    Times draw_plain;                ///< indexed, the mesh's own order
    std::uint64_t index_bytes = 0;   ///< of lean's index buffer
    std::uint64_t device_bytes = 0;  ///< device memory held at most
};

/// Pictures are drawn in one pass with smooth normals, from the default camera, and not read back.
/// Every repetition is one submission, waited for; all kinds take turns.
Result<DeviceTimes> measure_device(Context& context, const Model& model, const TimingOptions& options = {});

}  // namespace lr::gpu
