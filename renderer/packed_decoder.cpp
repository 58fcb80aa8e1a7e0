#include "renderer/packed_decoder.h"

#include <algorithm>
#include <array>

#include "lacedring/streams.hpp"
#include "lrcore/codec/packed/packed_format.h"
#include "renderer/context.h"
#include "renderer/try.h"
#include "spirv/packed_decode_comp.h"

namespace lacedring::gpu {
namespace {

constexpr std::uint64_t kWord = sizeof(std::uint32_t);

/// Word of the stream in which a group begins; for the last group + 1, where all end.
std::uint64_t group_word(const PackedView& view, std::uint64_t group) {
    const std::uint64_t groups = view.groups_word() - view.table_word() + 1;
    if (group >= groups) return view.words.size();
    const std::uint64_t byte = group == 0 ? 0 : view.words[view.table_word() + group - 1];
    return std::min<std::uint64_t>(view.groups_word() + byte / kWord, view.words.size());
}

/// Words [begin, end) of the stream, and what a descriptor's alignment puts before them.
struct Window {
    std::uint64_t begin, end;
    Window(std::uint64_t first, std::uint64_t last, const PackedView& view)
        : begin(first / (kDescriptorAlignment / kWord) * (kDescriptorAlignment / kWord)),
          end(std::clamp<std::uint64_t>(last, first + 1, view.words.size())) {}
    std::uint64_t bytes() const { return kWord * (end - begin); }
};

}  // namespace

Result<PackedDecoder> PackedDecoder::create(Context& context) {
    PackedDecoder out;
    out.context_ = &context;
    const std::array<Binding, 6> bindings{{{0}, {1}, {2}, {3}, {4}, {5}}};
    LR_ASSIGN(out.layout_,
              Layout::create(context, "packed decode", bindings, VK_SHADER_STAGE_COMPUTE_BIT, sizeof(DecodeConstants)));
    // Four blocks are read by four invocations: a larger group than a subgroup would have more of them wait.
    out.group_ = std::clamp(context.info().subgroup_size, 8U, 64U);
    out.pipelines_.resize(1);
    LR_ASSIGN(out.pipelines_[0], create_compute(context, "packed decode", out.layout_, spirv_packed_decode_comp,
                                                std::span(&out.group_, 1)));
    return out;
}

Result<DecodePlan> PackedDecoder::plan(Descriptors& descriptors, const GpuMesh& mesh, const PackedView& view) const {
    constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    // Whole groups: a block's reader begins at its group's head.
    const std::uint64_t most = std::max<std::uint64_t>(
        1, std::min(mesh.max_range / (12 * LR_PACKED_BLOCK),
                    std::uint64_t{context_->limits().maxComputeWorkGroupCount[0]} * LR_BLOCKS_PER_GROUP));
    DecodePlan plan;
    for (std::uint64_t block = 0, blocks = 0; block < view.blocks(); block += blocks) {
        const auto group_of = [](std::uint64_t k) { return k / LR_PACKED_GROUP; };
        const auto groups = [&] {
            return Window(group_word(view, group_of(block)), group_word(view, group_of(block + blocks - 1) + 1) + 1,
                          view);
        };
        blocks = std::min(most, view.blocks() - block);
        while (blocks > 1 && groups().bytes() > mesh.max_range) blocks /= 2;
        const std::uint64_t first = block * LR_PACKED_BLOCK;
        const std::uint64_t triangles = std::min(blocks * LR_PACKED_BLOCK, view.triangles - first);
        const std::uint64_t turn = LR_PACKED_HEADER_WORDS + block * LR_PACKED_BLOCK_WORDS;
        const Window turns(turn, turn + (triangles + 31) / 32, view);
        const std::uint64_t entry = view.table_word() + std::max<std::uint64_t>(group_of(block), 1) - 1;
        const Window table(entry, view.table_word() + group_of(block + blocks - 1), view);
        DecodePlan::Dispatch dispatch;
        LR_ASSIGN(dispatch.set, descriptors.allocate(layout_));
        const auto bind = [&](std::uint32_t number, const Window& window) {
            descriptors.write(dispatch.set, number, kStorage, {&mesh.stream, kWord * window.begin, window.bytes()});
            return static_cast<std::uint32_t>(window.begin);
        };
        bind(0, {0, LR_PACKED_HEADER_WORDS, view});
        dispatch.constants.first_word = bind(1, turns);
        dispatch.constants.table = bind(2, table);
        dispatch.constants.groups = bind(3, groups());
        descriptors.write(dispatch.set, 4, kStorage, {&mesh.indices, 12 * first, 12 * ((triangles + 3) / 4 * 4)});
        descriptors.write(dispatch.set, 5, kStorage, {&mesh.commands});
        dispatch.constants.first_slot = static_cast<std::uint32_t>(first);
        dispatch.constants.slots = static_cast<std::uint32_t>(triangles);
        dispatch.constants.draws = block == 0 ? mesh.draws : 0;
        dispatch.constants.draw_slots = mesh.draw_slots;
        dispatch.groups = static_cast<std::uint32_t>((blocks + LR_BLOCKS_PER_GROUP - 1) / LR_BLOCKS_PER_GROUP);
        plan.dispatches.push_back(dispatch);
    }
    return plan;
}

}  // namespace lacedring::gpu
