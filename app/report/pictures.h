#pragma once
// The pictures of a report, by the renderer.

#include "app/cli/gpu_options.h"
#include "app/report/data.h"
#include "renderer/draw/camera.h"

namespace lacedring::app {

/// Samples a pixel along each side: as many as `render` takes, fewer where the device's images are not large enough.
std::uint32_t report_samples(const gpu::Context& context, const PictureSize& size);

/// Draws the mesh smooth, with the ring of lean, and in ring order, into `report`. Where the mesh cannot be drawn,
/// `report.no_pictures` says why. Errors: of the device, and of a camera
/// that cannot be.
Result<void> draw_pictures(gpu::Context& context, const PictureSize& size, const gpu::CameraOptions& camera,
                           const LoadedMesh& loaded, const RingChoice& choice, MeshReport& report);

}  // namespace lacedring::app
