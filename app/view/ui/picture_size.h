#pragma once
// Chooses size and samples of the picture that is drawn for a window: the window's size if the device allows it.

#include <algorithm>
#include <cstdint>

#include "app/view/scene/scene.h"
#include "app/view/window/overlay.h"

namespace lacedring::view {

class PictureSize {
  public:
    /// Sets the window's size. `device_limit`: the largest side of an image in pixels.
    void set_window(VkExtent2D window, std::uint32_t device_limit);

    VkExtent2D window() const { return window_; }
    /// Size of the picture: the window's, or smaller with the same aspect ratio.
    VkExtent2D extent() const { return extent_; }
    bool visible() const { return extent_.width != 0 && extent_.height != 0; }
    bool smaller_than_window() const { return extent_.width != window_.width; }
    /// Size of the images that were made last.
    VkExtent2D made() const { return made_; }
    /// Samples along each side of a pixel for pictures at rest: `chosen`, or fewer if the device has no room.
    std::uint32_t samples(std::uint32_t chosen) const { return std::min(chosen, samples_); }

    enum class Change { none, samples, size };
    /// Makes images for `sides` pictures (1 or 2). If the device's memory is too small, takes fewer samples, then a
    /// smaller size, which the window scales up. Errors: device failures; out of memory even at 64 pixels.
    Result<Change> make(gpu::Context& context, Scene& scene, Overlay& overlay, std::uint32_t samples, int sides);

  private:
    void fit();

    VkExtent2D window_{}, extent_{}, made_{};
    // Largest side of a picture, and most samples: the device's limits, or less if its memory is too small.
    std::uint32_t largest_ = 0, most_samples_ = 3;
    std::uint32_t samples_ = 1;
    int sides_ = 0;
};

}  // namespace lacedring::view
