#pragma once
// A window's pictures: shows an image of ours on a surface that the application made.

#include <vulkan/vulkan.h>

#include <vector>

#include "lacedring/base.hpp"
#include "renderer/vk/handle.h"

namespace lacedring::gpu {

class Context;
class Image;

/// Needs VK_KHR_surface and VK_KHR_swapchain. Goes before the surface, which it does not own.
class Swapchain {
  public:
    /// Errors: kNoDevice (the device's queue cannot show on that surface), kDeviceFailure.
    static Result<Swapchain> create(Context& context, VkSurfaceKHR surface);
    Swapchain(Swapchain&& other) noexcept;
    Swapchain& operator=(Swapchain&&) = delete;
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;
    ~Swapchain();

    /// Scales an image of `extent` pixels to the window, `window` pixels, and shows it. The image must be in
    /// VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, written by earlier submissions; the next one must wait for reads of it
    /// (Commands::begin does). A window that changed gets new images first. Where the window has no size, or keeps all
    /// its images, nothing is shown. False: the window is larger than any image of the device, and shows nothing.
    Result<bool> show(const Image& image, VkExtent2D extent, VkExtent2D window);

  private:
    Swapchain() = default;
    enum class Fit { shown, no_size, too_large };  ///< what a window is to the device
    Result<Fit> rebuild();
    void drop();
    void record(VkImage to, const Image& image, VkExtent2D extent) const;

    Context* context_ = nullptr;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkSurfaceFormatKHR format_{};
    VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
    VkExtent2D window_{};  // as it was when the images were made
    VkExtent2D extent_{};  // of the images
    std::vector<VkImage> images_;
    std::vector<SemaphoreHandle> drawn_;  // one an image: that many may wait to be shown
    SemaphoreHandle acquired_;
    CommandPoolHandle pool_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    FenceHandle fence_;
};

}  // namespace lacedring::gpu
