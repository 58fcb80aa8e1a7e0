#pragma once
#include <vulkan/vulkan.h>

#include <array>
#include <cstdint>
#include <string>

#include "lacedring/base.hpp"
#include "renderer/vk/arena.h"

namespace lacedring::gpu {

class Context;

/// A buffer and its memory.
class Buffer {
  public:
    Buffer() = default;
    /// Transfer source and destination are always allowed. A size of 0 becomes 16 bytes, so that every buffer can be
    /// bound. Errors: kNoDevice (not enough memory), kDeviceFailure.
    static Result<Buffer> create(Context& context, const std::string& name, VkDeviceSize size, VkBufferUsageFlags usage,
                                 Memory memory = Memory::gpu);
    Buffer(Buffer&& other) noexcept;
    Buffer& operator=(Buffer&& other) noexcept;
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;
    ~Buffer();

    VkBuffer handle() const { return buffer_; }
    VkDeviceSize size() const { return size_; }
    /// The device address; 0 unless the usage includes VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT.
    VkDeviceAddress address() const { return address_; }
    /// The device address as a uvec2 of GL_EXT_buffer_reference_uvec2: the low half first.
    std::array<std::uint32_t, 2> address_words() const {
        return {static_cast<std::uint32_t>(address_), static_cast<std::uint32_t>(address_ >> 32)};
    }
    /// Host pointer to the buffer's bytes; null for Memory::gpu on most devices.
    std::byte* mapped() const { return allocation_.mapped; }
    explicit operator bool() const { return buffer_ != VK_NULL_HANDLE; }

  private:
    void reset();

    Context* context_ = nullptr;
    VkBuffer buffer_ = VK_NULL_HANDLE;
    VkDeviceSize size_ = 0;
    VkDeviceAddress address_ = 0;
    Allocation allocation_;
};

}  // namespace lacedring::gpu
