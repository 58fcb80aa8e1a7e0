#include "renderer/vk/transfer.h"

#include <algorithm>
#include <cstring>

#include "renderer/vk/context.h"
#include "renderer/vk/device_error.h"
#include "renderer/vk/try.h"

namespace lacedring::gpu {
namespace {

constexpr std::size_t kPiece = std::size_t{16} << 20;

}  // namespace

Result<Transfer> Transfer::create(Context& context) {
    Transfer out;
    out.context_ = &context;
    LR_ASSIGN(out.commands_, Commands::create(context));
    LR_ASSIGN(out.up_, Buffer::create(context, "staging up", kPiece, 0, Memory::upload));
    LR_ASSIGN(out.down_, Buffer::create(context, "staging down", kPiece, 0, Memory::readback));
    return out;
}

Result<void> Transfer::upload(const Buffer& to, VkDeviceSize offset, std::size_t bytes, std::size_t unit,
                              const Fill& fill) {
    if (offset + bytes > to.size()) return Error{ErrorCode::invalid_argument, "upload past a buffer's end"};
    const std::size_t piece = kPiece / unit * unit;
    for (std::size_t from = 0; from < bytes; from += piece) {
        if (stop_ != nullptr && *stop_) return Error{kDeviceFailure, "stopped"};
        const std::size_t size = std::min(piece, bytes - from);
        fill(up_.mapped(), from, size);
        LR_ASSIGN(const VkCommandBuffer commands, commands_->begin());
        const VkBufferCopy region{0, offset + from, size};
        vkCmdCopyBuffer(commands, up_.handle(), to.handle(), 1, &region);
        LR_TRY(commands_->run());
    }
    return {};
}

Result<void> Transfer::upload(const Buffer& to, std::span<const std::byte> bytes) {
    return upload(to, 0, bytes.size(), 1, [&](std::byte* out, std::size_t from, std::size_t size) {
        std::memcpy(out, bytes.data() + from, size);
    });
}

Result<void> Transfer::read(const Buffer& from, VkDeviceSize offset, std::span<std::byte> out) {
    if (offset + out.size() > from.size()) return Error{ErrorCode::invalid_argument, "read past a buffer's end"};
    for (std::size_t done = 0; done < out.size(); done += kPiece) {
        const std::size_t size = std::min(kPiece, out.size() - done);
        LR_ASSIGN(const VkCommandBuffer commands, commands_->begin());
        const VkBufferCopy region{offset + done, 0, size};
        vkCmdCopyBuffer(commands, from.handle(), down_.handle(), 1, &region);
        memory_barrier(commands, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT},
                       {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
        LR_TRY(commands_->run());
        std::memcpy(out.data() + done, down_.mapped(), size);
    }
    return {};
}

}  // namespace lacedring::gpu
