// Preloaded into the viewer by test_faults.py. Environment variables switch on faults: a disk that does not answer, no
// threads, a device with small images, a window that does not shrink.

#include <dlfcn.h>
#include <pthread.h>
#include <unistd.h>
#include <vulkan/vulkan.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace {

template <class Function>
Function next(const char* name) {
    return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

/// Returns whether the descriptor's path ends with the variable's value.
bool is_slow(int descriptor) {
    const char* end = std::getenv("FAULT_SLOW_FILE");
    if (end == nullptr) return false;
    char link[64], path[4096];
    std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
    const ssize_t size = readlink(link, path, sizeof path);
    return size > 0 && std::string_view(path, static_cast<std::size_t>(size)).ends_with(end);
}

/// Returns whether the C++ library is the caller. Drivers create threads without it.
bool from_cxx_library(const void* caller) {
    Dl_info info{};
    return dladdr(caller, &info) != 0 && info.dli_fname != nullptr &&
           std::strstr(info.dli_fname, "libstdc++") != nullptr;
}

}  // namespace

extern "C" {

ssize_t read(int descriptor, void* to, size_t size) {
    if (is_slow(descriptor)) {
        const char* seconds = std::getenv("FAULT_SLOW_SECONDS");
        const int saved = errno;
        usleep(1);
        sleep(static_cast<unsigned>(seconds != nullptr ? std::atoi(seconds) : 3600));
        errno = saved;
    }
    static const auto real = next<ssize_t (*)(int, void*, size_t)>("read");
    return real(descriptor, to, size);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*work)(void*), void* argument) {
    static std::atomic<int> started = 0;
    const char* most = std::getenv("FAULT_THREADS");
    if (most != nullptr && from_cxx_library(__builtin_return_address(0)) && started++ >= std::atoi(most)) return EAGAIN;
    static const auto real =
        next<int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*)>("pthread_create");
    return real(thread, attributes, work, argument);
}

void glfwSetWindowSize(void* window, int width, int height) {
    static const auto real = next<void (*)(void*, int, int)>("glfwSetWindowSize");
    const char* limit = std::getenv("FAULT_IMAGE_LIMIT");
    const bool shrinks = limit != nullptr && std::max(width, height) == std::atoi(limit);
    if (shrinks && std::getenv("FAULT_WINDOW_STAYS") != nullptr) return;
    real(window, width, height);
}

void vkGetPhysicalDeviceProperties2(VkPhysicalDevice device, VkPhysicalDeviceProperties2* properties) {
    static const auto real = next<PFN_vkGetPhysicalDeviceProperties2>("vkGetPhysicalDeviceProperties2");
    real(device, properties);
    std::uint32_t& limit = properties->properties.limits.maxImageDimension2D;
    const char* most = std::getenv("FAULT_IMAGE_LIMIT");
    if (most != nullptr) limit = std::min(limit, static_cast<std::uint32_t>(std::atoi(most)));
}

}  // extern "C"
