#include "renderer/vk/validation.h"

#include <cstring>

namespace lacedring::gpu {
namespace {

/// True for messages that do not report a fault of this program.
bool is_noise(const VkDebugUtilsMessengerCallbackDataEXT& data) {
    // The loader's messages concern the machine, not this program: for example, a driver that hides another one.
    if (data.pMessageIdName != nullptr && std::strcmp(data.pMessageIdName, "Loader Message") == 0) return true;
    // `invariant gl_Position` decorates a member of gl_PerVertex. Vulkan allows this (VUID-Invariant-Invariant-04677),
    // but the SPIR-V validator in layer version 1.3.239 warns about it.
    constexpr const char* kInvariant = "Decoration not allowed on struct members: SpvDecorationInvariant";
    return data.pMessage != nullptr && std::strstr(data.pMessage, kInvariant) != nullptr;
}

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    if (!is_noise(*data)) {
        static_cast<ValidationLog*>(user)->add(data->pMessage != nullptr ? data->pMessage : "(no text)");
    }
    return VK_FALSE;
}

}  // namespace

void ValidationLog::add(std::string message) {
    const std::lock_guard lock(mutex_);
    messages_.push_back(std::move(message));
}

std::size_t ValidationLog::count() const {
    const std::lock_guard lock(mutex_);
    return messages_.size();
}

std::vector<std::string> ValidationLog::messages() const {
    const std::lock_guard lock(mutex_);
    return messages_;
}

void ValidationLog::clear() {
    const std::lock_guard lock(mutex_);
    messages_.clear();
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info(ValidationLog& log) {
    VkDebugUtilsMessengerCreateInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                       VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = on_message;
    info.pUserData = &log;
    return info;
}

}  // namespace lacedring::gpu
