#include "renderer/vk/arena.h"

#include <algorithm>
#include <cassert>

#include "renderer/vk/device_error.h"
#include "renderer/vk/try.h"

namespace lacedring::gpu {
namespace {

constexpr VkDeviceSize kBlockSize = VkDeviceSize{64} << 20;
constexpr std::uint32_t kNoType = UINT32_MAX;

VkDeviceSize align_up(VkDeviceSize value, VkDeviceSize alignment) {
    return (value + alignment - 1) / alignment * alignment;
}

}  // namespace

Arena::Arena(VkPhysicalDevice physical, VkDevice device, VkDeviceSize limit) : device_(device) {
    vkGetPhysicalDeviceMemoryProperties(physical, &properties_);
    VkPhysicalDeviceMaintenance3Properties limits{};
    limits.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &limits;
    vkGetPhysicalDeviceProperties2(physical, &properties);
    max_allocation_ = limits.maxMemoryAllocationSize;
    const std::uint32_t type = choose_type(UINT32_MAX, Memory::gpu);
    limit_ = type == kNoType ? 0 : properties_.memoryHeaps[properties_.memoryTypes[type].heapIndex].size;
    if (limit != 0) limit_ = std::min(limit_, limit);
}

Arena::~Arena() {
    for (const Block& block : blocks_) {
        if (block.memory != VK_NULL_HANDLE) vkFreeMemory(device_, block.memory, nullptr);
    }
}

std::uint32_t Arena::choose_type(std::uint32_t allowed, Memory memory) const {
    constexpr VkMemoryPropertyFlags kHost = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const VkMemoryPropertyFlags required = memory == Memory::gpu ? 0 : kHost;
    VkMemoryPropertyFlags preferred = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    if (memory == Memory::upload) preferred = 0;
    if (memory == Memory::readback) preferred = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    std::uint32_t fallback = kNoType;
    for (std::uint32_t i = 0; i < properties_.memoryTypeCount; ++i) {
        const VkMemoryPropertyFlags flags = properties_.memoryTypes[i].propertyFlags;
        if ((allowed >> i & 1) == 0 || (flags & required) != required) continue;
        if ((flags & preferred) == preferred) return i;
        if (fallback == kNoType) fallback = i;
    }
    return fallback;
}

Result<void> Arena::check_room(VkDeviceSize bytes, VkDeviceSize largest) const {
    const auto mebibytes = [](VkDeviceSize n) { return std::to_string((n + (1U << 20) - 1) >> 20) + " MiB"; };
    if (largest > max_allocation_) {
        return Error{kNoDevice, "a buffer of " + mebibytes(largest) + " is needed; the device gives at most " +
                                    mebibytes(max_allocation_)};
    }
    const VkDeviceSize room = limit_ - std::min(used(), limit_);
    if (bytes <= room) return {};
    return Error{kNoDevice, mebibytes(bytes) + " of device memory are needed; " + mebibytes(room) + " are left"};
}

bool Arena::carve(std::uint32_t index, const VkMemoryRequirements& requirements, Allocation& out) {
    Block& block = blocks_[index];
    for (auto it = block.free.begin(); it != block.free.end(); ++it) {
        const auto [begin, size] = *it;
        const VkDeviceSize offset = align_up(begin, requirements.alignment);
        const VkDeviceSize end = offset + requirements.size;
        if (end > begin + size) continue;
        block.free.erase(it);
        if (offset > begin) block.free.emplace(begin, offset - begin);
        if (end < begin + size) block.free.emplace(end, begin + size - end);
        used_ += requirements.size;
        out = {block.memory, offset, requirements.size, block.mapped == nullptr ? nullptr : block.mapped + offset,
               index};
        return true;
    }
    return false;
}

Result<std::uint32_t> Arena::add_block(std::uint32_t type, VkDeviceSize size, Tiling tiling) {
    VkMemoryAllocateFlagsInfo flags{};
    flags.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO;
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    if (tiling == Tiling::buffer) info.pNext = &flags;
    info.allocationSize = size;
    info.memoryTypeIndex = type;
    Block block;
    LR_TRY_VK(vkAllocateMemory(device_, &info, nullptr, &block.memory));
    block.size = size;
    block.type = type;
    block.tiling = tiling;
    block.free.emplace(0, size);
    if ((properties_.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0) {
        void* mapped = nullptr;
        if (const VkResult result = vkMapMemory(device_, block.memory, 0, VK_WHOLE_SIZE, 0, &mapped);
            result != VK_SUCCESS) {
            vkFreeMemory(device_, block.memory, nullptr);
            return check(result, "vkMapMemory").error();
        }
        block.mapped = static_cast<std::byte*>(mapped);
    }
    held_ += size;
    peak_ = std::max(peak(), held());
    const auto hole =
        std::find_if(blocks_.begin(), blocks_.end(), [](const Block& b) { return b.memory == VK_NULL_HANDLE; });
    const auto index = static_cast<std::uint32_t>(hole - blocks_.begin());
    if (hole == blocks_.end()) {
        blocks_.push_back(std::move(block));
    } else {
        *hole = std::move(block);
    }
    return index;
}

Result<Allocation> Arena::allocate(const VkMemoryRequirements& requirements, Memory memory, Tiling tiling) {
    const std::uint32_t type = choose_type(requirements.memoryTypeBits, memory);
    if (type == kNoType) return Error{kDeviceFailure, "no memory type fits a resource"};
    if (requirements.size > max_allocation_) {
        return Error{kNoDevice, std::to_string(requirements.size) + " bytes in one resource; the device gives " +
                                    std::to_string(max_allocation_)};
    }
    const std::lock_guard lock(mutex_);
    Allocation out;
    for (std::uint32_t i = 0; i < blocks_.size(); ++i) {
        if (blocks_[i].memory == VK_NULL_HANDLE || blocks_[i].type != type || blocks_[i].tiling != tiling) continue;
        if (carve(i, requirements, out)) return out;
    }
    // Blocks are a small share of a small heap, such as the 256 MiB host-visible window of a GPU's memory.
    const VkDeviceSize usual = std::min({kBlockSize, max_allocation_, std::max(limit_ / 16, VkDeviceSize{1} << 20)});
    const VkDeviceSize room = limit_ - std::min(held(), limit_);
    if (requirements.size > room) {
        return Error{kNoDevice, std::to_string(requirements.size) + " bytes; " + std::to_string(room) +
                                    " are left of the device memory that may be held"};
    }
    LR_ASSIGN(const std::uint32_t index, add_block(type, std::max(std::min(usual, room), requirements.size), tiling));
    const bool fits = carve(index, requirements, out);
    assert(fits);
    (void)fits;
    return out;
}

void Arena::free(const Allocation& allocation) {
    const std::lock_guard lock(mutex_);
    used_ -= allocation.size;
    Block& block = blocks_[allocation.block];
    auto [it, inserted] = block.free.emplace(allocation.offset, allocation.size);
    assert(inserted);
    (void)inserted;
    if (const auto after = std::next(it); after != block.free.end() && it->first + it->second == after->first) {
        it->second += after->second;
        block.free.erase(after);
    }
    if (it != block.free.begin()) {
        const auto before = std::prev(it);
        if (before->first + before->second == it->first) {
            before->second += it->second;
            block.free.erase(it);
            it = before;
        }
    }
    if (it->second == block.size && block.size > kBlockSize) {
        vkFreeMemory(device_, block.memory, nullptr);  // also unmaps
        held_ -= block.size;
        block = Block{};
    }
}

std::uint32_t Arena::block_count() const {
    const std::lock_guard lock(mutex_);
    return static_cast<std::uint32_t>(
        std::count_if(blocks_.begin(), blocks_.end(), [](const Block& b) { return b.memory != VK_NULL_HANDLE; }));
}

}  // namespace lacedring::gpu
