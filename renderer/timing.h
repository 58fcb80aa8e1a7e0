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
    Times decode;           ///< lean stream -> index buffer and draw command
    Times copy;             ///< vkCmdCopyBuffer of an index buffer of that size. Trust its wall time only on lavapipe
    Times draw_plain;       ///< indexed, the mesh's own order
    Times draw_lean;        ///< indexed indirect, decoded before
    Times decode_and_draw;  ///< both, each time
    std::uint64_t index_bytes = 0;   ///< of the index buffer that is decoded and copied
    std::uint64_t device_bytes = 0;  ///< device memory held at most
};

/// Pictures are drawn in one pass with smooth normals, from the default camera, and not read back.
/// Every repetition is one submission, waited for.
Result<DeviceTimes> measure_device(Context& context, const Model& model, const TimingOptions& options = {});

}  // namespace lr::gpu
