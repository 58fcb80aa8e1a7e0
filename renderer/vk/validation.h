#pragma once
// Collects the messages of the validation layers.

#include <vulkan/vulkan.h>

#include <mutex>
#include <string>
#include <vector>

namespace lacedring::gpu {

/// Every message of warning or error severity, in order. Thread-safe: layers call from the thread of a Vulkan call.
class ValidationLog {
  public:
    void add(std::string message);
    std::size_t count() const;
    std::vector<std::string> messages() const;
    void clear();

  private:
    mutable std::mutex mutex_;
    std::vector<std::string> messages_;
};

inline constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

/// Sends warnings and errors to `log`, which must outlive the messenger.
VkDebugUtilsMessengerCreateInfoEXT messenger_info(ValidationLog& log);

}  // namespace lacedring::gpu
