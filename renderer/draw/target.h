#pragma once
// The offscreen render target: color, triangle numbers, depth, and the triangle that claimed each pixel.

#include "renderer/draw/camera.h"
#include "renderer/draw/picture.h"
#include "renderer/vk/buffer.h"
#include "renderer/vk/image.h"

namespace lacedring::gpu {

class Target {
  public:
    static constexpr VkFormat kColor = VK_FORMAT_R8G8B8A8_UNORM;
    static constexpr VkFormat kTriangles = VK_FORMAT_R32_UINT;
    static constexpr VkFormat kDepth = VK_FORMAT_D32_SFLOAT;

    /// Largest number of samples per pixel along each side, up to `wanted`, whose target fits maxImageDimension2D.
    static std::uint32_t fitting_samples(const Context& context, VkExtent2D extent, std::uint32_t wanted);
    /// `more`: additional usages of the color and triangle number images.
    static Result<Target> create(Context& context, VkExtent2D extent, VkImageUsageFlags more = 0);

    VkExtent2D extent() const { return extent_; }
    /// The camera's projection for the viewport of begin(): a square around the picture whose side is a power of two.
    /// Scaling to such a viewport is exact, so vertices land on the same subpixel whether or not a driver fuses scaling
    /// and translation (lavapipe fuses them after a vertex shader, but not after a geometry shader).
    mat4 clip_from_view(const Camera& camera) const;
    const Image& winner() const { return winner_; }
    const Image& color() const { return color_; }
    const Image& triangles() const { return triangles_; }

    /// Transitions every image to its layout, dropping its contents, and clears the claims.
    void prepare(VkCommandBuffer commands) const;

    /// The attachments of a rendering instance, and which of them it clears.
    struct Use {
        bool color = false;
        bool triangles = false;
        bool clear_color = false;  ///< clears colors and triangle numbers
        bool clear_depth = false;
    };
    void begin(VkCommandBuffer commands, const Use& use) const;
    static void end(VkCommandBuffer commands);
    /// Barrier between rendering instances: makes everything drawn and claimed so far visible to the next one.
    static void between(VkCommandBuffer commands);

    /// Records copies of colors and triangle numbers to the host; picture() returns them once the commands have run.
    void record_read(VkCommandBuffer commands) const;
    Picture picture() const;

  private:
    std::uint32_t viewport_side() const;

    VkExtent2D extent_{};
    Image color_, triangles_, winner_, depth_;
    Buffer color_bytes_, triangle_bytes_;
};

}  // namespace lacedring::gpu
