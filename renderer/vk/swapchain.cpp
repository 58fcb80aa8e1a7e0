#include "renderer/vk/swapchain.h"

#include <algorithm>
#include <array>
#include <utility>

#include "renderer/vk/commands.h"
#include "renderer/vk/context.h"
#include "renderer/vk/device_error.h"
#include "renderer/vk/image.h"
#include "renderer/vk/try.h"

namespace lacedring::gpu {
namespace {

Result<SemaphoreHandle> create_semaphore(Context& context) {
    VkSemaphoreCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
    VkSemaphore semaphore = VK_NULL_HANDLE;
    LR_TRY_VK(vkCreateSemaphore(context.device(), &info, nullptr, &semaphore));
    return SemaphoreHandle(context.device(), semaphore);
}

/// Chooses 8 bits per channel without sRGB conversion, as our colors are sRGB already.
Result<VkSurfaceFormatKHR> choose_format(Context& context, VkSurfaceKHR surface) {
    std::uint32_t count = 0;
    LR_TRY_VK(vkGetPhysicalDeviceSurfaceFormatsKHR(context.physical(), surface, &count, nullptr));
    std::vector<VkSurfaceFormatKHR> formats(count);
    LR_TRY_VK(vkGetPhysicalDeviceSurfaceFormatsKHR(context.physical(), surface, &count, formats.data()));
    for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM}) {
        for (const VkSurfaceFormatKHR& format : formats) {
            if (format.format == wanted && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) return format;
        }
    }
    return Error{kNoDevice, "the window takes no pictures of 8 bits a channel"};
}

}  // namespace

Result<Swapchain> Swapchain::create(Context& context, VkSurfaceKHR surface) {
    VkBool32 supported = VK_FALSE;
    LR_TRY_VK(vkGetPhysicalDeviceSurfaceSupportKHR(context.physical(), context.queue_family(), surface, &supported));
    if (supported == VK_FALSE) {
        return Error{kNoDevice, context.info().name + " cannot show pictures in this window"};
    }
    Swapchain out;
    out.context_ = &context;
    out.surface_ = surface;
    LR_ASSIGN(out.format_, choose_format(context, surface));
    LR_ASSIGN(out.acquired_, create_semaphore(context));
    VkCommandPoolCreateInfo pool_info{};
    pool_info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool_info.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    pool_info.queueFamilyIndex = context.queue_family();
    VkCommandPool pool = VK_NULL_HANDLE;
    LR_TRY_VK(vkCreateCommandPool(context.device(), &pool_info, nullptr, &pool));
    out.pool_ = {context.device(), pool};
    VkCommandBufferAllocateInfo buffer_info{};
    buffer_info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    buffer_info.commandPool = pool;
    buffer_info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    buffer_info.commandBufferCount = 1;
    LR_TRY_VK(vkAllocateCommandBuffers(context.device(), &buffer_info, &out.commands_));
    VkFenceCreateInfo fence_info{};
    fence_info.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    fence_info.flags = VK_FENCE_CREATE_SIGNALED_BIT;
    VkFence fence = VK_NULL_HANDLE;
    LR_TRY_VK(vkCreateFence(context.device(), &fence_info, nullptr, &fence));
    out.fence_ = {context.device(), fence};
    return out;
}

Swapchain::Swapchain(Swapchain&& other) noexcept
    : context_(other.context_),
      surface_(other.surface_),
      format_(other.format_),
      swapchain_(std::exchange(other.swapchain_, VK_NULL_HANDLE)),
      window_(other.window_),
      extent_(other.extent_),
      images_(std::move(other.images_)),
      drawn_(std::move(other.drawn_)),
      acquired_(std::move(other.acquired_)),
      pool_(std::move(other.pool_)),
      commands_(other.commands_),
      fence_(std::move(other.fence_)) {}

Swapchain::~Swapchain() {
    if (pool_) context_->wait_idle();
    drop();
}

void Swapchain::drop() {
    if (swapchain_ != VK_NULL_HANDLE) vkDestroySwapchainKHR(context_->device(), swapchain_, nullptr);
    swapchain_ = VK_NULL_HANDLE;
}

Result<Swapchain::Fit> Swapchain::rebuild() {
    context_->wait_idle();
    VkSurfaceCapabilitiesKHR surface{};
    LR_TRY_VK(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(context_->physical(), surface_, &surface));
    VkExtent2D extent = surface.currentExtent;
    const std::uint32_t limit = context_->limits().maxImageDimension2D;
    if (extent.width == UINT32_MAX) {  // the window takes its size from the images
        const auto fitting = [&](std::uint32_t wanted, std::uint32_t least, std::uint32_t most) {
            return std::max(least, std::min({wanted, most, limit}));
        };
        extent = {fitting(window_.width, surface.minImageExtent.width, surface.maxImageExtent.width),
                  fitting(window_.height, surface.minImageExtent.height, surface.maxImageExtent.height)};
    }
    if (extent.width == 0 || extent.height == 0) {
        drop();
        return Fit::no_size;
    }
    if (extent.width > limit || extent.height > limit) {
        drop();
        return Fit::too_large;
    }
    VkSwapchainCreateInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR;
    info.surface = surface_;
    info.minImageCount = surface.minImageCount + 1;
    if (surface.maxImageCount != 0) info.minImageCount = std::min(info.minImageCount, surface.maxImageCount);
    info.imageFormat = format_.format;
    info.imageColorSpace = format_.colorSpace;
    info.imageExtent = extent;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.imageSharingMode = VK_SHARING_MODE_EXCLUSIVE;
    info.preTransform = surface.currentTransform;
    info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;  // every device has it
    info.clipped = VK_TRUE;
    info.oldSwapchain = swapchain_;
    VkSwapchainKHR made = VK_NULL_HANDLE;
    const VkResult result = vkCreateSwapchainKHR(context_->device(), &info, nullptr, &made);
    drop();
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY) return Fit::too_large;
    LR_TRY(check(result, "vkCreateSwapchainKHR"));
    swapchain_ = made;
    extent_ = extent;
    std::uint32_t count = 0;
    LR_TRY_VK(vkGetSwapchainImagesKHR(context_->device(), swapchain_, &count, nullptr));
    images_.resize(count);
    LR_TRY_VK(vkGetSwapchainImagesKHR(context_->device(), swapchain_, &count, images_.data()));
    drawn_.clear();
    for (std::uint32_t i = 0; i < count; ++i) {
        LR_ASSIGN(SemaphoreHandle semaphore, create_semaphore(*context_));
        drawn_.push_back(std::move(semaphore));
    }
    return Fit::shown;
}

void Swapchain::record(VkImage to, const Image& image, VkExtent2D extent) const {
    constexpr VkImageAspectFlags kColor = VK_IMAGE_ASPECT_COLOR_BIT;
    constexpr Access kBlit{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
    // Drops the image's contents. The submission waits for the acquired image in the transfer stage.
    image_barrier(commands_, to, kColor, {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_NONE}, kBlit,
                  VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    VkImageBlit region{};
    region.srcSubresource = {kColor, 0, 0, 1};
    region.srcOffsets[1] = {static_cast<std::int32_t>(extent.width), static_cast<std::int32_t>(extent.height), 1};
    region.dstSubresource = {kColor, 0, 0, 1};
    region.dstOffsets[1] = {static_cast<std::int32_t>(extent_.width), static_cast<std::int32_t>(extent_.height), 1};
    const bool same = extent.width == extent_.width && extent.height == extent_.height;
    vkCmdBlitImage(commands_, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, same ? VK_FILTER_NEAREST : VK_FILTER_LINEAR);
    image_barrier(commands_, to, kColor, kBlit, {VK_PIPELINE_STAGE_2_NONE, VK_ACCESS_2_NONE},
                  VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
}

// The window system may hold all images (locked screen, hidden window): waiting for one must not stop the program.
constexpr std::uint64_t kPatience = 200'000'000;  // nanoseconds

Result<bool> Swapchain::show(const Image& image, VkExtent2D extent, VkExtent2D window) {
    const VkDevice device = context_->device();
    const VkFence fence = fence_.get();
    LR_TRY_VK(vkWaitForFences(device, 1, &fence, VK_TRUE, UINT64_MAX));
    if (window_.width != window.width || window_.height != window.height || swapchain_ == VK_NULL_HANDLE) {
        window_ = window;
        LR_ASSIGN(const Fit fit, rebuild());
        if (fit != Fit::shown) return fit == Fit::no_size;
    }
    std::uint32_t index = 0;
    VkResult acquired = vkAcquireNextImageKHR(device, swapchain_, kPatience, acquired_.get(), VK_NULL_HANDLE, &index);
    if (acquired == VK_ERROR_OUT_OF_DATE_KHR) {
        LR_ASSIGN(const Fit fit, rebuild());
        if (fit != Fit::shown) return fit == Fit::no_size;
        acquired = vkAcquireNextImageKHR(device, swapchain_, kPatience, acquired_.get(), VK_NULL_HANDLE, &index);
        if (acquired == VK_ERROR_OUT_OF_DATE_KHR) return true;  // still being resized: skip this frame
    }
    if (acquired == VK_TIMEOUT || acquired == VK_NOT_READY) return true;
    if (acquired != VK_SUBOPTIMAL_KHR) LR_TRY(check(acquired, "vkAcquireNextImageKHR"));

    LR_TRY_VK(vkResetCommandPool(device, pool_.get(), 0));
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    LR_TRY_VK(vkBeginCommandBuffer(commands_, &begin));
    record(images_[index], image, extent);
    LR_TRY_VK(vkEndCommandBuffer(commands_));
    LR_TRY_VK(vkResetFences(device, 1, &fence));
    std::array<VkSemaphoreSubmitInfo, 2> semaphores{};
    for (VkSemaphoreSubmitInfo& info : semaphores) {
        info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO;
        info.stageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    }
    semaphores[0].semaphore = acquired_.get();
    semaphores[1].semaphore = drawn_[index].get();
    semaphores[1].stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    VkCommandBufferSubmitInfo command_info{};
    command_info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO;
    command_info.commandBuffer = commands_;
    VkSubmitInfo2 submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
    submit.waitSemaphoreInfoCount = 1;
    submit.pWaitSemaphoreInfos = &semaphores[0];
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &command_info;
    submit.signalSemaphoreInfoCount = 1;
    submit.pSignalSemaphoreInfos = &semaphores[1];
    LR_TRY(check(context_->submit(submit, fence), "vkQueueSubmit2"));
    const VkSemaphore drawn = drawn_[index].get();
    VkPresentInfoKHR present{};
    present.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
    present.waitSemaphoreCount = 1;
    present.pWaitSemaphores = &drawn;
    present.swapchainCount = 1;
    present.pSwapchains = &swapchain_;
    present.pImageIndices = &index;
    const VkResult presented = context_->present(present);
    if (presented == VK_ERROR_OUT_OF_DATE_KHR || presented == VK_SUBOPTIMAL_KHR) {
        LR_ASSIGN(const Fit fit, rebuild());
        return fit != Fit::too_large;
    }
    LR_TRY(check(presented, "vkQueuePresentKHR"));
    return true;
}

}  // namespace lacedring::gpu
