#include "renderer/draw/target.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "renderer/vk/commands.h"
#include "renderer/vk/context.h"
#include "renderer/vk/try.h"

namespace lacedring::gpu {
namespace {

constexpr Access kColorWrite{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                             VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT};
constexpr Access kDepthWrite{
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT};
constexpr Access kClaim{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                        VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
constexpr Access kClear{VK_PIPELINE_STAGE_2_CLEAR_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
constexpr Access kCopyRead{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};
// Waits for the queue's reads of the frame before; its contents are dropped.
constexpr Access kBefore{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_NONE};

}  // namespace

std::uint32_t Target::fitting_samples(const Context& context, VkExtent2D extent, std::uint32_t wanted) {
    const std::uint32_t largest = context.limits().maxImageDimension2D;
    while (wanted > 1 && std::max(extent.width, extent.height) * wanted > largest) --wanted;
    return wanted;
}

Result<Target> Target::create(Context& context, VkExtent2D extent, VkImageUsageFlags more) {
    Target out;
    out.extent_ = extent;
    const VkImageUsageFlags drawn = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | more;
    LR_ASSIGN(out.color_, Image::create(context, "color", extent, kColor, drawn));
    LR_ASSIGN(out.triangles_, Image::create(context, "triangle numbers", extent, kTriangles, drawn));
    LR_ASSIGN(out.winner_, Image::create(context, "claims", extent, kTriangles,
                                         VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT));
    LR_ASSIGN(out.depth_, Image::create(context, "depth", extent, kDepth, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT));
    const VkDeviceSize bytes = VkDeviceSize{4} * extent.width * extent.height;
    LR_ASSIGN(out.color_bytes_, Buffer::create(context, "color bytes", bytes, 0, Memory::readback));
    LR_ASSIGN(out.triangle_bytes_, Buffer::create(context, "triangle bytes", bytes, 0, Memory::readback));
    return out;
}

void Target::prepare(VkCommandBuffer commands) const {
    constexpr VkImageLayout kNone = VK_IMAGE_LAYOUT_UNDEFINED;
    image_barrier(commands, color_.handle(), color_.aspect(), kBefore, kColorWrite, kNone,
                  VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    image_barrier(commands, triangles_.handle(), triangles_.aspect(), kBefore, kColorWrite, kNone,
                  VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    image_barrier(commands, depth_.handle(), depth_.aspect(), kBefore, kDepthWrite, kNone,
                  VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    image_barrier(commands, winner_.handle(), winner_.aspect(), kBefore, kClear, kNone, VK_IMAGE_LAYOUT_GENERAL);
    VkClearColorValue unclaimed{};
    for (std::uint32_t& value : unclaimed.uint32) value = UINT32_MAX;
    const VkImageSubresourceRange range{winner_.aspect(), 0, 1, 0, 1};
    vkCmdClearColorImage(commands, winner_.handle(), VK_IMAGE_LAYOUT_GENERAL, &unclaimed, 1, &range);
    memory_barrier(commands, kClear, kClaim);
}

std::uint32_t Target::viewport_side() const {
    return std::bit_ceil(std::max(extent_.width, extent_.height));
}

mat4 Target::clip_from_view(const Camera& camera) const {
    mat4 out = camera.clip_from_view;
    const auto side = static_cast<float>(viewport_side());
    for (std::size_t column = 0; column < 4; ++column) {
        out[4 * column] *= static_cast<float>(extent_.width) / side;
        out[4 * column + 1] *= static_cast<float>(extent_.height) / side;
    }
    return out;
}

void Target::begin(VkCommandBuffer commands, const Use& use) const {
    const auto attachment = [](const Image& image, VkImageLayout layout, bool clear) {
        VkRenderingAttachmentInfo info{};
        info.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
        info.imageView = image.view();
        info.imageLayout = layout;
        info.loadOp = clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
        info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
        return info;  // the clear value is zero: transparent, triangle 0
    };
    constexpr VkImageLayout kColorLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    const std::array<VkRenderingAttachmentInfo, 2> colors{attachment(color_, kColorLayout, use.clear_color),
                                                          attachment(triangles_, kColorLayout, use.clear_color)};
    VkRenderingAttachmentInfo depth = attachment(depth_, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, use.clear_depth);
    depth.clearValue.depthStencil.depth = 1.0F;
    VkRenderingInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    info.renderArea = {{0, 0}, extent_};
    info.layerCount = 1;
    info.colorAttachmentCount = (use.color ? 1U : 0U) + (use.triangles ? 1U : 0U);
    info.pColorAttachments = colors.data();
    info.pDepthAttachment = &depth;
    vkCmdBeginRendering(commands, &info);
    // Negative height, as y points down in Vulkan's clip space. The square surrounds the picture (see clip_from_view).
    const auto width = static_cast<float>(extent_.width), height = static_cast<float>(extent_.height);
    const auto side = static_cast<float>(viewport_side());
    const VkViewport viewport{(width - side) / 2, (height + side) / 2, side, -side, 0, 1};
    const VkRect2D scissor{{0, 0}, extent_};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &scissor);
}

void Target::end(VkCommandBuffer commands) {
    vkCmdEndRendering(commands);
}

void Target::between(VkCommandBuffer commands) {
    const Access all{kColorWrite.stage | kDepthWrite.stage | kClaim.stage,
                     kColorWrite.access | kDepthWrite.access | kClaim.access};
    memory_barrier(commands, all, all);
}

void Target::record_read(VkCommandBuffer commands) const {
    const auto copy = [&](const Image& image, const Buffer& to) {
        image_barrier(commands, image.handle(), image.aspect(), kColorWrite, kCopyRead,
                      VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        VkBufferImageCopy region{};
        region.imageSubresource = {image.aspect(), 0, 0, 1};
        region.imageExtent = {extent_.width, extent_.height, 1};
        vkCmdCopyImageToBuffer(commands, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.handle(), 1, &region);
    };
    copy(color_, color_bytes_);
    copy(triangles_, triangle_bytes_);
    memory_barrier(commands, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT},
                   {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
}

Picture Target::picture() const {
    Picture out;
    out.width = extent_.width;
    out.height = extent_.height;
    out.rgba.resize(4 * out.pixels());
    out.triangles.resize(out.pixels());
    std::memcpy(out.rgba.data(), color_bytes_.mapped(), out.rgba.size());
    std::memcpy(out.triangles.data(), triangle_bytes_.mapped(), 4 * out.pixels());
    return out;
}

}  // namespace lacedring::gpu
