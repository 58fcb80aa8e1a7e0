#pragma once
// Owners of Vulkan handles: move-only, destroyed with their device.

#include <vulkan/vulkan.h>

#include <utility>

namespace lacedring::gpu {

template <class T, auto Destroy>
class Handle {
  public:
    Handle() = default;
    Handle(VkDevice device, T value) : device_(device), value_(value) {}
    Handle(Handle&& other) noexcept
        : device_(other.device_), value_(std::exchange(other.value_, static_cast<T>(VK_NULL_HANDLE))) {}
    Handle& operator=(Handle&& other) noexcept {
        if (this != &other) {
            reset();
            device_ = other.device_;
            value_ = std::exchange(other.value_, static_cast<T>(VK_NULL_HANDLE));
        }
        return *this;
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    ~Handle() { reset(); }

    T get() const { return value_; }
    explicit operator bool() const { return value_ != VK_NULL_HANDLE; }

  private:
    void reset() {
        if (value_ != VK_NULL_HANDLE) Destroy(device_, value_, nullptr);
        value_ = VK_NULL_HANDLE;
    }

    VkDevice device_ = VK_NULL_HANDLE;
    T value_ = VK_NULL_HANDLE;
};

using CommandPoolHandle = Handle<VkCommandPool, vkDestroyCommandPool>;
using DescriptorPoolHandle = Handle<VkDescriptorPool, vkDestroyDescriptorPool>;
using DescriptorSetLayoutHandle = Handle<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout>;
using FenceHandle = Handle<VkFence, vkDestroyFence>;
using PipelineHandle = Handle<VkPipeline, vkDestroyPipeline>;
using PipelineLayoutHandle = Handle<VkPipelineLayout, vkDestroyPipelineLayout>;
using QueryPoolHandle = Handle<VkQueryPool, vkDestroyQueryPool>;
using RenderPassHandle = Handle<VkRenderPass, vkDestroyRenderPass>;
using FramebufferHandle = Handle<VkFramebuffer, vkDestroyFramebuffer>;
using SemaphoreHandle = Handle<VkSemaphore, vkDestroySemaphore>;
using ShaderModuleHandle = Handle<VkShaderModule, vkDestroyShaderModule>;

}  // namespace lacedring::gpu
