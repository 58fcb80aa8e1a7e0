#include "renderer/vk/pipeline.h"

#include <array>

#include "renderer/vk/context.h"
#include "renderer/vk/try.h"

namespace lacedring::gpu {
namespace {

constexpr std::uint32_t kSetsPerPool = 64;

Result<ShaderModuleHandle> create_module(Context& context, const Shader& of) {
    const std::shared_ptr<const ShaderSet::Words> other = context.shaders().find(of.name);
    const std::span<const std::uint32_t> spirv = other ? std::span(*other) : of.words;
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = spirv.size_bytes();
    info.pCode = spirv.data();
    VkShaderModule shader = VK_NULL_HANDLE;
    LR_TRY_VK(vkCreateShaderModule(context.device(), &info, nullptr, &shader));
    return ShaderModuleHandle(context.device(), shader);
}

VkPipelineShaderStageCreateInfo stage_info(VkShaderStageFlagBits stage, const ShaderModuleHandle& shader) {
    VkPipelineShaderStageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage = stage;
    info.module = shader.get();
    info.pName = "main";
    return info;
}

/// Specialization constants 0, 1, ... Refers to the values, does not copy them.
struct Specialization {
    explicit Specialization(std::span<const std::uint32_t> constants) {
        for (std::uint32_t i = 0; i < constants.size(); ++i) entries.push_back({i, 4 * i, 4});
        info = {static_cast<std::uint32_t>(entries.size()), entries.data(), constants.size_bytes(), constants.data()};
    }
    Specialization(const Specialization&) = delete;
    Specialization& operator=(const Specialization&) = delete;
    ~Specialization() = default;
    std::vector<VkSpecializationMapEntry> entries;
    VkSpecializationInfo info{};
};

}  // namespace

Result<Layout> Layout::create(Context& context, const std::string& name, std::span<const Binding> bindings,
                              VkShaderStageFlags push_stages, std::uint32_t push_bytes) {
    std::vector<VkDescriptorSetLayoutBinding> set_bindings;
    for (const Binding& binding : bindings) {
        set_bindings.push_back({binding.number, binding.type, binding.count, binding.stages, nullptr});
    }
    VkDescriptorSetLayoutCreateInfo set_info{};
    set_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    set_info.bindingCount = static_cast<std::uint32_t>(set_bindings.size());
    set_info.pBindings = set_bindings.data();
    VkDescriptorSetLayout set = VK_NULL_HANDLE;
    LR_TRY_VK(vkCreateDescriptorSetLayout(context.device(), &set_info, nullptr, &set));
    Layout out;
    out.set_ = {context.device(), set};
    const VkPushConstantRange push{push_stages, 0, push_bytes};
    VkPipelineLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.setLayoutCount = 1;
    info.pSetLayouts = &set;
    info.pushConstantRangeCount = push_bytes == 0 ? 0 : 1;
    info.pPushConstantRanges = &push;
    VkPipelineLayout pipeline = VK_NULL_HANDLE;
    LR_TRY_VK(vkCreatePipelineLayout(context.device(), &info, nullptr, &pipeline));
    out.pipeline_ = {context.device(), pipeline};
    context.name(VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, set, name);
    context.name(VK_OBJECT_TYPE_PIPELINE_LAYOUT, pipeline, name);
    return out;
}

Result<VkDescriptorSet> Descriptors::allocate(const Layout& layout) {
    const VkDescriptorSetLayout set_layout = layout.set();
    VkDescriptorSetAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    info.descriptorSetCount = 1;
    info.pSetLayouts = &set_layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    if (!pools_.empty()) {
        info.descriptorPool = pools_.back().get();
        if (vkAllocateDescriptorSets(context_->device(), &info, &set) == VK_SUCCESS) return set;
    }
    const std::array<VkDescriptorPoolSize, 3> sizes{{{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 6 * kSetsPerPool},
                                                     {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kSetsPerPool},
                                                     {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kSetsPerPool}}};
    VkDescriptorPoolCreateInfo pool_info{};
    pool_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool_info.maxSets = kSetsPerPool;
    pool_info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
    pool_info.pPoolSizes = sizes.data();
    VkDescriptorPool pool = VK_NULL_HANDLE;
    LR_TRY_VK(vkCreateDescriptorPool(context_->device(), &pool_info, nullptr, &pool));
    pools_.emplace_back(context_->device(), pool);
    info.descriptorPool = pool;
    LR_TRY_VK(vkAllocateDescriptorSets(context_->device(), &info, &set));
    return set;
}

void Descriptors::write(VkDescriptorSet set, std::uint32_t number, VkDescriptorType type,
                        std::span<const BufferRange> ranges) {
    std::vector<VkDescriptorBufferInfo> infos;
    for (const BufferRange& range : ranges) infos.push_back({range.buffer->handle(), range.offset, range.size});
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = set;
    write.dstBinding = number;
    write.descriptorCount = static_cast<std::uint32_t>(infos.size());
    write.descriptorType = type;
    write.pBufferInfo = infos.data();
    vkUpdateDescriptorSets(context_->device(), 1, &write, 0, nullptr);
}

void Descriptors::write_image(VkDescriptorSet set, std::uint32_t number, VkImageView view) {
    const VkDescriptorImageInfo info{VK_NULL_HANDLE, view, VK_IMAGE_LAYOUT_GENERAL};
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = set;
    write.dstBinding = number;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    write.pImageInfo = &info;
    vkUpdateDescriptorSets(context_->device(), 1, &write, 0, nullptr);
}

Result<PipelineHandle> create_compute(Context& context, const std::string& name, const Layout& layout,
                                      const Shader& shader, std::span<const std::uint32_t> constants) {
    LR_ASSIGN(const ShaderModuleHandle module, create_module(context, shader));
    const Specialization specialization(constants);
    VkComputePipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    info.stage = stage_info(VK_SHADER_STAGE_COMPUTE_BIT, module);
    info.stage.pSpecializationInfo = &specialization.info;
    info.layout = layout.pipeline();
    VkPipeline pipeline = VK_NULL_HANDLE;
    LR_TRY_VK(vkCreateComputePipelines(context.device(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline));
    context.name(VK_OBJECT_TYPE_PIPELINE, pipeline, name);
    return PipelineHandle(context.device(), pipeline);
}

Result<PipelineHandle> create_graphics(Context& context, const Layout& layout, const GraphicsInfo& info) {
    std::vector<VkPipelineShaderStageCreateInfo> stages;
    std::vector<ShaderModuleHandle> modules;
    const Specialization specialization(info.constants);
    const std::array<std::pair<VkShaderStageFlagBits, Shader>, 4> shaders{
        {{VK_SHADER_STAGE_VERTEX_BIT, info.vertex},
         {VK_SHADER_STAGE_GEOMETRY_BIT, info.geometry},
         {VK_SHADER_STAGE_MESH_BIT_EXT, info.mesh},
         {VK_SHADER_STAGE_FRAGMENT_BIT, info.fragment}}};
    for (const auto& [stage, shader] : shaders) {
        if (shader.words.empty()) continue;
        LR_ASSIGN(ShaderModuleHandle module, create_module(context, shader));
        stages.push_back(stage_info(stage, module));
        stages.back().pSpecializationInfo = &specialization.info;
        modules.push_back(std::move(module));
    }

    VkPipelineVertexInputStateCreateInfo input{};
    input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    input.vertexBindingDescriptionCount = info.vertex_attributes.empty() ? 0 : 1;
    input.pVertexBindingDescriptions = &info.vertex_binding;
    input.vertexAttributeDescriptionCount = static_cast<std::uint32_t>(info.vertex_attributes.size());
    input.pVertexAttributeDescriptions = info.vertex_attributes.data();
    VkPipelineInputAssemblyStateCreateInfo assembly{};
    assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
    assembly.topology = info.topology;
    VkPipelineViewportStateCreateInfo viewport{};
    viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
    viewport.viewportCount = 1;
    viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster{};
    raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
    raster.polygonMode = VK_POLYGON_MODE_FILL;
    raster.cullMode = VK_CULL_MODE_NONE;
    raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    raster.depthBiasEnable = info.push_back ? VK_TRUE : VK_FALSE;
    raster.depthBiasSlopeFactor = info.push_back ? 1.5F : 0.0F;
    raster.lineWidth = 1.0F;
    VkPipelineMultisampleStateCreateInfo multisample{};
    multisample.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
    multisample.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineDepthStencilStateCreateInfo depth{};
    depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
    depth.depthTestEnable = VK_TRUE;
    depth.depthWriteEnable = info.depth_write ? VK_TRUE : VK_FALSE;
    depth.depthCompareOp = info.depth_compare;
    VkPipelineColorBlendAttachmentState attachment{};
    attachment.colorWriteMask =
        VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    if (info.blend) {
        attachment.blendEnable = VK_TRUE;
        attachment.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
        attachment.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
        attachment.colorBlendOp = VK_BLEND_OP_ADD;
        attachment.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
        attachment.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
        attachment.alphaBlendOp = VK_BLEND_OP_ADD;
    }
    const std::vector<VkPipelineColorBlendAttachmentState> attachments(info.colors.size(), attachment);
    VkPipelineColorBlendStateCreateInfo blend{};
    blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    blend.attachmentCount = static_cast<std::uint32_t>(attachments.size());
    blend.pAttachments = attachments.data();
    const bool lines = info.topology == VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
    const std::array<VkDynamicState, 3> dynamic_states{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                                       VK_DYNAMIC_STATE_LINE_WIDTH};
    VkPipelineDynamicStateCreateInfo dynamic{};
    dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
    dynamic.dynamicStateCount = lines ? 3 : 2;
    dynamic.pDynamicStates = dynamic_states.data();
    VkPipelineRenderingCreateInfo rendering{};
    rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
    rendering.colorAttachmentCount = static_cast<std::uint32_t>(info.colors.size());
    rendering.pColorAttachmentFormats = info.colors.data();
    rendering.depthAttachmentFormat = VK_FORMAT_D32_SFLOAT;

    VkGraphicsPipelineCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    create.pNext = &rendering;
    create.stageCount = static_cast<std::uint32_t>(stages.size());
    create.pStages = stages.data();
    if (info.mesh.words.empty()) {
        create.pVertexInputState = &input;
        create.pInputAssemblyState = &assembly;
    }
    create.pViewportState = &viewport;
    create.pRasterizationState = &raster;
    create.pMultisampleState = &multisample;
    create.pDepthStencilState = &depth;
    create.pColorBlendState = &blend;
    create.pDynamicState = &dynamic;
    create.layout = layout.pipeline();
    VkPipeline pipeline = VK_NULL_HANDLE;
    LR_TRY_VK(vkCreateGraphicsPipelines(context.device(), VK_NULL_HANDLE, 1, &create, nullptr, &pipeline));
    context.name(VK_OBJECT_TYPE_PIPELINE, pipeline, info.name);
    return PipelineHandle(context.device(), pipeline);
}

}  // namespace lacedring::gpu
