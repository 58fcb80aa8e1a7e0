#include "renderer/vk/context.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include "renderer/vk/device_choice.h"
#include "renderer/vk/device_error.h"
#include "renderer/vk/try.h"

namespace lacedring::gpu {
namespace {

std::vector<VkExtensionProperties> instance_extensions(const char* layer) {
    std::uint32_t count = 0;
    if (vkEnumerateInstanceExtensionProperties(layer, &count, nullptr) != VK_SUCCESS) return {};
    std::vector<VkExtensionProperties> extensions(count);
    if (vkEnumerateInstanceExtensionProperties(layer, &count, extensions.data()) != VK_SUCCESS) return {};
    extensions.resize(count);
    return extensions;
}

bool has(const std::vector<VkExtensionProperties>& extensions, const char* name) {
    return std::any_of(extensions.begin(), extensions.end(),
                       [&](const VkExtensionProperties& e) { return std::strcmp(e.extensionName, name) == 0; });
}

bool layer_installed(const char* name) {
    std::uint32_t count = 0;
    if (vkEnumerateInstanceLayerProperties(&count, nullptr) != VK_SUCCESS) return false;
    std::vector<VkLayerProperties> layers(count);
    if (vkEnumerateInstanceLayerProperties(&count, layers.data()) != VK_SUCCESS) return false;
    return std::any_of(layers.begin(), layers.end(),
                       [&](const VkLayerProperties& l) { return std::strcmp(l.layerName, name) == 0; });
}

std::string version(std::uint32_t v) {
    return std::to_string(VK_API_VERSION_MAJOR(v)) + "." + std::to_string(VK_API_VERSION_MINOR(v)) + "." +
           std::to_string(VK_API_VERSION_PATCH(v));
}

DeviceInfo describe(const DeviceChoice& choice) {
    VkPhysicalDeviceVulkan13Properties p13{};
    p13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES;
    VkPhysicalDeviceDriverProperties driver{};
    driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
    driver.pNext = &p13;
    VkPhysicalDeviceSubgroupProperties subgroups{};
    subgroups.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES;
    p13.pNext = &subgroups;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &driver;
    vkGetPhysicalDeviceProperties2(choice.device, &properties);
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(choice.device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(choice.device, &count, families.data());

    DeviceInfo info;
    info.name = properties.properties.deviceName;
    info.driver = std::string(driver.driverName) + (driver.driverInfo[0] != '\0' ? " " : "") + driver.driverInfo;
    info.api = version(properties.properties.apiVersion);
    info.software = properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    info.subgroup_size = subgroups.subgroupSize;
    info.limits = properties.properties.limits;
    info.max_buffer_size = p13.maxBufferSize;
    info.max_line_width = choice.wide_lines ? info.limits.lineWidthRange[1] : 1.0F;
    info.timestamps = families[choice.queue_family].timestampValidBits != 0 && info.limits.timestampPeriod > 0.0F;
    info.statistics = choice.statistics;
    info.max_mesh_groups = choice.max_mesh_groups;
    info.max_index = choice.full_index_range ? UINT32_MAX - 1 : info.limits.maxDrawIndexedIndexValue;
    return info;
}

}  // namespace

Result<std::unique_ptr<Context>> Context::create(const ContextOptions& options) {
    std::unique_ptr<Context> context(new Context);
    LR_TRY(context->create_instance(options));
    LR_TRY(context->create_device(options));
    return context;
}

Result<void> Context::create_instance(const ContextOptions& options) {
    const auto extensions = instance_extensions(nullptr);
    std::vector<const char*> layers;
    std::vector<const char*> enabled;
    if (options.validation) {
        if (!layer_installed(kValidationLayer)) {
            return Error{kNoDevice, std::string("validation was asked for, and ") + kValidationLayer +
                                        " is not installed (Debian: vulkan-validationlayers)"};
        }
        layers.push_back(kValidationLayer);
        if (!has(instance_extensions(kValidationLayer), VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME)) {
            return Error{kNoDevice, "the validation layer has no synchronization validation"};
        }
        enabled.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
    }
    // Also used without validation: it names objects for a debugger's layer.
    debug_utils_ = has(extensions, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (debug_utils_) enabled.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (options.validation && !debug_utils_) return Error{kNoDevice, "no VK_EXT_debug_utils for validation"};

    for (const char* extension : options.instance_extensions) {
        if (!has(extensions, extension)) {
            return Error{kNoDevice, std::string("the Vulkan driver has no ") + extension};
        }
        enabled.push_back(extension);
    }

    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.pApplicationName = "LacedRing";
    application.apiVersion = VK_API_VERSION_1_3;
    VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info(validation_);
    const VkValidationFeatureEnableEXT feature = options.gpu_assisted
                                                     ? VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_EXT
                                                     : VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT features{};
    features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
    features.pNext = &messenger;  // also logs messages about the creation of the instance
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = &feature;
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pNext = options.validation ? &features : nullptr;
    info.pApplicationInfo = &application;
    info.enabledLayerCount = static_cast<std::uint32_t>(layers.size());
    info.ppEnabledLayerNames = layers.data();
    info.enabledExtensionCount = static_cast<std::uint32_t>(enabled.size());
    info.ppEnabledExtensionNames = enabled.data();
    if (const VkResult result = vkCreateInstance(&info, nullptr, &instance_); result != VK_SUCCESS) {
        return Error{kNoDevice,
                     "no Vulkan driver (Debian: mesa-vulkan-drivers): vkCreateInstance: " + result_name(result)};
    }
    if (options.validation) {
        const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
        if (create == nullptr) return Error{kNoDevice, "no vkCreateDebugUtilsMessengerEXT"};
        LR_TRY_VK(create(instance_, &messenger, nullptr, &messenger_));
        validating_ = true;
    }
    return {};
}

Result<void> Context::create_device(const ContextOptions& options) {
    LR_ASSIGN(const DeviceChoice choice, choose_device(instance_, options.device));
    info_ = describe(choice);
    physical_ = choice.device;
    queue_family_ = choice.queue_family;

    VkPhysicalDeviceMeshShaderFeaturesEXT mesh{};
    mesh.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MESH_SHADER_FEATURES_EXT;
    mesh.meshShader = VK_TRUE;
    VkPhysicalDeviceVulkan12Features f12{};
    f12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    f12.bufferDeviceAddress = VK_TRUE;
    if (info_.max_mesh_groups != 0) f12.pNext = &mesh;
    VkPhysicalDeviceVulkan13Features f13{};
    f13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    f13.pNext = &f12;
    f13.dynamicRendering = VK_TRUE;
    f13.synchronization2 = VK_TRUE;
    f13.maintenance4 = VK_TRUE;
    VkPhysicalDeviceFeatures2 features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    features.pNext = &f13;
    features.features.geometryShader = VK_TRUE;
    features.features.fragmentStoresAndAtomics = VK_TRUE;
    features.features.pipelineStatisticsQuery = info_.statistics ? VK_TRUE : VK_FALSE;
    features.features.wideLines = choice.wide_lines ? VK_TRUE : VK_FALSE;
    features.features.fullDrawIndexUint32 = choice.full_index_range ? VK_TRUE : VK_FALSE;
    const float priority = 1.0F;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = queue_family_;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = &features;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    std::vector<const char*> extensions = options.device_extensions;
    if (info_.max_mesh_groups != 0) extensions.push_back(VK_EXT_MESH_SHADER_EXTENSION_NAME);
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    LR_TRY_VK(vkCreateDevice(choice.device, &info, nullptr, &device_));
    vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
    if (info_.max_mesh_groups != 0) {
        draw_mesh_tasks_ =
            reinterpret_cast<PFN_vkCmdDrawMeshTasksEXT>(vkGetDeviceProcAddr(device_, "vkCmdDrawMeshTasksEXT"));
    }
    if (debug_utils_) {
        set_name_ = reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(
            vkGetDeviceProcAddr(device_, "vkSetDebugUtilsObjectNameEXT"));
    }
    arena_ = std::make_unique<Arena>(choice.device, device_, options.memory);
    return {};
}

Context::~Context() {
    if (device_ != VK_NULL_HANDLE) {
        vkDeviceWaitIdle(device_);
        arena_.reset();
        vkDestroyDevice(device_, nullptr);
    }
    if (messenger_ != VK_NULL_HANDLE) {
        const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
        if (destroy != nullptr) destroy(instance_, messenger_, nullptr);
    }
    if (instance_ != VK_NULL_HANDLE) vkDestroyInstance(instance_, nullptr);
}

VkResult Context::submit(const VkSubmitInfo2& info, VkFence fence) {
    const std::lock_guard lock(queue_mutex_);
    return vkQueueSubmit2(queue_, 1, &info, fence);
}

VkResult Context::present(const VkPresentInfoKHR& info) {
    const std::lock_guard lock(queue_mutex_);
    return vkQueuePresentKHR(queue_, &info);
}

void Context::wait_idle() {
    const std::lock_guard lock(queue_mutex_);
    vkDeviceWaitIdle(device_);
}

void Context::name_object(VkObjectType type, std::uint64_t handle, const std::string& text) const {
    if (set_name_ == nullptr) return;
    VkDebugUtilsObjectNameInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT;
    info.objectType = type;
    info.objectHandle = handle;
    info.pObjectName = text.c_str();
    set_name_(device_, &info);  // errors do not matter: names are for debugging only
}

}  // namespace lacedring::gpu
