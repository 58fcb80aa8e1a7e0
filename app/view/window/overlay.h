#pragma once
// The panels' pixels: ImGui's Vulkan backend over an image of ours. Debian's ImGui draws in a render pass.

#include <vulkan/vulkan.h>

#include <memory>
#include <optional>

#include "app/view/window/event.h"
#include "renderer/vk/commands.h"
#include "renderer/vk/image.h"

namespace lacedring::view {

/// Fonts and colours are there once it is made. One at a time, as ImGui has it.
class Overlay {
  public:
    /// `scale`: pixels a nominal pixel.
    static Result<std::unique_ptr<Overlay>> create(gpu::Context& context, double scale);
    ~Overlay();
    Overlay(const Overlay&) = delete;
    Overlay& operator=(const Overlay&) = delete;

    Result<void> resize(VkExtent2D extent);
    /// Gives ImGui an event.
    static void feed(const Event& event);
    /// Records a copy of `under` and what ImGui::Render made over it. `under` and image() have extent's size and are in
    /// VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, before and after.
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
