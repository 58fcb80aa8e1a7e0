#pragma once
// Shows an image in a window, on a surface that the application made.

#include <vulkan/vulkan.h>

#include <vector>

#include "lacedring/base.hpp"
#include "renderer/vk/handle.h"

namespace lacedring::gpu {

class Context;
class Image;

/// Needs VK_KHR_surface and VK_KHR_swapchain. Does not own the surface, and must be destroyed before it.
class Swapchain {
  public:
    /// Errors: kNoDevice (the device's queue cannot show on that surface), kDeviceFailure.
    static Result<Swapchain> create(Context& context, VkSurfaceKHR surface);
    Swapchain(Swapchain&& other) noexcept;
    Swapchain& operator=(Swapchain&&) = delete;
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;
    ~Swapchain();

    /// Scales an image of `extent` pixels to the window's `window` pixels and shows it. The image must be in
    /// VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, written by earlier submissions; the next submission must wait for reads of
    /// it (Commands::begin does). Recreates the swapchain if the window has changed. Shows nothing if the window has no
    /// size or no free image. If the window is larger than the device's largest image: shows nothing, returns false.
    Result<bool> show(const Image& image, VkExtent2D extent, VkExtent2D window);

  private:
    Swapchain() = default;
    enum class Fit { shown, no_size, too_large };  ///< whether the device can show the window
    Result<Fit> rebuild();
    void drop();
    void record(VkImage to, const Image& image, VkExtent2D extent) const;

    Context* context_ = nullptr;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkSurfaceFormatKHR format_{};
    VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
    VkExtent2D window_{};  // the window's size when the images were created
    VkExtent2D extent_{};  // of the images
    std::vector<VkImage> images_;
    std::vector<SemaphoreHandle> drawn_;  // one per image, as every image may be waiting for presentation
    SemaphoreHandle acquired_;
    CommandPoolHandle pool_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    FenceHandle fence_;
};

}  // namespace lacedring::gpu
