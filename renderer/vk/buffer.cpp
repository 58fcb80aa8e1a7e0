#include "renderer/vk/buffer.h"

#include <algorithm>
#include <utility>

#include "renderer/vk/context.h"
#include "renderer/vk/device_error.h"
#include "renderer/vk/try.h"

namespace lacedring::gpu {

Result<Buffer> Buffer::create(Context& context, const std::string& name, VkDeviceSize size, VkBufferUsageFlags usage,
                              Memory memory) {
    size = std::max<VkDeviceSize>(size, 16);
    if (size > context.info().max_buffer_size) {
        return Error{kNoDevice, name + ": " + std::to_string(size) + " bytes; the device allows buffers of " +
                                    std::to_string(context.info().max_buffer_size)};
    }
    Buffer out;
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = size;
    info.usage = usage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    info.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
    VkBuffer buffer = VK_NULL_HANDLE;
    LR_TRY_VK(vkCreateBuffer(context.device(), &info, nullptr, &buffer));
    VkMemoryRequirements requirements{};
    vkGetBufferMemoryRequirements(context.device(), buffer, &requirements);
    auto allocation = context.arena().allocate(requirements, memory, Tiling::buffer);
    if (!allocation) {
        vkDestroyBuffer(context.device(), buffer, nullptr);
        return Error{allocation.error().code, name + ": " + allocation.error().message};
    }
    out.context_ = &context;
    out.buffer_ = buffer;
    out.size_ = size;
    out.allocation_ = *allocation;
    LR_TRY_VK(vkBindBufferMemory(context.device(), buffer, allocation->memory, allocation->offset));
    context.name(VK_OBJECT_TYPE_BUFFER, buffer, name);
    if ((usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT) != 0) {
        VkBufferDeviceAddressInfo address{};
        address.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
        address.buffer = buffer;
        out.address_ = vkGetBufferDeviceAddress(context.device(), &address);
    }
    return out;
}

Buffer::Buffer(Buffer&& other) noexcept
    : context_(other.context_),
      buffer_(std::exchange(other.buffer_, VK_NULL_HANDLE)),
      size_(other.size_),
      address_(other.address_),
      allocation_(other.allocation_) {}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    if (this != &other) {
        reset();
        context_ = other.context_;
        buffer_ = std::exchange(other.buffer_, VK_NULL_HANDLE);
        size_ = other.size_;
        address_ = other.address_;
        allocation_ = other.allocation_;
    }
    return *this;
}

Buffer::~Buffer() {
    reset();
}

void Buffer::reset() {
    if (buffer_ == VK_NULL_HANDLE) return;
    vkDestroyBuffer(context_->device(), buffer_, nullptr);
    context_->arena().free(allocation_);
    buffer_ = VK_NULL_HANDLE;
}

}  // namespace lacedring::gpu
