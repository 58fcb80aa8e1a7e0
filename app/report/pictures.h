#pragma once
// Draws the pictures of a report with the renderer.

#include <memory>
#include <string>

#include "app/cli/command.h"
#include "app/report/data.h"

namespace CLI {
class App;
}  // namespace CLI

namespace lacedring::app {

/// Draws the pictures with the options of the command line. A program built without Vulkan (no_pictures.cpp) draws none
/// and has only the option --no-gpu.
class ReportPictures {
  public:
    ReportPictures();
    ~ReportPictures();

    /// Adds --no-gpu and the options for the device, the size of a picture and the camera.
    void add_options(CLI::App& command);

    struct Device {
        std::string name;  ///< empty: no device, no pictures
        /// Samples per pixel: 9, or fewer if the device's largest image is too small.
        std::uint32_t samples = 0;
        std::string skipped;  ///< why there is no device
    };
    /// Opens the device. That none is found is an error only if an option asks for one. Errors: those of the device.
    Result<Device> open();

    /// Draws three pictures into `report`: the mesh with smooth shading, the ring of lean, and the order along the
    /// ring. If the mesh cannot be drawn, `report.no_pictures` says why. Does nothing without a device. Errors: those
    /// of the device, and an impossible camera.
    Result<void> draw(const LoadedMesh& loaded, const RingChoice& choice, MeshReport& report) const;

    /// Prints the validation messages on standard error; returns their number.
    std::size_t print_messages() const;

  private:
    struct Drawer;
    std::unique_ptr<Drawer> drawer_;
};

}  // namespace lacedring::app
