#pragma once
// Draws the panels: ImGui's Vulkan backend over an image of the viewer. Debian's ImGui draws in a render pass.

#include <vulkan/vulkan.h>

#include <memory>
#include <optional>

#include "app/view/window/event.h"
#include "renderer/vk/commands.h"
#include "renderer/vk/image.h"

namespace lacedring::view {

/// Owns ImGui's context, with fonts and colors. Only one may exist at a time.
class Overlay {
  public:
    /// `scale`: pixels per nominal pixel.
    static Result<std::unique_ptr<Overlay>> create(gpu::Context& context, double scale);
    ~Overlay();
    Overlay(const Overlay&) = delete;
    Overlay& operator=(const Overlay&) = delete;

    Result<void> resize(VkExtent2D extent);
    /// Gives ImGui an event.
    static void feed(const Event& event);
    /// Records copying `under` to image() and drawing ImGui's output over it. Both have the size given to resize();
    /// both are in VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL afterwards, `under` also before.
    void record(VkCommandBuffer commands, const gpu::Image& under);
    const gpu::Image& image() const { return image_; }

  private:
    Overlay() = default;
    Result<void> start(gpu::Context& context, double scale);

    gpu::Context* context_ = nullptr;
    gpu::DescriptorPoolHandle pool_;
    gpu::RenderPassHandle pass_;
    gpu::FramebufferHandle framebuffer_;
    gpu::Image image_;
    VkExtent2D extent_{};
    bool started_ = false;
};

}  // namespace lacedring::view
