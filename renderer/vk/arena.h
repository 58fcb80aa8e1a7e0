#pragma once
// Allocates device memory for buffers and images from a few big blocks.

#include <vulkan/vulkan.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "lacedring/base.hpp"

namespace lacedring::gpu {

/// Who accesses a resource's memory.
enum class Memory {
    gpu,       ///< fastest for the device
    upload,    ///< the host writes it, mapped
    readback,  ///< the host reads it, mapped, cached if possible
};

/// Buffers and images never share a block, so bufferImageGranularity does not matter.
enum class Tiling { buffer, image };

struct Allocation {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize offset = 0;
    VkDeviceSize size = 0;
    /// Host pointer to `offset`; null for Memory::gpu unless the host shares the device's memory.
    std::byte* mapped = nullptr;
    std::uint32_t block = 0;
};

/// Thread-safe. First fit over sorted free ranges. An empty block is freed if it was made for one large resource.
class Arena {
  public:
    /// `limit`: bytes of device memory to hold at most; 0: as much as the device has.
    Arena(VkPhysicalDevice physical, VkDevice device, VkDeviceSize limit);
    ~Arena();
    Arena(const Arena&) = delete;
    Arena& operator=(const Arena&) = delete;

    /// Errors: kNoDevice (past maxMemoryAllocationSize, or out of memory), kDeviceFailure.
    Result<Allocation> allocate(const VkMemoryRequirements& requirements, Memory memory, Tiling tiling);
    void free(const Allocation& allocation);

    /// Checks that resources of `bytes` bytes in total can be allocated, the largest of `largest` bytes. Allocates
    /// nothing, so other programs may take the memory meanwhile. Errors: kNoDevice, with the amount missing.
    Result<void> check_room(VkDeviceSize bytes, VkDeviceSize largest) const;

    /// Bytes allocated to resources now.
    VkDeviceSize used() const { return used_.load(); }
    /// Bytes of device memory in blocks: now, and the maximum so far.
    VkDeviceSize held() const { return held_.load(); }
    VkDeviceSize peak() const { return peak_.load(); }
    std::uint32_t block_count() const;

  private:
    struct Block {
        VkDeviceMemory memory = VK_NULL_HANDLE;  // null: freed, the entry may be reused
        VkDeviceSize size = 0;
        std::uint32_t type = 0;
        Tiling tiling = Tiling::buffer;
        std::byte* mapped = nullptr;
        std::map<VkDeviceSize, VkDeviceSize> free;  // offset -> size
    };

    std::uint32_t choose_type(std::uint32_t allowed, Memory memory) const;
    bool carve(std::uint32_t block, const VkMemoryRequirements& requirements, Allocation& out);
    Result<std::uint32_t> add_block(std::uint32_t type, VkDeviceSize size, Tiling tiling);

    VkDevice device_;
    VkPhysicalDeviceMemoryProperties properties_{};
    VkDeviceSize max_allocation_ = 0;
    std::vector<Block> blocks_;
    VkDeviceSize limit_ = 0;
    mutable std::mutex mutex_;  // guards blocks_, and writes of the members below
    std::atomic<VkDeviceSize> used_ = 0, held_ = 0, peak_ = 0;
};

}  // namespace lacedring::gpu
