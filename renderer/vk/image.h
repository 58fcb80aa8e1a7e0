#pragma once
#include <vulkan/vulkan.h>

#include <string>

#include "lacedring/base.hpp"
#include "renderer/vk/arena.h"

namespace lacedring::gpu {

class Context;

/// A two-dimensional image with one level, its view and its memory.
class Image {
  public:
    Image() = default;
    /// Errors: kNoDevice (past maxImageDimension2D, or out of memory), kDeviceFailure.
    static Result<Image> create(Context& context, const std::string& name, VkExtent2D extent, VkFormat format,
                                VkImageUsageFlags usage);
    Image(Image&& other) noexcept;
    Image& operator=(Image&& other) noexcept;
    Image(const Image&) = delete;
    Image& operator=(const Image&) = delete;
    ~Image();

    VkImage handle() const { return image_; }
    VkImageView view() const { return view_; }
    VkFormat format() const { return format_; }
    VkImageAspectFlags aspect() const;

  private:
    void reset();

    Context* context_ = nullptr;
    VkImage image_ = VK_NULL_HANDLE;
    VkImageView view_ = VK_NULL_HANDLE;
    VkFormat format_ = VK_FORMAT_UNDEFINED;
    Allocation allocation_;
};

}  // namespace lacedring::gpu
