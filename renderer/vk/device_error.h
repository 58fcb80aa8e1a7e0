#pragma once
// The renderer's error codes: values of ErrorCode past those of the library.

#include "lacedring/base.hpp"

namespace lacedring::gpu {

/// No usable Vulkan device, or it lacks what was asked for: memory, sizes, features.
constexpr ErrorCode kNoDevice = static_cast<ErrorCode>(kFirstOwnErrorCode);
/// A Vulkan call failed.
constexpr ErrorCode kDeviceFailure = static_cast<ErrorCode>(kFirstOwnErrorCode + 1);

}  // namespace lacedring::gpu
