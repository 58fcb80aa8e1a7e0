#pragma once
// One Vulkan device without a window: instance, device, queue, limits, memory. All other objects of renderer/ refer to
// their context and must be destroyed before it.

#include <vulkan/vulkan.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "lacedring/base.hpp"
#include "renderer/shaders/shader_set.h"
#include "renderer/vk/arena.h"
#include "renderer/vk/validation.h"

namespace lacedring::gpu {

struct ContextOptions {
    std::string device;       ///< part of a device's or driver's name (choose_device); empty: the best one
    bool validation = false;  ///< VK_LAYER_KHRONOS_validation with synchronization validation
    /// With `validation`: GPU-assisted instead of synchronization validation. Reports shader accesses outside of bound
    /// ranges. Slow.
    bool gpu_assisted = false;
    std::uint64_t memory = 0;  ///< bytes of device memory to hold at most; 0: as much as the device has
    /// For pictures in a window: the extensions of its window system, and VK_KHR_swapchain (renderer/vk/swapchain.h).
    std::vector<const char*> instance_extensions = {}, device_extensions = {};
};

struct DeviceInfo {
    std::string name;    ///< "llvmpipe (LLVM 15.0.6, 256 bits)"
    std::string driver;  ///< "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)"
    std::string api;     ///< "1.3.230"
    bool software = false;
    bool timestamps = false;  ///< the queue has timestamps
    float max_line_width = 1.0F;
    std::uint32_t subgroup_size = 1;
    VkPhysicalDeviceLimits limits{};
    std::uint64_t max_buffer_size = 0;
    std::uint32_t max_index = 0;  ///< largest vertex number in an index buffer
    bool statistics = false;      ///< pipelineStatisticsQuery
    /// Mesh shader workgroups per draw command; 0 if VK_EXT_mesh_shader is missing or its limits are too low for
    /// Path::mesh.
    std::uint32_t max_mesh_groups = 0;
};

class Context {
  public:
    /// Errors: kNoDevice (no driver, no device that fits, no validation layer though asked for), kDeviceFailure.
    static Result<std::unique_ptr<Context>> create(const ContextOptions& options);
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    VkInstance instance() const { return instance_; }
    VkPhysicalDevice physical() const { return physical_; }
    VkDevice device() const { return device_; }
    /// For other libraries. Our code uses the queue through the three thread-safe functions below.
    VkQueue queue() const { return queue_; }
    VkResult submit(const VkSubmitInfo2& info, VkFence fence);
    VkResult present(const VkPresentInfoKHR& info);
    void wait_idle();  ///< waits for all submissions
    std::uint32_t queue_family() const { return queue_family_; }
    const DeviceInfo& info() const { return info_; }
    const VkPhysicalDeviceLimits& limits() const { return info_.limits; }
    Arena& arena() { return *arena_; }
    ValidationLog& validation() { return validation_; }
    /// Overrides of built-in shaders for new pipelines.
    ShaderSet& shaders() { return shaders_; }
    /// vkCmdDrawMeshTasksEXT; null if info().max_mesh_groups is 0.
    PFN_vkCmdDrawMeshTasksEXT draw_mesh_tasks() const { return draw_mesh_tasks_; }
    bool validating() const { return validating_; }

    /// Gives a Vulkan object a name for validation messages and debuggers.
    template <class T>
    void name(VkObjectType type, T handle, const std::string& text) const {
        name_object(type, reinterpret_cast<std::uint64_t>(handle), text);
    }

  private:
    Context() = default;
    Result<void> create_instance(const ContextOptions& options);
    Result<void> create_device(const ContextOptions& options);
    void name_object(VkObjectType type, std::uint64_t handle, const std::string& text) const;

    ValidationLog validation_;
    ShaderSet shaders_;
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::mutex queue_mutex_;
    std::uint32_t queue_family_ = 0;
    PFN_vkSetDebugUtilsObjectNameEXT set_name_ = nullptr;
    PFN_vkCmdDrawMeshTasksEXT draw_mesh_tasks_ = nullptr;
    DeviceInfo info_;
    std::unique_ptr<Arena> arena_;
    bool debug_utils_ = false;
    bool validating_ = false;
};

}  // namespace lacedring::gpu
