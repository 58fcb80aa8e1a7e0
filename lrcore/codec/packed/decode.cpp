#include <algorithm>
#include <atomic>
#include <cassert>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

#include "lrcore/codec/packed/packed_c.h"

namespace lacedring {
namespace {

constexpr std::uint32_t kFewestBlocks = 4;  // of a part: about ten microseconds, the time to start a thread

}  // namespace

void decode_packed(const PackedView& view, std::span<std::uint32_t> indices, unsigned threads) {
    assert(indices.size() == std::size_t{3} * view.triangles);
    const lacedring_packed packed = detail::as_c(view);
    const std::uint32_t blocks = view.blocks();
    if (threads <= 1 || blocks <= kFewestBlocks) return lacedring_packed_triangles_u32(&packed, indices.data());
    // Several parts a thread: a thread that starts late leaves its parts to the others.
    const std::uint32_t parts =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(std::uint64_t{threads} * 4, blocks / kFewestBlocks));
    std::atomic<std::uint32_t> next_part = 0;
    const auto work = [&] {
        for (std::uint32_t i = next_part++; i < parts; i = next_part++) {
            const auto first_of = [&](std::uint32_t k) {
                return static_cast<std::uint32_t>(std::uint64_t{blocks} * k / parts);
            };
            lacedring_packed_blocks_u32(&packed, first_of(i), first_of(i + 1),
                                        indices.data() + std::size_t{3} * LACEDRING_PACKED_BLOCK * first_of(i));
        }
    };
    std::vector<std::jthread> others;
    try {
        others.reserve(std::min(threads, parts) - 1);
        for (unsigned i = 1; i < std::min(threads, parts) && next_part < parts; ++i) others.emplace_back(work);
    } catch (const std::system_error&) {  // the existing threads take all parts
    } catch (const std::bad_alloc&) {
    }
    work();
}

void decode_packed_block(const PackedView& view, std::uint32_t block, std::span<std::uint32_t> indices) {
    assert(block < view.blocks());
    assert(indices.size() >=
           std::size_t{3} * std::min(view.triangles - block * LACEDRING_PACKED_BLOCK, LACEDRING_PACKED_BLOCK));
    const lacedring_packed packed = detail::as_c(view);
    lacedring_packed_blocks_u32(&packed, block, block + 1, indices.data());
}

Triangle decode_packed_triangle(const PackedView& view, std::uint32_t triangle) {
    const lacedring_packed packed = detail::as_c(view);
    Triangle out;
    lacedring_packed_triangle(&packed, triangle, out.v);
    return out;
}

}  // namespace lacedring
