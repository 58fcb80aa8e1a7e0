#pragma once
// Which of the machine's Vulkan devices is used, and why the others are not.

#include <vulkan/vulkan.h>

#include <string>
#include <vector>

#include "lacedring/base.hpp"

namespace lacedring::gpu {

/// A device that has everything needed.
struct DeviceChoice {
    VkPhysicalDevice device = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0;  ///< graphics and compute
    bool wide_lines = false;
    bool full_index_range = false;      ///< indices past 2^24
    bool statistics = false;            ///< pipeline statistics queries
    std::uint32_t max_mesh_groups = 0;  ///< of a draw command; 0: no mesh shaders, or too small ones
};

/// What a device lacks of what the renderer needs: names of features, formats and versions. Empty: usable.
std::vector<std::string> missing_features(VkPhysicalDevice device);

/// The best usable device: a GPU before a software one. `name`, if not empty, must be part of the device's name, of the
/// driver's, or of the name by which that driver is usually known ("lavapipe" calls itself llvmpipe); case does not
/// matter. Errors: kNoDevice, one line with every device and what is wrong with it.
Result<DeviceChoice> choose_device(VkInstance instance, const std::string& name);

}  // namespace lacedring::gpu
