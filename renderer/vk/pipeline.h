#pragma once
// Descriptor sets and pipelines.

#include <vulkan/vulkan.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lacedring/base.hpp"
#include "renderer/vk/buffer.h"
#include "renderer/vk/handle.h"
#include "shaders/shader.h"

namespace lacedring::gpu {

class Context;

struct Binding {
    std::uint32_t number = 0;
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    VkShaderStageFlags stages = VK_SHADER_STAGE_COMPUTE_BIT;
    std::uint32_t count = 1;
};

/// A pipeline layout with one descriptor set layout and one range of push constants.
class Layout {
  public:
    Layout() = default;
    static Result<Layout> create(Context& context, const std::string& name, std::span<const Binding> bindings,
                                 VkShaderStageFlags push_stages, std::uint32_t push_bytes);

    VkPipelineLayout pipeline() const { return pipeline_.get(); }
    VkDescriptorSetLayout set() const { return set_.get(); }

  private:
    DescriptorSetLayoutHandle set_;
    PipelineLayoutHandle pipeline_;
};

/// A range of a buffer that a descriptor covers.
struct BufferRange {
    const Buffer* buffer = nullptr;
    VkDeviceSize offset = 0;
    VkDeviceSize size = VK_WHOLE_SIZE;
};

/// Allocates descriptor sets, which live as long as this object.
class Descriptors {
  public:
    Descriptors() = default;
    explicit Descriptors(Context& context) : context_(&context) {}

    Result<VkDescriptorSet> allocate(const Layout& layout);
    /// Writes binding `number`, starting at array element 0.
    void write(VkDescriptorSet set, std::uint32_t number, VkDescriptorType type, std::span<const BufferRange> ranges);
    void write(VkDescriptorSet set, std::uint32_t number, VkDescriptorType type, const BufferRange& range) {
        write(set, number, type, std::span(&range, 1));
    }
    /// Writes binding `number`: a storage image in VK_IMAGE_LAYOUT_GENERAL.
    void write_image(VkDescriptorSet set, std::uint32_t number, VkImageView view);

  private:
    Context* context_ = nullptr;
    std::vector<DescriptorPoolHandle> pools_;  // all full, except perhaps the last
};

/// `constants`: the shader's specialization constants 0, 1, ... The context's ShaderSet may override the SPIR-V of any
/// shader.
Result<PipelineHandle> create_compute(Context& context, const std::string& name, const Layout& layout,
                                      const Shader& shader, std::span<const std::uint32_t> constants = {});

/// The properties in which our graphics pipelines differ. Viewport and scissor are dynamic, as is the line width of
/// pipelines that draw lines.
struct GraphicsInfo {
    std::string name;
    Shader vertex;                         ///< empty if there is a mesh shader
    Shader geometry;                       ///< may be empty
    Shader mesh;                           ///< may be empty
    Shader fragment;                       ///< may be empty: writes depth only
    std::vector<std::uint32_t> constants;  ///< specialization constants 0, 1, ... of all stages
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkCompareOp depth_compare = VK_COMPARE_OP_LESS;
    bool depth_write = true;
    bool push_back = false;  ///< moves triangles a little away from the eye, so that lines can be drawn over them
    bool blend = false;      ///< draws over, by the source's opacity; the result is premultiplied
    std::vector<VkFormat> colors;
    VkVertexInputBindingDescription vertex_binding{};  ///< used if there are attributes
    std::vector<VkVertexInputAttributeDescription> vertex_attributes;
};

Result<PipelineHandle> create_graphics(Context& context, const Layout& layout, const GraphicsInfo& info);

}  // namespace lacedring::gpu
