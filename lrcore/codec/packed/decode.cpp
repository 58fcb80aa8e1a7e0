// Decodes whole streams and ranges with the decoder in lacedring_decode.h.

#include <algorithm>
#include <cassert>

#include "lrcore/base/parallel.h"
#include "lrcore/codec/packed/packed_c.h"

namespace lacedring {
namespace {

// At least 0.1 ms of work: twice the start of a thread.
constexpr std::uint32_t kBlocksOfThread = 512;

}  // namespace

void decode_packed(const PackedView& view, std::span<std::uint32_t> indices, unsigned threads) {
    assert(indices.size() == std::size_t{3} * view.triangles);
    const lacedring_packed packed = detail::as_c(view);
    const std::uint32_t blocks = view.blocks();
    const unsigned useful = std::min(threads, blocks / kBlocksOfThread);
    if (useful <= 1) return lacedring_packed_triangles_u32(&packed, indices.data());
    const std::uint32_t parts = useful * 4;
    detail::in_parallel(useful, parts, [&](std::uint32_t i) {
        const auto first_of = [&](std::uint32_t k) {
            return static_cast<std::uint32_t>(std::uint64_t{blocks} * k / parts);
        };
        lacedring_packed_blocks_u32(&packed, first_of(i), first_of(i + 1),
                                    indices.data() + std::size_t{3} * LACEDRING_PACKED_BLOCK * first_of(i));
    });
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
