#pragma once
// Early returns for Result and VkResult.

#include <vulkan/vulkan.h>

#include <string>

#include "lacedring/base.hpp"
#include "lrcore/base/try.h"

namespace lacedring::gpu {

/// The name of a result, such as "VK_ERROR_DEVICE_LOST"; the number if the name is unknown.
std::string result_name(VkResult result);

/// Converts a result other than VK_SUCCESS to an error that names the call: kNoDevice if out of memory, else
/// kDeviceFailure.
Result<void> check(VkResult result, const char* call);

}  // namespace lacedring::gpu

/// Returns from the calling function with an error unless a Vulkan call gave VK_SUCCESS.
#define LR_TRY_VK(call) LR_TRY(::lacedring::gpu::check((call), #call))
