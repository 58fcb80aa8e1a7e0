#pragma once
// What is drawn into, offscreen: colour, triangle numbers, depth, and which triangle claimed each pixel.

#include "renderer/draw/camera.h"
#include "renderer/draw/picture.h"
#include "renderer/vk/buffer.h"
#include "renderer/vk/image.h"

namespace lacedring::gpu {

class Target {
  public:
    static constexpr VkFormat kColour = VK_FORMAT_R8G8B8A8_UNORM;
    static constexpr VkFormat kTriangles = VK_FORMAT_R32_UINT;
    static constexpr VkFormat kDepth = VK_FORMAT_D32_SFLOAT;

    /// `more`: what else is done with the colours and triangle numbers.
    /// As many samples a pixel along each side, up to `wanted`, as the device's images are large enough for.
    static std::uint32_t fitting_samples(const Context& context, VkExtent2D extent, std::uint32_t wanted);
    static Result<Target> create(Context& context, VkExtent2D extent, VkImageUsageFlags more = 0);

    VkExtent2D extent() const { return extent_; }
    /// The camera's projection, for the viewport that begin() sets. That is a square around the picture whose side is a
    /// power of two: scaling to it is then exact, so that vertices land on the same point of a pixel whether a driver
    /// fuses it with the translation or not (lavapipe does for vertex shaders alone, and not behind geometry shaders).
    mat4 clip_from_view(const Camera& camera) const;
    const Image& winner() const { return winner_; }
    const Image& colour() const { return colour_; }
    const Image& triangles() const { return triangles_; }

    /// Brings every image to its layout and drops what it held; clears the claims.
    void prepare(VkCommandBuffer commands) const;

    /// What a rendering instance draws into, and whether it starts afresh.
    struct Use {
        bool colour = false;
        bool triangles = false;
        bool clear_colour = false;  ///< and triangles
        bool clear_depth = false;
    };
    void begin(VkCommandBuffer commands, const Use& use) const;
    static void end(VkCommandBuffer commands);
    /// Between rendering instances: everything drawn and claimed so far is visible to the next.
    static void between(VkCommandBuffer commands);

    /// Copies the pictures to the host's side; picture() gives them once the commands have run.
    void record_read(VkCommandBuffer commands) const;
    Picture picture() const;

  private:
    std::uint32_t viewport_side() const;

    VkExtent2D extent_{};
    Image colour_, triangles_, winner_, depth_;
    Buffer colour_bytes_, triangle_bytes_;
};

}  // namespace lacedring::gpu
