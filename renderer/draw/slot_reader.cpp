#include "renderer/draw/slot_reader.h"

#include <algorithm>

#include "renderer/draw/surface.h"
#include "renderer/vk/context.h"
#include "renderer/vk/try.h"
#include "spirv/slot_indices_comp.h"
#include "spirv/slot_words_comp.h"
#include "spirv/vertex_positions_comp.h"

namespace lacedring::gpu {

Result<SlotReader> SlotReader::create(Context& context) {
    SlotReader out;
    out.context_ = &context;
    const Binding binding{0};
    LR_ASSIGN(out.layout_, Layout::create(context, "slot indices", std::span(&binding, 1), VK_SHADER_STAGE_COMPUTE_BIT,
                                          sizeof(DrawConstants)));
    return out;
}

template <class Done>
Result<void> SlotReader::run(Commands& commands, const GpuMesh& mesh, Task task, const Done& done) {
    if (mesh.source == Source::plain) return Error{ErrorCode::invalid_argument, "an index list has no stream"};
    const bool packed = is_packed(mesh.source), fours = task == Task::words_by_fours;
    const std::uint32_t count = task == Task::positions ? mesh.surface_vertices : mesh.slots;
    PipelineHandle& pipeline = pipelines_[2 * static_cast<std::size_t>(task) + (packed ? 1 : 0)];
    if (!pipeline) {
        const std::array<std::uint32_t, 7> constants{0,
                                                     0,
                                                     packed ? 1U : 0U,
                                                     0,  // LR_CONSTANT_ROTATE
                                                     0,
                                                     0,  // LR_CONSTANT_SEAMS: triangles come from the stream
                                                     fours ? 1U : 0U};
        const Shader& shader = task == Task::indices     ? spirv_slot_indices_comp
                               : task == Task::positions ? spirv_vertex_positions_comp
                                                         : spirv_slot_words_comp;
        LR_ASSIGN(pipeline, create_compute(*context_, "slots", layout_, shader, constants));
    }
    constexpr std::uint32_t kSlots = 1U << 20;
    const std::uint32_t step = std::min({kSlots, count, static_cast<std::uint32_t>(mesh.max_range / 12)});
    LR_ASSIGN(const Buffer out,
              Buffer::create(*context_, "slots", std::uint64_t{12} * step, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
    Descriptors descriptors(*context_);
    LR_ASSIGN(const VkDescriptorSet set, descriptors.allocate(layout_));
    descriptors.write(set, 0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {&out});
    for (std::uint32_t first = 0; first < count; first += step) {
        const std::uint32_t slots = std::min(step, count - first);
        const DrawConstants constants = draw_constants(mesh, first, slots);
        LR_ASSIGN(const VkCommandBuffer buffer, commands.begin());
        vkCmdBindPipeline(buffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.get());
        vkCmdBindDescriptorSets(buffer, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.pipeline(), 0, 1, &set, 0, nullptr);
        vkCmdPushConstants(buffer, layout_.pipeline(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(constants), &constants);
        vkCmdDispatch(buffer, (slots + LR_COMPUTE_GROUP - 1) / LR_COMPUTE_GROUP, 1, 1);
        LR_TRY(commands.run());
        LR_TRY(done(first, slots, out));
    }
    return {};
}

Result<std::vector<std::uint32_t>> SlotReader::read_threes(Commands& commands, Transfer& transfer, const GpuMesh& mesh,
                                                           Task task) {
    std::vector<std::uint32_t> out(std::size_t{3} * (task == Task::positions ? mesh.surface_vertices : mesh.slots));
    LR_TRY(run(commands, mesh, task, [&](std::uint32_t first, std::uint32_t count, const Buffer& part) {
        return transfer.read(
            part, 0, std::as_writable_bytes(std::span(out).subspan(std::size_t{3} * first, std::size_t{3} * count)));
    }));
    return out;
}

Result<std::vector<std::uint32_t>> SlotReader::read(Commands& commands, Transfer& transfer, const GpuMesh& mesh) {
    return read_threes(commands, transfer, mesh, Task::indices);
}

Result<std::vector<std::uint32_t>> SlotReader::positions(Commands& commands, Transfer& transfer, const GpuMesh& mesh) {
    if (!mesh.vertex_stream) return Error{ErrorCode::invalid_argument, "the mesh has no vertex stream"};
    return read_threes(commands, transfer, mesh, Task::positions);
}

Result<WordsRead> SlotReader::words_read(Commands& commands, Transfer& transfer, const GpuMesh& mesh) {
    WordsRead out;
    const Task task = mesh.path == Path::geometry ? Task::words_by_fours : Task::words;
    std::vector<std::uint32_t> words;
    LR_TRY(run(commands, mesh, task, [&](std::uint32_t, std::uint32_t slots, const Buffer& part) {
        words.resize(slots);
        Result<void> read = transfer.read(part, 0, std::as_writable_bytes(std::span(words)));
        for (const std::uint32_t count : words) {
            out.all += count;
            out.most = std::max(out.most, count);
        }
        return read;
    }));
    return out;
}

}  // namespace lacedring::gpu
