#include "renderer/decode/lean_decoder.h"

#include <algorithm>
#include <array>

#include "lacedring/streams.hpp"
#include "lrcore/codec/lean/lean_format.h"
#include "renderer/vk/context.h"
#include "renderer/vk/try.h"
#include "spirv/lean_decode_comp.h"

namespace lacedring::gpu {
namespace {

constexpr std::uint64_t kDispatchStep = 64;  // slots: 768 bytes of indices, a multiple of kDescriptorAlignment

std::uint32_t in_groups(std::uint64_t triangles) {
    constexpr std::uint64_t kPerGroup = std::uint64_t{LR_COMPUTE_GROUP} * LR_TRIANGLES_PER_INVOCATION;
    return static_cast<std::uint32_t>((triangles + kPerGroup - 1) / kPerGroup);
}

}  // namespace

Result<LeanDecoder> LeanDecoder::create(Context& context) {
    LeanDecoder out;
    out.context_ = &context;
    const std::array<Binding, 4> bindings{{{0}, {1}, {2}, {3}}};
    LR_ASSIGN(out.layout_,
              Layout::create(context, "lean decode", bindings, VK_SHADER_STAGE_COMPUTE_BIT, sizeof(DecodeConstants)));
    out.pipelines_.resize(2);
    for (const std::uint32_t two_sided : {VK_FALSE, VK_TRUE}) {
        LR_ASSIGN(out.pipelines_[two_sided], create_compute(context, "lean decode", out.layout_, spirv_lean_decode_comp,
                                                            std::span(&two_sided, 1)));
    }
    return out;
}

Result<DecodePlan> LeanDecoder::plan(Descriptors& descriptors, const GpuMesh& mesh, const LeanView& view) const {
    constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const std::uint64_t two_sided = std::uint64_t{2} * view.rings2 / kDispatchStep * kDispatchStep,
                        ring_slots = view.ring_slots();
    const auto word_of = [&](std::uint64_t slot) {
        return LR_LEAN_HEADER_WORDS + (slot <= ring_slots ? slot : ring_slots + 3 * (slot - ring_slots));
    };
    // A slot takes at most 12 bytes of either buffer; 512 bytes are for alignment and for the words read ahead.
    const std::uint64_t by_range = (mesh.max_range - 512) / 12 / kDispatchStep * kDispatchStep;
    const std::uint64_t by_groups =
        std::uint64_t{context_->limits().maxComputeWorkGroupCount[0]} * LR_COMPUTE_GROUP * LR_TRIANGLES_PER_INVOCATION;
    const std::uint64_t step = std::min(by_range, by_groups / kDispatchStep * kDispatchStep);
    DecodePlan plan;
    for (std::uint64_t first = 0, slots = 0; first < mesh.slots; first += slots) {
        slots = std::min(step, (first < two_sided ? two_sided : mesh.slots) - first);
        const VkDeviceSize begin = word_of(first) * sizeof(std::uint32_t) / kDescriptorAlignment * kDescriptorAlignment;
        const VkDeviceSize end = std::min(word_of(first + slots) * sizeof(std::uint32_t) + 32, mesh.stream.size());
        const VkDeviceSize out_bytes = std::min(12 * ((slots + 3) / 4 * 4), mesh.indices.size() - 12 * first);
        DecodePlan::Dispatch dispatch;
        LR_ASSIGN(dispatch.set, descriptors.allocate(layout_));
        descriptors.write(dispatch.set, 0, kStorage, {&mesh.stream, 0, LR_LEAN_HEADER_WORDS * sizeof(std::uint32_t)});
        descriptors.write(dispatch.set, 1, kStorage, {&mesh.stream, begin, end - begin});
        descriptors.write(dispatch.set, 2, kStorage, {&mesh.indices, 12 * first, out_bytes});
        descriptors.write(dispatch.set, 3, kStorage, {&mesh.commands});
        dispatch.constants.first_slot = static_cast<std::uint32_t>(first);
        dispatch.constants.slots = static_cast<std::uint32_t>(slots);
        dispatch.constants.draws = first == 0 ? mesh.draws : 0;
        dispatch.constants.draw_slots = mesh.draw_slots;
        dispatch.constants.first_word = static_cast<std::uint32_t>(begin / sizeof(std::uint32_t));
        dispatch.groups = in_groups(slots);
        dispatch.pipeline = first < two_sided ? VK_TRUE : VK_FALSE;
        plan.dispatches.push_back(dispatch);
    }
    return plan;
}

}  // namespace lacedring::gpu
