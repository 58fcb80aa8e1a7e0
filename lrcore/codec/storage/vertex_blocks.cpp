#include "lrcore/codec/storage/vertex_blocks.h"

#include <algorithm>

#include "lrcore/codec/bit_reader.h"

namespace lacedring::storage {
namespace {

/// Skips `numbers` unary numbers: zeros, each number ended by a one.
void skip_unary(BitReader& bits, std::uint32_t numbers) {
    while (numbers > 0) numbers -= bits.take(1);
}

PlaneChoice read_plane(BitReader& bits) {
    PlaneChoice out;
    if (bits.take(1) == 0) return out;
    out.kind = bits.take(1) == 0 ? PlaneChoice::last : PlaneChoice::given;
    if (out.kind == PlaneChoice::last) return out;
    out.axis = static_cast<std::uint8_t>(bits.take(2));
    for (std::int8_t& slope : out.slope) slope = static_cast<std::int8_t>(static_cast<std::int32_t>(bits.take(3)) - 4);
    return out;
}

BlockChoices read_block(const lacedring_vertices& stream, BitReader& bits, std::uint32_t count) {
    const std::uint32_t n = stream.components;
    BlockChoices out;
    std::array<std::uint32_t, kMostComponents> width{};
    for (std::uint32_t c = 0; c < n; ++c) {
        const std::uint32_t said = stream.parameters[2 * c + 1];
        BlockChoices::Predictor& p = out.predictors[c];
        p.own = bits.take(1) != 0;
        p.value = static_cast<std::uint8_t>(p.own ? bits.take(5) : said >> 11 & 31);
        width[c] = said >> 6 & 31;
    }
    out.size = static_cast<std::uint8_t>(bits.take(2));
    for (std::uint32_t c = 0; c < n; ++c) bits.skip(stream.parameters[2 * c + 1] & 63);
    const std::uint32_t length = 4U << out.size;
    for (std::uint32_t i = 0, run = 0; i + 1 < count; i += length, ++run) {
        if (n == 3 && i % kPlaneRun == 0) out.planes[i / kPlaneRun] = read_plane(bits);
        const std::uint32_t here = std::min(length, count - 1 - i);
        std::uint32_t low = 0, present = 0;
        for (std::uint32_t c = 0; c < n; ++c) {
            const auto code = static_cast<std::uint8_t>(bits.unary(kGiven));
            if (code == kGiven) width[c] = bits.take(5);
            if (code == kOneMore) ++width[c];
            if (code == kOneLess) --width[c];
            out.widths[c][run] = {code, static_cast<std::uint8_t>(code == kGiven ? width[c] : 0)};
            if (code == kAllZero) continue;
            low += width[c];
            ++present;
        }
        bits.skip(std::uint64_t{low} * here);
        skip_unary(bits, present * here);
    }
    return out;
}

}  // namespace

std::vector<BlockChoices> read_choices(const lacedring_vertices& stream) {
    std::vector<BlockChoices> out;
    BitReader bits({stream.data, stream.data_words}, 0, std::uint64_t{32} * stream.data_words);
    for (std::uint32_t first = 0; first < stream.vertices;) {
        if (out.size() % 16 == 0) bits.align_to_word();
        const std::uint32_t count = std::min(stream.vertices - first, kVertexBlock);
        out.push_back(read_block(stream, bits, count));
        first += count;
    }
    return out;
}

}  // namespace lacedring::storage
