#include "renderer/decoder.h"

#include "renderer/commands.h"

namespace lacedring::gpu {

void Decoder::record(VkCommandBuffer commands, const DecodePlan& plan) const {
    for (const DecodePlan::Dispatch& dispatch : plan.dispatches) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipelines_[dispatch.pipeline].get());
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.pipeline(), 0, 1, &dispatch.set, 0,
                                nullptr);
        vkCmdPushConstants(commands, layout_.pipeline(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(DecodeConstants),
                           &dispatch.constants);
        vkCmdDispatch(commands, dispatch.groups, 1, 1);
    }
}

void decode_barrier(VkCommandBuffer commands) {
    memory_barrier(
        commands, {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT},
        {VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT |
             VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_COPY_BIT,
         VK_ACCESS_2_INDEX_READ_BIT | VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT |
             VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_READ_BIT});
}

}  // namespace lacedring::gpu
