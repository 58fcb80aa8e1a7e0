#pragma once
// Early returns for Result and VkResult.

#include <vulkan/vulkan.h>

#include <string>
#include <utility>

#include "lacedring/base.hpp"

namespace lacedring::gpu {

/// "VK_ERROR_DEVICE_LOST", or the number of a code that is not known here.
std::string result_name(VkResult result);

/// kDeviceFailure, naming the call, unless the result is VK_SUCCESS. Out of memory is kNoDevice.
Result<void> check(VkResult result, const char* call);

}  // namespace lacedring::gpu

#define LR_CONCAT_(a, b) a##b
#define LR_CONCAT(a, b) LR_CONCAT_(a, b)

/// Returns the error of a Result, if it is one.
#define LR_TRY(expression)                                                 \
    do {                                                                   \
        if (auto lr_try_ = (expression); !lr_try_) return lr_try_.error(); \
    } while (false)

/// LR_ASSIGN(auto x, f()): x is the value of the Result that f returns; its error is returned.
#define LR_ASSIGN(declaration, expression) LR_ASSIGN_(LR_CONCAT(lr_result_, __LINE__), declaration, expression)
#define LR_ASSIGN_(name, declaration, expression) \
    auto name = (expression);                     \
    if (!name) return name.error();               \
    declaration = std::move(name).value()

/// Returns an error unless a Vulkan call gave VK_SUCCESS.
#define LR_TRY_VK(call) LR_TRY(::lacedring::gpu::check((call), #call))
