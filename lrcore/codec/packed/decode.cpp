#include <algorithm>
#include <atomic>
#include <cassert>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

#include "lrcore/codec/packed/record.h"

namespace lacedring {
namespace {

constexpr std::uint32_t kFewestBlocks = 4;  // of a part: about ten microseconds, the time to start a thread

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
    if (threads <= 1 || blocks <= kFewestBlocks) return decode_triangles(view, 0, view.triangles, indices.data());
    // Several parts a thread: a thread that starts late leaves its parts to the others.
    const std::uint32_t parts =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(std::uint64_t{threads} * 4, blocks / kFewestBlocks));
    std::atomic<std::uint32_t> next_part = 0;
    const auto work = [&] {
        for (std::uint32_t i = next_part++; i < parts; i = next_part++) {
            const auto first_of = [&](std::uint32_t k) {
                return static_cast<std::uint32_t>(
                    std::min<std::uint64_t>(std::uint64_t{blocks} * k / parts * LR_PACKED_BLOCK, view.triangles));
            };
            decode_triangles(view, first_of(i), first_of(i + 1), indices.data() + std::size_t{3} * first_of(i));
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
    const std::uint32_t first = block * LR_PACKED_BLOCK, count = std::min(view.triangles - first, LR_PACKED_BLOCK);
    assert(block < view.blocks() && indices.size() >= std::size_t{3} * count);
    decode_triangles(view, first, first + count, indices.data());
}

Triangle decode_packed_triangle(const PackedView& view, std::uint32_t triangle) {
    const PackedRecord record = find_record(view, triangle);
    const std::uint32_t i = triangle - record.first;
    std::uint32_t out[3 * LR_PACKED_BLOCK];
    expand_record(view, record, i + 1, out);
    return {{out[3 * i], out[3 * i + 1], out[3 * i + 2]}};
}

}  // namespace lacedring
