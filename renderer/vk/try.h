#pragma once
// Early returns for Result and VkResult.

#include <vulkan/vulkan.h>

#include <string>

#include "lacedring/base.hpp"
#include "lrcore/base/try.h"

namespace lacedring::gpu {

/// "VK_ERROR_DEVICE_LOST", or the number of a code that is not known here.
std::string result_name(VkResult result);

/// kDeviceFailure, naming the call, unless the result is VK_SUCCESS. Out of memory is kNoDevice.
Result<void> check(VkResult result, const char* call);

}  // namespace lacedring::gpu

/// Returns an error unless a Vulkan call gave VK_SUCCESS.
#define LR_TRY_VK(call) LR_TRY(::lacedring::gpu::check((call), #call))
