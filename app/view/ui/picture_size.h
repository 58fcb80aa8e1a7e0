#pragma once
// Size of the picture that is drawn for a window, and its samples: as large as the window where the device allows it.

#include <algorithm>
#include <cstdint>

#include "app/view/scene/scene.h"
#include "app/view/window/overlay.h"

namespace lacedring::view {

class PictureSize {
  public:
    /// The window has this size now. `device_limit`: pixels of the largest image side.
    void set_window(VkExtent2D window, std::uint32_t device_limit);

    VkExtent2D window() const { return window_; }
    /// Pixels of the picture: the window's, or fewer of the same shape.
    VkExtent2D extent() const { return extent_; }
    bool visible() const { return extent_.width != 0 && extent_.height != 0; }
    bool smaller_than_window() const { return extent_.width != window_.width; }
    /// Pixels of the images that were made last.
    VkExtent2D made() const { return made_; }
    /// Samples along each side of a pixel that pictures at rest have where so many are chosen.
    std::uint32_t samples(std::uint32_t chosen) const { return std::min(chosen, samples_); }

    enum class Change { none, samples, size };
    /// Makes images for `sides` pictures (1 or 2) of this size. What the device does not hold has fewer samples, then
    /// it is made smaller, to be scaled up by the window. Errors: device failures; out of memory at 64 pixels.
    Result<Change> make(gpu::Context& context, Scene& scene, Overlay& overlay, std::uint32_t samples, int sides);

  private:
    void fit();

    VkExtent2D window_{}, extent_{}, made_{};
    // Less than the device's limits where its memory does not hold that: side of a picture, samples of a pixel.
    std::uint32_t largest_ = 0, most_samples_ = 3;
    std::uint32_t samples_ = 1;
    int sides_ = 0;
};

}  // namespace lacedring::view
