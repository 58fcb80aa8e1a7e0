#pragma once
// One command buffer at a time: record, submit, wait.

#include <vulkan/vulkan.h>

#include <optional>

#include "lacedring/base.hpp"
#include "renderer/vk/handle.h"

namespace lacedring::gpu {

class Context;
class Buffer;

/// How long the work of one submission took.
struct Elapsed {
    double wall = 0;            ///< seconds from submitting to the fence
    std::optional<double> gpu;  ///< seconds between the timestamps, where the device has them
};

class Commands {
  public:
    static Result<Commands> create(Context& context);

    /// Starts recording, anew. The command buffer is valid until the next begin().
    Result<VkCommandBuffer> begin();
    /// Timestamps around what is recorded between them; at most one pair a recording.
    void start_timer();
    void stop_timer();
    /// Ends recording, runs it, and waits for it.
    Result<Elapsed> run();

  private:
    Commands() = default;

    Context* context_ = nullptr;
    CommandPoolHandle pool_;
    VkCommandBuffer buffer_ = VK_NULL_HANDLE;
    FenceHandle fence_;
    QueryPoolHandle queries_;  // null where the queue has no timestamps
    bool timed_ = false;
};

/// A stage and what it does to memory.
struct Access {
    VkPipelineStageFlags2 stage = VK_PIPELINE_STAGE_2_NONE;
    VkAccessFlags2 access = VK_ACCESS_2_NONE;
};

/// Everything written as `before` is visible to `after`, on all buffers.
void memory_barrier(VkCommandBuffer commands, Access before, Access after);

/// The same for one image, with a change of layout. From VK_IMAGE_LAYOUT_UNDEFINED, the contents are dropped.
void image_barrier(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect, Access before, Access after,
                   VkImageLayout from, VkImageLayout to);

}  // namespace lacedring::gpu
