#pragma once
// One command buffer at a time: record, submit, wait.

#include <vulkan/vulkan.h>

#include <optional>

#include "lacedring/base.hpp"
#include "renderer/vk/handle.h"

namespace lacedring::gpu {

class Context;
class Buffer;

/// Duration of one submission.
struct Elapsed {
    double wall = 0;            ///< seconds from the submission to its fence
    std::optional<double> gpu;  ///< seconds between the timestamps, if the device has timestamps
};

class Commands {
  public:
    static Result<Commands> create(Context& context);

    /// Starts a new recording. The command buffer is valid until the next begin().
    Result<VkCommandBuffer> begin();
    /// Record timestamps before and after the commands to time; at most one pair per recording.
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
    QueryPoolHandle queries_;  // null if the queue has no timestamps
    bool timed_ = false;
};

/// A pipeline stage and its kinds of memory access.
struct Access {
    VkPipelineStageFlags2 stage = VK_PIPELINE_STAGE_2_NONE;
    VkAccessFlags2 access = VK_ACCESS_2_NONE;
};

/// Makes writes of `before` visible to `after`, for all buffers.
void memory_barrier(VkCommandBuffer commands, Access before, Access after);

/// Makes writes of `before` to one image visible to `after`, and changes its layout. A transition from
/// VK_IMAGE_LAYOUT_UNDEFINED drops the contents.
void image_barrier(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect, Access before, Access after,
                   VkImageLayout from, VkImageLayout to);

}  // namespace lacedring::gpu
