#pragma once
// Chooses one of the machine's Vulkan devices, and says why the others are not usable.

#include <vulkan/vulkan.h>

#include <string>
#include <vector>

#include "lacedring/base.hpp"

namespace lacedring::gpu {

/// A device that has everything needed.
struct DeviceChoice {
    VkPhysicalDevice device = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0;  ///< has graphics and compute
    bool wide_lines = false;
    bool full_index_range = false;      ///< index values past 2^24 are allowed
    bool statistics = false;            ///< pipeline statistics queries
    std::uint32_t max_mesh_groups = 0;  ///< DeviceInfo::max_mesh_groups
};

/// Names of the features, formats and versions that the renderer needs and the device lacks. Empty: usable.
std::vector<std::string> missing_features(VkPhysicalDevice device);

/// Returns the best usable device; prefers GPUs to software devices. `name`, if not empty, must be part of the name of
/// the device or driver, or of the driver's usual name (lavapipe calls itself llvmpipe); case does not matter.
/// Errors: kNoDevice, with one line that says for every device why it was rejected.
Result<DeviceChoice> choose_device(VkInstance instance, const std::string& name);

}  // namespace lacedring::gpu
