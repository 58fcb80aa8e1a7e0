#include "app/view/scene/read_picture.h"

#include <cstring>

#include "renderer/vk/buffer.h"
#include "renderer/vk/try.h"

namespace lacedring::view {

Result<gpu::Picture> read_picture(gpu::Context& context, gpu::Commands& commands, const gpu::Image& image,
                                  VkExtent2D extent) {
    gpu::Picture out;
    out.width = extent.width;
    out.height = extent.height;
    out.rgba.resize(4 * out.pixels());
    LR_ASSIGN(const gpu::Buffer bytes,
              gpu::Buffer::create(context, "screenshot", out.rgba.size(), 0, gpu::Memory::readback));
    LR_ASSIGN(const VkCommandBuffer recorded, commands.begin());
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {extent.width, extent.height, 1};
    vkCmdCopyImageToBuffer(recorded, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, bytes.handle(), 1, &region);
    gpu::memory_barrier(recorded, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT},
                        {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
    LR_TRY(commands.run());
    std::memcpy(out.rgba.data(), bytes.mapped(), out.rgba.size());
    return out;
}

}  // namespace lacedring::view
