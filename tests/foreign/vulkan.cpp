#include "vulkan.h"

#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

namespace {

constexpr VkFormat color_format = VK_FORMAT_R8G8B8A8_UNORM, depth_format = VK_FORMAT_D32_SFLOAT;

void check(VkResult result, const char* what) {
    if (result != VK_SUCCESS) throw std::runtime_error(std::string(what) + ": VkResult " + std::to_string(result));
}

VkBool32 on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                    const VkDebugUtilsMessengerCallbackDataEXT* data, void* count) {
    std::fprintf(stderr, "%s\n", data->pMessage);
    ++*static_cast<std::uint32_t*>(count);
    return VK_FALSE;
}

}  // namespace

Gpu::Gpu(std::uint32_t& messages) {
    const char* layers[] = {"VK_LAYER_KHRONOS_validation"};
    const char* instance_extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
    const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
    const VkValidationFeatureEnableEXT enable[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    const VkValidationFeaturesEXT validation{.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                             .enabledValidationFeatureCount = 1,
                                             .pEnabledValidationFeatures = enable};
    const VkDebugUtilsMessengerCreateInfoEXT messenger{
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .pNext = &validation,
        .messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = on_message,
        .pUserData = &messages};
    const VkInstanceCreateInfo instance{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                        .pNext = &messenger,
                                        .pApplicationInfo = &application,
                                        .enabledLayerCount = 1,
                                        .ppEnabledLayerNames = layers,
                                        .enabledExtensionCount = 2,
                                        .ppEnabledExtensionNames = instance_extensions};
    check(vkCreateInstance(&instance, nullptr, &instance_), "vkCreateInstance with the validation layer");
    undo_.push_back([this] { vkDestroyInstance(instance_, nullptr); });
    const auto create_messenger = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
    const auto destroy_messenger = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
    VkDebugUtilsMessengerCreateInfoEXT lasting = messenger;
    lasting.pNext = nullptr;
    VkDebugUtilsMessengerEXT handle;
    check(create_messenger(instance_, &lasting, nullptr, &handle), "vkCreateDebugUtilsMessengerEXT");
    undo_.push_back([=, this] { destroy_messenger(instance_, handle, nullptr); });

    // Selects the first device and its first queue family for graphics and compute.
    std::uint32_t one = 1;
    const VkResult devices = vkEnumeratePhysicalDevices(instance_, &one, &physical_);
    if (one == 0 || (devices != VK_SUCCESS && devices != VK_INCOMPLETE)) throw std::runtime_error("no Vulkan device");
    std::uint32_t count = 0, family = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical_, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical_, &count, families.data());
    constexpr VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    while (family < count && (families[family].queueFlags & both) != both) ++family;

    check(vkEnumerateDeviceExtensionProperties(physical_, nullptr, &count, nullptr), "extensions");
    std::vector<VkExtensionProperties> extensions(count);
    check(vkEnumerateDeviceExtensionProperties(physical_, nullptr, &count, extensions.data()), "extensions");
    bool mesh = false;
    for (const auto& e : extensions) mesh |= std::strcmp(e.extensionName, VK_EXT_MESH_SHADER_EXTENSION_NAME) == 0;

    VkPhysicalDeviceMeshShaderFeaturesEXT mesh_features{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MESH_SHADER_FEATURES_EXT, .meshShader = VK_TRUE};
    VkPhysicalDeviceVulkan13Features features13{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
                                                .pNext = mesh ? &mesh_features : nullptr,
                                                .synchronization2 = VK_TRUE,
                                                .dynamicRendering = VK_TRUE,
                                                .maintenance4 = VK_TRUE};
    const VkPhysicalDeviceFeatures features{.geometryShader = VK_TRUE};
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                        .queueFamilyIndex = family,
                                        .queueCount = 1,
                                        .pQueuePriorities = &priority};
    const char* mesh_extension[] = {VK_EXT_MESH_SHADER_EXTENSION_NAME};
    const VkDeviceCreateInfo device{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                    .pNext = &features13,
                                    .queueCreateInfoCount = 1,
                                    .pQueueCreateInfos = &queue,
                                    .enabledExtensionCount = mesh ? 1U : 0U,
                                    .ppEnabledExtensionNames = mesh_extension,
                                    .pEnabledFeatures = &features};
    check(vkCreateDevice(physical_, &device, nullptr, &device_), "vkCreateDevice");
    undo_.push_back([this] { vkDestroyDevice(device_, nullptr); });
    vkGetDeviceQueue(device_, family, 0, &queue_);
    if (mesh) {
        draw_mesh_tasks =
            reinterpret_cast<PFN_vkCmdDrawMeshTasksEXT>(vkGetDeviceProcAddr(device_, "vkCmdDrawMeshTasksEXT"));
    }

    const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                       .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                       .queueFamilyIndex = family};
    VkCommandPool command_pool;
    check(vkCreateCommandPool(device_, &pool, nullptr, &command_pool), "vkCreateCommandPool");
    undo_.push_back([=, this] { vkDestroyCommandPool(device_, command_pool, nullptr); });
    const VkCommandBufferAllocateInfo commands{
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, .commandPool = command_pool, .commandBufferCount = 1};
    check(vkAllocateCommandBuffers(device_, &commands, &commands_), "vkAllocateCommandBuffers");

    const VkDescriptorPoolSize sizes{.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, .descriptorCount = 3 * 8};
    const VkDescriptorPoolCreateInfo descriptors{
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, .maxSets = 8, .poolSizeCount = 1, .pPoolSizes = &sizes};
    check(vkCreateDescriptorPool(device_, &descriptors, nullptr, &descriptor_pool_), "vkCreateDescriptorPool");
    undo_.push_back([this] { vkDestroyDescriptorPool(device_, descriptor_pool_, nullptr); });
    std::array<VkDescriptorSetLayoutBinding, 3> bindings{};
    for (std::uint32_t i = 0; i < 3; ++i) {
        bindings[i] = {i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_ALL, nullptr};
    }
    const VkDescriptorSetLayoutCreateInfo set{
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, .bindingCount = 3, .pBindings = bindings.data()};
    check(vkCreateDescriptorSetLayout(device_, &set, nullptr, &set_layout_), "vkCreateDescriptorSetLayout");
    undo_.push_back([this] { vkDestroyDescriptorSetLayout(device_, set_layout_, nullptr); });
    const VkPushConstantRange push{VK_SHADER_STAGE_ALL, 0, sizeof(Push)};
    const VkPipelineLayoutCreateInfo layout{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                            .setLayoutCount = 1,
                                            .pSetLayouts = &set_layout_,
                                            .pushConstantRangeCount = 1,
                                            .pPushConstantRanges = &push};
    check(vkCreatePipelineLayout(device_, &layout, nullptr, &layout_), "vkCreatePipelineLayout");
    undo_.push_back([this] { vkDestroyPipelineLayout(device_, layout_, nullptr); });

    color_view_ = image(color_format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                        VK_IMAGE_ASPECT_COLOR_BIT, color_);
    depth_view_ = image(depth_format, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_IMAGE_ASPECT_DEPTH_BIT, depth_);
    pixels_ = buffer(std::size_t{side} * side * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
}

Gpu::~Gpu() {
    if (device_ != VK_NULL_HANDLE) vkDeviceWaitIdle(device_);
    for (; !undo_.empty(); undo_.pop_back()) undo_.back()();
}

std::uint32_t Gpu::memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) const {
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical_, &memory);
    for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
        if ((allowed >> i & 1U) != 0 && (memory.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
    }
    throw std::runtime_error("no memory of a wanted type");
}

// Host-visible memory, for simplicity; an engine copies to device-local memory.
Buffer Gpu::buffer(std::size_t bytes, VkBufferUsageFlags usage, const void* contents) {
    Buffer b{.bytes = bytes};
    const VkBufferCreateInfo create{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = bytes, .usage = usage};
    check(vkCreateBuffer(device_, &create, nullptr, &b.handle), "vkCreateBuffer");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device_, b.handle, &needs);
    const VkMemoryAllocateInfo allocate{
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
        .allocationSize = needs.size,
        .memoryTypeIndex = memory_type(needs.memoryTypeBits,
                                       VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT)};
    VkDeviceMemory memory;
    check(vkAllocateMemory(device_, &allocate, nullptr, &memory), "vkAllocateMemory");
    undo_.push_back([=, this] {
        vkDestroyBuffer(device_, b.handle, nullptr);
        vkFreeMemory(device_, memory, nullptr);
    });
    check(vkBindBufferMemory(device_, b.handle, memory, 0), "vkBindBufferMemory");
    check(vkMapMemory(device_, memory, 0, VK_WHOLE_SIZE, 0, &b.mapped), "vkMapMemory");
    if (contents != nullptr) std::memcpy(b.mapped, contents, bytes);
    return b;
}

VkImageView Gpu::image(VkFormat format, VkImageUsageFlags usage, VkImageAspectFlags aspect, VkImage& image) {
    const VkImageCreateInfo create{.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                   .imageType = VK_IMAGE_TYPE_2D,
                                   .format = format,
                                   .extent = {side, side, 1},
                                   .mipLevels = 1,
                                   .arrayLayers = 1,
                                   .samples = VK_SAMPLE_COUNT_1_BIT,
                                   .usage = usage};
    VkImage handle;
    check(vkCreateImage(device_, &create, nullptr, &handle), "vkCreateImage");
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device_, handle, &needs);
    const VkMemoryAllocateInfo allocate{
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
        .allocationSize = needs.size,
        .memoryTypeIndex = memory_type(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)};
    VkDeviceMemory memory;
    check(vkAllocateMemory(device_, &allocate, nullptr, &memory), "vkAllocateMemory");
    check(vkBindImageMemory(device_, handle, memory, 0), "vkBindImageMemory");
    const VkImageViewCreateInfo create_view{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                            .image = handle,
                                            .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                            .format = format,
                                            .subresourceRange = {aspect, 0, 1, 0, 1}};
    VkImageView view;
    check(vkCreateImageView(device_, &create_view, nullptr, &view), "vkCreateImageView");
    undo_.push_back([=, this] {
        vkDestroyImageView(device_, view, nullptr);
        vkDestroyImage(device_, handle, nullptr);
        vkFreeMemory(device_, memory, nullptr);
    });
    image = handle;
    return view;
}

VkDescriptorSet Gpu::descriptors(const Buffer& words, const Buffer& vertices, const Buffer& indices) {
    const VkDescriptorSetAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                               .descriptorPool = descriptor_pool_,
                                               .descriptorSetCount = 1,
                                               .pSetLayouts = &set_layout_};
    VkDescriptorSet set;
    check(vkAllocateDescriptorSets(device_, &allocate, &set), "vkAllocateDescriptorSets");
    std::uint32_t binding = 0;
    for (const Buffer* b : {&words, &vertices, &indices}) {
        const VkDescriptorBufferInfo info{b->handle, 0, VK_WHOLE_SIZE};
        const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                         .dstSet = set,
                                         .dstBinding = binding++,
                                         .descriptorCount = 1,
                                         .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                         .pBufferInfo = &info};
        vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
    }
    return set;
}

VkShaderModule Gpu::shader(Spirv spirv) {
    const VkShaderModuleCreateInfo create{
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = spirv.size_bytes(), .pCode = spirv.data()};
    VkShaderModule module;
    check(vkCreateShaderModule(device_, &create, nullptr, &module), "vkCreateShaderModule");
    undo_.push_back([=, this] { vkDestroyShaderModule(device_, module, nullptr); });
    return module;
}

VkPipeline Gpu::compute(Spirv spirv) {
    const VkComputePipelineCreateInfo create{.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                             .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                       .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                                                       .module = shader(spirv),
                                                       .pName = "main"},
                                             .layout = layout_};
    VkPipeline pipeline;
    check(vkCreateComputePipelines(device_, VK_NULL_HANDLE, 1, &create, nullptr, &pipeline), "compute pipeline");
    undo_.push_back([=, this] { vkDestroyPipeline(device_, pipeline, nullptr); });
    return pipeline;
}

VkPipeline Gpu::graphics(std::span<const Stage> stages, Input input) {
    std::vector<VkPipelineShaderStageCreateInfo> infos;
    for (const Stage& s : stages) {
        infos.push_back({.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                         .stage = s.stage,
                         .module = shader(s.spirv),
                         .pName = "main"});
    }
    const VkVertexInputBindingDescription binding{0, 3 * sizeof(float), VK_VERTEX_INPUT_RATE_VERTEX};
    const VkVertexInputAttributeDescription attribute{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0};
    const std::uint32_t attributes = input == Input::indexed ? 1 : 0;
    const VkPipelineVertexInputStateCreateInfo vertex{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
        .vertexBindingDescriptionCount = attributes,
        .pVertexBindingDescriptions = &binding,
        .vertexAttributeDescriptionCount = attributes,
        .pVertexAttributeDescriptions = &attribute};
    const VkPipelineInputAssemblyStateCreateInfo assembly{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = input == Input::points ? VK_PRIMITIVE_TOPOLOGY_POINT_LIST : VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    const VkViewport viewport{0, 0, side, side, 0, 1};
    const VkRect2D scissor{{0, 0}, {side, side}};
    const VkPipelineViewportStateCreateInfo view{.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
                                                 .viewportCount = 1,
                                                 .pViewports = &viewport,
                                                 .scissorCount = 1,
                                                 .pScissors = &scissor};
    const VkPipelineRasterizationStateCreateInfo raster{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1};
    const VkPipelineMultisampleStateCreateInfo samples{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    const VkPipelineDepthStencilStateCreateInfo depth{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = VK_TRUE,
        .depthWriteEnable = VK_TRUE};
    const VkPipelineColorBlendAttachmentState brightest{.blendEnable = VK_TRUE,
                                                        .srcColorBlendFactor = VK_BLEND_FACTOR_ONE,
                                                        .dstColorBlendFactor = VK_BLEND_FACTOR_ONE,
                                                        .colorBlendOp = VK_BLEND_OP_MAX,
                                                        .srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
                                                        .dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
                                                        .alphaBlendOp = VK_BLEND_OP_MAX,
                                                        .colorWriteMask = 0xf};
    const VkPipelineColorBlendStateCreateInfo blend{.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
                                                    .attachmentCount = 1,
                                                    .pAttachments = &brightest};
    const VkDynamicState compare[] = {VK_DYNAMIC_STATE_DEPTH_COMPARE_OP};
    const VkPipelineDynamicStateCreateInfo dynamic{.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
                                                   .dynamicStateCount = 1,
                                                   .pDynamicStates = compare};
    const VkPipelineRenderingCreateInfo rendering{.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
                                                  .colorAttachmentCount = 1,
                                                  .pColorAttachmentFormats = &color_format,
                                                  .depthAttachmentFormat = depth_format};
    const VkGraphicsPipelineCreateInfo create{.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                              .pNext = &rendering,
                                              .stageCount = static_cast<std::uint32_t>(infos.size()),
                                              .pStages = infos.data(),
                                              .pVertexInputState = input == Input::mesh ? nullptr : &vertex,
                                              .pInputAssemblyState = input == Input::mesh ? nullptr : &assembly,
                                              .pViewportState = &view,
                                              .pRasterizationState = &raster,
                                              .pMultisampleState = &samples,
                                              .pDepthStencilState = &depth,
                                              .pColorBlendState = &blend,
                                              .pDynamicState = &dynamic,
                                              .layout = layout_};
    VkPipeline pipeline;
    check(vkCreateGraphicsPipelines(device_, VK_NULL_HANDLE, 1, &create, nullptr, &pipeline), "graphics pipeline");
    undo_.push_back([=, this] { vkDestroyPipeline(device_, pipeline, nullptr); });
    return pipeline;
}

void Gpu::barrier(VkImage image, VkImageAspectFlags aspect, VkImageLayout from, VkImageLayout to) {
    const VkImageMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                        .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                        .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                                        .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                        .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
                                        .oldLayout = from,
                                        .newLayout = to,
                                        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                        .image = image,
                                        .subresourceRange = {aspect, 0, 1, 0, 1}};
    const VkDependencyInfo dependency{
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier};
    vkCmdPipelineBarrier2(commands_, &dependency);
}

// Of triangles at the same depth the first drawn is visible, which depends on the order of a stream. Therefore the
// first draw writes depth only, and the second takes the brightest color at that depth.
Picture Gpu::draw(const Push& push, VkDescriptorSet set, const Record& prepare, const Record& draw) {
    const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    check(vkBeginCommandBuffer(commands_, &begin), "vkBeginCommandBuffer");
    for (const auto point : {VK_PIPELINE_BIND_POINT_GRAPHICS, VK_PIPELINE_BIND_POINT_COMPUTE}) {
        if (set != VK_NULL_HANDLE) vkCmdBindDescriptorSets(commands_, point, layout_, 0, 1, &set, 0, nullptr);
    }
    vkCmdPushConstants(commands_, layout_, VK_SHADER_STAGE_ALL, 0, sizeof(push), &push);
    if (prepare) prepare(commands_);

    barrier(color_, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_ATTACHMENT_OPTIMAL);
    barrier(depth_, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_ATTACHMENT_OPTIMAL);
    const VkRenderingAttachmentInfo color{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                          .imageView = color_view_,
                                          .imageLayout = VK_IMAGE_LAYOUT_ATTACHMENT_OPTIMAL,
                                          .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                          .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
    const VkRenderingAttachmentInfo depth{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                          .imageView = depth_view_,
                                          .imageLayout = VK_IMAGE_LAYOUT_ATTACHMENT_OPTIMAL,
                                          .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                          .storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                          .clearValue = {.depthStencil = {1, 0}}};
    const VkRect2D area{{0, 0}, {side, side}};
    const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                    .renderArea = area,
                                    .layerCount = 1,
                                    .colorAttachmentCount = 1,
                                    .pColorAttachments = &color,
                                    .pDepthAttachment = &depth};
    vkCmdBeginRendering(commands_, &rendering);
    vkCmdSetDepthCompareOp(commands_, VK_COMPARE_OP_LESS);
    draw(commands_);
    const VkClearAttachment black{.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT};
    const VkClearRect everywhere{area, 0, 1};
    vkCmdClearAttachments(commands_, 1, &black, 1, &everywhere);
    vkCmdSetDepthCompareOp(commands_, VK_COMPARE_OP_EQUAL);
    draw(commands_);
    vkCmdEndRendering(commands_);

    barrier(color_, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_ATTACHMENT_OPTIMAL,
            VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    const VkBufferImageCopy copy{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                 .imageExtent = {side, side, 1}};
    vkCmdCopyImageToBuffer(commands_, color_, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pixels_.handle, 1, &copy);
    const VkMemoryBarrier2 to_host{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                   .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                   .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                   .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                   .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
    const VkDependencyInfo dependency{
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &to_host};
    vkCmdPipelineBarrier2(commands_, &dependency);
    check(vkEndCommandBuffer(commands_), "vkEndCommandBuffer");
    const VkSubmitInfo submit{
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &commands_};
    check(vkQueueSubmit(queue_, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
    check(vkQueueWaitIdle(queue_), "vkQueueWaitIdle");
    Picture picture(std::size_t{side} * side);
    std::memcpy(picture.data(), pixels_.mapped, picture.size() * 4);
    return picture;
}
