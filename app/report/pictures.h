#pragma once
// The pictures of a report, by the renderer.

#include <memory>
#include <string>

#include "app/cli/command.h"
#include "app/report/data.h"

namespace CLI {
class App;
}  // namespace CLI

namespace lacedring::app {

/// Draws the pictures, as the command line asks for them. A program that was built without Vulkan (no_pictures.cpp)
/// draws none, and has no options for them.
class ReportPictures {
  public:
    ReportPictures();
    ~ReportPictures();

    /// --no-gpu, and those of a device, a picture and a camera.
    void add_options(CLI::App& command);

    struct Device {
        std::string name;           ///< empty: there is none
        std::uint32_t samples = 0;  ///< a pixel: as many as `render` takes, fewer where images are not large enough
        std::string skipped;        ///< why there is none
    };
    /// Errors: those of a device that was asked for.
    Result<Device> open();

    /// Draws the mesh smooth, with the ring of lean, and in ring order, into `report`. Where the mesh cannot be drawn,
    /// `report.no_pictures` says why. Nothing without a device. Errors: of the device, and of a camera that cannot be.
    Result<void> draw(const LoadedMesh& loaded, const RingChoice& choice, MeshReport& report) const;

    /// Prints the validation messages on standard error, if there are any. Returns how many.
    std::size_t print_messages() const;

  private:
    struct Drawer;
    std::unique_ptr<Drawer> drawer_;
};

}  // namespace lacedring::app
