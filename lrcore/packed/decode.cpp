#include <algorithm>
#include <cassert>
#include <thread>
#include <vector>

#include "lrcore/packed/record.h"

namespace lr {
namespace {

void decode_triangles(const PackedView& view, std::uint32_t begin, std::uint32_t end, std::uint32_t* out) {
    while (begin < end) {
        const PackedRecord record = find_record(view, begin);
        expand_record(view, record, record.triangles, out);
        begin += record.triangles;
        out += std::size_t{3} * record.triangles;
    }
}

}  // namespace

void decode_packed(const PackedView& view, std::span<std::uint32_t> indices, unsigned threads) {
    assert(indices.size() == std::size_t{3} * view.triangles);
    const std::uint32_t blocks = view.blocks();
    const unsigned parts = std::clamp(threads, 1U, std::max(blocks, 1U));
    const auto part = [&](unsigned i) {
        const auto first_of = [&](unsigned k) {
            return static_cast<std::uint32_t>(
                std::min<std::uint64_t>(std::uint64_t{blocks} * k / parts * LR_PACKED_BLOCK, view.triangles));
        };
        decode_triangles(view, first_of(i), first_of(i + 1), indices.data() + std::size_t{3} * first_of(i));
    };
    std::vector<std::jthread> others;
    for (unsigned i = 1; i < parts; ++i) others.emplace_back(part, i);
    part(0);
}

void decode_packed_block(const PackedView& view, std::uint32_t block, std::span<std::uint32_t> indices) {
    const std::uint32_t first = block * LR_PACKED_BLOCK, count = std::min(view.triangles - first, LR_PACKED_BLOCK);
    assert(block < view.blocks() && indices.size() >= std::size_t{3} * count);
    decode_triangles(view, first, first + count, indices.data());
}

PackedTriangle decode_packed_triangle(const PackedView& view, std::uint32_t triangle) {
    const PackedRecord record = find_record(view, triangle);
    const std::uint32_t i = triangle - record.first;
    std::uint32_t out[3 * LR_PACKED_BLOCK];
    expand_record(view, record, i + 1, out);
    return {{out[3 * i], out[3 * i + 1], out[3 * i + 2]}};
}

}  // namespace lr
