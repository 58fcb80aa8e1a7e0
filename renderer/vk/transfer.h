#pragma once
// Copies bytes between the host and device buffers, through one staging buffer per direction.

#include <atomic>
#include <cstddef>
#include <functional>
#include <span>

#include "renderer/vk/buffer.h"
#include "renderer/vk/commands.h"

namespace lacedring::gpu {

class Transfer {
  public:
    static Result<Transfer> create(Context& context);

    /// Writes `bytes` bytes at `offset`, in pieces. Calls `fill(to, from, size)` for each piece in order, which must
    /// write bytes [from, from + size) of the upload to `to`. Pieces are multiples of `unit` bytes (a power of two up
    /// to 4096, or a struct's size), so that no element is split. Waits for the device.
    using Fill = std::function<void(std::byte* to, std::size_t from, std::size_t size)>;
    Result<void> upload(const Buffer& to, VkDeviceSize offset, std::size_t bytes, std::size_t unit, const Fill& fill);
    Result<void> upload(const Buffer& to, std::span<const std::byte> bytes);

    template <class T>
    Result<void> upload(const Buffer& to, std::span<const T> values) {
        return upload(to, std::as_bytes(values));
    }

    /// From now on, uploads stop after the current piece when `*stop` becomes true, and return kDeviceFailure; callers
    /// should not report it. `stop` must outlive this object; null: uploads do not stop.
    void stop_when(const std::atomic<bool>* stop) { stop_ = stop; }

    /// Reads out.size() bytes from `offset`. Waits for the device.
    Result<void> read(const Buffer& from, VkDeviceSize offset, std::span<std::byte> out);

  private:
    Transfer() = default;

    Context* context_ = nullptr;
    const std::atomic<bool>* stop_ = nullptr;
    std::optional<Commands> commands_;
    Buffer up_;
    Buffer down_;
};

}  // namespace lacedring::gpu
