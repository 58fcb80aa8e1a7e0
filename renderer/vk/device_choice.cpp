#include "renderer/vk/device_choice.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <optional>

#include "renderer/vk/device_error.h"
#include "renderer/vk/try.h"
#include "shaders/shared.h"

namespace lacedring::gpu {
namespace {

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// The usual name of a driver that calls itself something else; null for other drivers.
const char* usual_name(VkDriverId driver) {
    switch (driver) {
        case VK_DRIVER_ID_MESA_LLVMPIPE:
            return "lavapipe";
        case VK_DRIVER_ID_INTEL_OPEN_SOURCE_MESA:
            return "ANV";
        default:
            return nullptr;
    }
}

/// All names by which a device may be requested.
std::vector<std::string> names_of(VkPhysicalDevice device) {
    VkPhysicalDeviceDriverProperties driver{};
    driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    vkGetPhysicalDeviceProperties(device, &properties.properties);
    std::vector<std::string> out{properties.properties.deviceName};
    if (properties.properties.apiVersion < VK_API_VERSION_1_2) return out;
    properties.pNext = &driver;
    vkGetPhysicalDeviceProperties2(device, &properties);
    out.emplace_back(driver.driverName);
    if (const char* usual = usual_name(driver.driverID); usual != nullptr) out.emplace_back(usual);
    return out;
}

std::optional<std::uint32_t> graphics_compute_family(VkPhysicalDevice device) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (std::uint32_t i = 0; i < count; ++i) {
        if ((families[i].queueFlags & kNeeded) == kNeeded) return i;
    }
    return std::nullopt;
}

bool format_has(VkPhysicalDevice device, VkFormat format, VkFormatFeatureFlags features) {
    VkFormatProperties properties{};
    vkGetPhysicalDeviceFormatProperties(device, format, &properties);
    return (properties.optimalTilingFeatures & features) == features;
}

int rank(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return 4;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return 3;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return 2;
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            return 1;
        default:
            return 0;
    }
}

/// The largest number of workgroups of surface.mesh in a draw command; 0 if the device cannot run it.
std::uint32_t mesh_groups(VkPhysicalDevice device) {
    std::uint32_t count = 0;
    if (vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr) != VK_SUCCESS) return 0;
    std::vector<VkExtensionProperties> extensions(count);
    if (vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data()) != VK_SUCCESS) return 0;
    if (std::none_of(extensions.begin(), extensions.end(), [](const VkExtensionProperties& e) {
            return std::strcmp(e.extensionName, VK_EXT_MESH_SHADER_EXTENSION_NAME) == 0;
        })) {
        return 0;
    }
    VkPhysicalDeviceMeshShaderFeaturesEXT mesh{};
    mesh.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MESH_SHADER_FEATURES_EXT;
    VkPhysicalDeviceFeatures2 features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    features.pNext = &mesh;
    vkGetPhysicalDeviceFeatures2(device, &features);
    VkPhysicalDeviceMeshShaderPropertiesEXT limits{};
    limits.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MESH_SHADER_PROPERTIES_EXT;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &limits;
    vkGetPhysicalDeviceProperties2(device, &properties);
    const bool fits = mesh.meshShader == VK_TRUE && limits.maxMeshOutputVertices >= 3 * LR_MESH_TRIANGLES &&
                      limits.maxMeshOutputPrimitives >= LR_MESH_TRIANGLES &&
                      limits.maxMeshWorkGroupInvocations >= LR_MESH_TRIANGLES;
    return fits ? std::min(limits.maxMeshWorkGroupCount[0], limits.maxMeshWorkGroupTotalCount) : 0;
}

std::string join(const std::vector<std::string>& parts, const char* between) {
    std::string out;
    for (const std::string& part : parts) out += (out.empty() ? "" : between) + part;
    return out;
}

}  // namespace

std::vector<std::string> missing_features(VkPhysicalDevice device) {
    std::vector<std::string> missing;
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(device, &properties);
    if (properties.apiVersion < VK_API_VERSION_1_3) {
        missing.push_back("Vulkan 1.3 (it has " + std::to_string(VK_API_VERSION_MAJOR(properties.apiVersion)) + "." +
                          std::to_string(VK_API_VERSION_MINOR(properties.apiVersion)) + ")");
        return missing;  // an older driver may not know the structs below
    }
    VkPhysicalDeviceVulkan12Features f12{};
    f12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    VkPhysicalDeviceVulkan13Features f13{};
    f13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    f13.pNext = &f12;
    VkPhysicalDeviceFeatures2 f{};
    f.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    f.pNext = &f13;
    vkGetPhysicalDeviceFeatures2(device, &f);
    const auto need = [&](VkBool32 has, const char* what) {
        if (has != VK_TRUE) missing.emplace_back(what);
    };
    need(f12.bufferDeviceAddress, "bufferDeviceAddress");
    need(f13.dynamicRendering, "dynamicRendering");
    need(f13.synchronization2, "synchronization2");
    need(f13.maintenance4, "maintenance4 (workgroup sizes as SPIR-V 1.6 gives them)");
    need(f.features.geometryShader, "geometryShader (gl_PrimitiveID in fragment shaders)");
    need(f.features.fragmentStoresAndAtomics, "fragmentStoresAndAtomics");
    const auto need_format = [&](VkFormat format, VkFormatFeatureFlags features, const char* what) {
        if (!format_has(device, format, features)) missing.emplace_back(what);
    };
    need_format(VK_FORMAT_R8G8B8A8_UNORM,
                VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT | VK_FORMAT_FEATURE_TRANSFER_SRC_BIT,
                "R8G8B8A8_UNORM as a blended color attachment");
    need_format(VK_FORMAT_R32_UINT,
                VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_STORAGE_IMAGE_ATOMIC_BIT |
                    VK_FORMAT_FEATURE_TRANSFER_SRC_BIT,
                "R32_UINT as a color attachment and with atomics");
    need_format(VK_FORMAT_D32_SFLOAT, VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT, "D32_SFLOAT as a depth buffer");
    if (!graphics_compute_family(device)) missing.emplace_back("a queue for graphics and compute");
    return missing;
}

Result<DeviceChoice> choose_device(VkInstance instance, const std::string& name) {
    std::uint32_t count = 0;
    LR_TRY_VK(vkEnumeratePhysicalDevices(instance, &count, nullptr));
    std::vector<VkPhysicalDevice> devices(count);
    LR_TRY_VK(vkEnumeratePhysicalDevices(instance, &count, devices.data()));
    if (devices.empty()) {
        return Error{kNoDevice, "no Vulkan device: no driver is installed (Debian: mesa-vulkan-drivers)"};
    }
    VkPhysicalDevice best = VK_NULL_HANDLE;
    int best_rank = -1;
    std::vector<std::string> rejected;
    for (const VkPhysicalDevice device : devices) {
        const std::vector<std::string> names = names_of(device);
        const bool named = std::any_of(names.begin(), names.end(), [&](const std::string& one) {
            return lower(one).find(lower(name)) != std::string::npos;
        });
        if (!named) {
            const std::string drivers = join({names.begin() + 1, names.end()}, ", ");
            rejected.push_back(names[0] + (drivers.empty() ? "" : " (driver " + drivers + ")") + ": not named \"" +
                               name + "\"");
            continue;
        }
        if (const auto missing = missing_features(device); !missing.empty()) {
            rejected.push_back(names[0] + ": lacks " + join(missing, ", "));
            continue;
        }
        VkPhysicalDeviceProperties properties{};
        vkGetPhysicalDeviceProperties(device, &properties);
        if (rank(properties.deviceType) > best_rank) {
            best = device;
            best_rank = rank(properties.deviceType);
        }
    }
    if (best == VK_NULL_HANDLE) {
        return Error{kNoDevice, "no usable Vulkan device: " + join(rejected, "; ")};
    }
    VkPhysicalDeviceFeatures features{};
    vkGetPhysicalDeviceFeatures(best, &features);
    return DeviceChoice{best,
                        *graphics_compute_family(best),
                        features.wideLines == VK_TRUE,
                        features.fullDrawIndexUint32 == VK_TRUE,
                        features.pipelineStatisticsQuery == VK_TRUE,
                        mesh_groups(best)};
}

}  // namespace lacedring::gpu
