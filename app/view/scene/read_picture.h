#pragma once
// Reads a picture back from the device.

#include "renderer/draw/picture.h"
#include "renderer/vk/commands.h"
#include "renderer/vk/image.h"

namespace lacedring::view {

/// Copies an RGBA image of this size, in VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to the host. Waits for the device.
Result<gpu::Picture> read_picture(gpu::Context& context, gpu::Commands& commands, const gpu::Image& image,
                                  VkExtent2D extent);

}  // namespace lacedring::view
