#include "renderer/vk/image.h"

#include <utility>

#include "renderer/vk/context.h"
#include "renderer/vk/device_error.h"
#include "renderer/vk/try.h"

namespace lacedring::gpu {

Result<Image> Image::create(Context& context, const std::string& name, VkExtent2D extent, VkFormat format,
                            VkImageUsageFlags usage) {
    const std::uint32_t limit = context.limits().maxImageDimension2D;
    if (extent.width == 0 || extent.height == 0) return Error{ErrorCode::invalid_argument, "an image of no size"};
    if (extent.width > limit || extent.height > limit) {
        return Error{kNoDevice, std::to_string(extent.width) + "x" + std::to_string(extent.height) +
                                    " pixels; the device draws at most " + std::to_string(limit) + " a side"};
    }
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {extent.width, extent.height, 1};
    info.mipLevels = 1;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = usage;
    info.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
    info.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    VkImage image = VK_NULL_HANDLE;
    LR_TRY_VK(vkCreateImage(context.device(), &info, nullptr, &image));
    VkMemoryRequirements requirements{};
    vkGetImageMemoryRequirements(context.device(), image, &requirements);
    auto allocation = context.arena().allocate(requirements, Memory::gpu, Tiling::image);
    if (!allocation) {
        vkDestroyImage(context.device(), image, nullptr);
        return Error{allocation.error().code, name + ": " + allocation.error().message};
    }
    Image out;
    out.context_ = &context;
    out.image_ = image;
    out.format_ = format;
    out.allocation_ = *allocation;
    LR_TRY_VK(vkBindImageMemory(context.device(), image, allocation->memory, allocation->offset));
    VkImageViewCreateInfo view{};
    view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    view.image = image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format;
    view.subresourceRange = {out.aspect(), 0, 1, 0, 1};
    LR_TRY_VK(vkCreateImageView(context.device(), &view, nullptr, &out.view_));
    context.name(VK_OBJECT_TYPE_IMAGE, image, name);
    context.name(VK_OBJECT_TYPE_IMAGE_VIEW, out.view_, name);
    return out;
}

VkImageAspectFlags Image::aspect() const {
    return format_ == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

Image::Image(Image&& other) noexcept
    : context_(other.context_),
      image_(std::exchange(other.image_, VK_NULL_HANDLE)),
      view_(std::exchange(other.view_, VK_NULL_HANDLE)),
      format_(other.format_),
      allocation_(other.allocation_) {}

Image& Image::operator=(Image&& other) noexcept {
    if (this != &other) {
        reset();
        context_ = other.context_;
        image_ = std::exchange(other.image_, VK_NULL_HANDLE);
        view_ = std::exchange(other.view_, VK_NULL_HANDLE);
        format_ = other.format_;
        allocation_ = other.allocation_;
    }
    return *this;
}

Image::~Image() {
    reset();
}

void Image::reset() {
    if (image_ == VK_NULL_HANDLE) return;
    if (view_ != VK_NULL_HANDLE) vkDestroyImageView(context_->device(), view_, nullptr);
    vkDestroyImage(context_->device(), image_, nullptr);
    context_->arena().free(allocation_);
    image_ = VK_NULL_HANDLE;
    view_ = VK_NULL_HANDLE;
}

}  // namespace lacedring::gpu
