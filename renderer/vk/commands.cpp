#include "renderer/vk/commands.h"

#include <array>
#include <chrono>

#include "renderer/vk/context.h"
#include "renderer/vk/try.h"

namespace lacedring::gpu {

Result<Commands> Commands::create(Context& context) {
    Commands out;
    out.context_ = &context;
    const VkDevice device = context.device();
    VkCommandPoolCreateInfo pool_info{};
    pool_info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool_info.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    pool_info.queueFamilyIndex = context.queue_family();
    VkCommandPool pool = VK_NULL_HANDLE;
    LR_TRY_VK(vkCreateCommandPool(device, &pool_info, nullptr, &pool));
    out.pool_ = {device, pool};
    VkCommandBufferAllocateInfo buffer_info{};
    buffer_info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    buffer_info.commandPool = pool;
    buffer_info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    buffer_info.commandBufferCount = 1;
    LR_TRY_VK(vkAllocateCommandBuffers(device, &buffer_info, &out.buffer_));
    VkFenceCreateInfo fence_info{};
    fence_info.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    VkFence fence = VK_NULL_HANDLE;
    LR_TRY_VK(vkCreateFence(device, &fence_info, nullptr, &fence));
    out.fence_ = {device, fence};
    if (context.info().timestamps) {
        VkQueryPoolCreateInfo query_info{};
        query_info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
        query_info.queryType = VK_QUERY_TYPE_TIMESTAMP;
        query_info.queryCount = 2;
        VkQueryPool queries = VK_NULL_HANDLE;
        LR_TRY_VK(vkCreateQueryPool(device, &query_info, nullptr, &queries));
        out.queries_ = {device, queries};
    }
    return out;
}

Result<VkCommandBuffer> Commands::begin() {
    LR_TRY_VK(vkResetCommandPool(context_->device(), pool_.get(), 0));
    VkCommandBufferBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    LR_TRY_VK(vkBeginCommandBuffer(buffer_, &info));
    timed_ = false;
    // Earlier submissions have ended (run() waits for its fence). This barrier makes their writes visible.
    memory_barrier(buffer_, {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT},
                   {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT});
    return buffer_;
}

void Commands::start_timer() {
    if (!queries_) return;
    vkCmdResetQueryPool(buffer_, queries_.get(), 0, 2);
    vkCmdWriteTimestamp2(buffer_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_.get(), 0);
}

void Commands::stop_timer() {
    if (!queries_) return;
    vkCmdWriteTimestamp2(buffer_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_.get(), 1);
    timed_ = true;
}

Result<Elapsed> Commands::run() {
    LR_TRY_VK(vkEndCommandBuffer(buffer_));
    const VkFence fence = fence_.get();
    LR_TRY_VK(vkResetFences(context_->device(), 1, &fence));
    VkCommandBufferSubmitInfo command_info{};
    command_info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO;
    command_info.commandBuffer = buffer_;
    VkSubmitInfo2 submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &command_info;
    const auto start = std::chrono::steady_clock::now();
    LR_TRY(check(context_->submit(submit, fence), "vkQueueSubmit2"));
    LR_TRY_VK(vkWaitForFences(context_->device(), 1, &fence, VK_TRUE, UINT64_MAX));
    Elapsed elapsed;
    elapsed.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (timed_) {
        std::array<std::uint64_t, 2> ticks{};
        LR_TRY_VK(vkGetQueryPoolResults(context_->device(), queries_.get(), 0, 2, sizeof(ticks), ticks.data(),
                                        sizeof(ticks[0]), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT));
        elapsed.gpu =
            static_cast<double>(ticks[1] - ticks[0]) * static_cast<double>(context_->limits().timestampPeriod) * 1e-9;
    }
    return elapsed;
}

void memory_barrier(VkCommandBuffer commands, Access before, Access after) {
    VkMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
    barrier.srcStageMask = before.stage;
    barrier.srcAccessMask = before.access;
    barrier.dstStageMask = after.stage;
    barrier.dstAccessMask = after.access;
    VkDependencyInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &info);
}

void image_barrier(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect, Access before, Access after,
                   VkImageLayout from, VkImageLayout to) {
    VkImageMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
    barrier.srcStageMask = before.stage;
    barrier.srcAccessMask = before.access;
    barrier.dstStageMask = after.stage;
    barrier.dstAccessMask = after.access;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {aspect, 0, 1, 0, 1};
    VkDependencyInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &info);
}

}  // namespace lacedring::gpu
