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

/// One descriptor set's layout, push constants, and the pipeline layout of the two.
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

/// A range of a buffer, as a descriptor sees it.
struct BufferRange {
    const Buffer* buffer = nullptr;
    VkDeviceSize offset = 0;
    VkDeviceSize size = VK_WHOLE_SIZE;
};

/// Descriptor sets that live until this goes.
class Descriptors {
  public:
    Descriptors() = default;
    explicit Descriptors(Context& context) : context_(&context) {}

    Result<VkDescriptorSet> allocate(const Layout& layout);
    /// Fills binding `number` from array element 0 on.
    void write(VkDescriptorSet set, std::uint32_t number, VkDescriptorType type, std::span<const BufferRange> ranges);
    void write(VkDescriptorSet set, std::uint32_t number, VkDescriptorType type, const BufferRange& range) {
        write(set, number, type, std::span(&range, 1));
    }
    /// A storage image in VK_IMAGE_LAYOUT_GENERAL.
    void write_image(VkDescriptorSet set, std::uint32_t number, VkImageView view);

  private:
    Context* context_ = nullptr;
    std::vector<DescriptorPoolHandle> pools_;  // the last one may have room
};

/// `constants`: the shader's specialization constants 0, 1, ... Of every shader the context's ShaderSet may have other
/// words than its own.
Result<PipelineHandle> create_compute(Context& context, const std::string& name, const Layout& layout,
                                      const Shader& shader, std::span<const std::uint32_t> constants = {});

/// What differs between the graphics pipelines. Viewport and scissor are dynamic, and the line width where lines are
/// drawn.
struct GraphicsInfo {
    std::string name;
    Shader vertex;    ///< or none, where `mesh` makes the vertices
    Shader geometry;  ///< may be none
    Shader mesh;
    Shader fragment;                       ///< none: depth only
    std::vector<std::uint32_t> constants;  ///< specialization constants 0, 1, ... of all stages
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkCompareOp depth_compare = VK_COMPARE_OP_LESS;
    bool depth_write = true;
    bool push_back = false;  ///< triangles a little away from the eye, for lines on top
    bool blend = false;      ///< over, with the source's opacity; result premultiplied
    std::vector<VkFormat> colours;
    VkVertexInputBindingDescription vertex_binding{};  ///< where there are attributes
    std::vector<VkVertexInputAttributeDescription> vertex_attributes;
};

Result<PipelineHandle> create_graphics(Context& context, const Layout& layout, const GraphicsInfo& info);

}  // namespace lacedring::gpu
