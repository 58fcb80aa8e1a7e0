#pragma once
// A minimal Vulkan renderer for pictures of 512 x 512: a device, buffers, pipelines, one submission per picture.
#include <vulkan/vulkan.h>

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

constexpr std::uint32_t side = 512;

struct Buffer {
    VkBuffer handle = VK_NULL_HANDLE;
    VkDeviceSize bytes = 0;
    void* mapped = nullptr;
};

using Spirv = std::span<const std::uint32_t>;

struct Stage {
    VkShaderStageFlagBits stage;
    Spirv spirv;
};

enum class Input { indexed, triangles, points, mesh };

struct Push {
    std::array<float, 16> camera;
};

using Record = std::function<void(VkCommandBuffer)>;
using Picture = std::vector<std::uint32_t>;  // R8G8B8A8; alpha 0 where nothing is drawn

/// Throws on Vulkan errors; prints and counts messages of the validation layers.
class Gpu {
  public:
    explicit Gpu(std::uint32_t& messages);
    ~Gpu();
    Gpu(const Gpu&) = delete;
    Gpu& operator=(const Gpu&) = delete;

    bool has_mesh_shaders() const { return draw_mesh_tasks != nullptr; }
    Buffer buffer(std::size_t bytes, VkBufferUsageFlags usage, const void* contents = nullptr);
    /// Storage buffers at bindings 0, 1, 2.
    VkDescriptorSet descriptors(const Buffer& words, const Buffer& vertices, const Buffer& indices);
    VkPipeline compute(Spirv spirv);
    VkPipeline graphics(std::span<const Stage> stages, Input input);
    /// Records `prepare` before the render pass and `draw` twice in it.
    Picture draw(const Push& push, VkDescriptorSet set, const Record& prepare, const Record& draw);

    PFN_vkCmdDrawMeshTasksEXT draw_mesh_tasks = nullptr;

  private:
    std::uint32_t memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) const;
    VkShaderModule shader(Spirv spirv);
    VkImageView image(VkFormat format, VkImageUsageFlags usage, VkImageAspectFlags aspect, VkImage& image);
    void barrier(VkImage image, VkImageAspectFlags aspect, VkImageLayout from, VkImageLayout to);

    VkInstance instance_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkDescriptorPool descriptor_pool_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkImage color_ = VK_NULL_HANDLE, depth_ = VK_NULL_HANDLE;
    VkImageView color_view_ = VK_NULL_HANDLE, depth_view_ = VK_NULL_HANDLE;
    Buffer pixels_;
    std::vector<std::function<void()>> undo_;  // destroys everything created; run in reverse
};
