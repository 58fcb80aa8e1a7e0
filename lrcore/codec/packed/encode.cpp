// Encodes meshes as packed streams.

#include <optional>

#include "lacedring/lacedring.hpp"
#include "lacedring/streams.hpp"
#include "lrcore/base/message.h"
#include "lrcore/base/try.h"
#include "lrcore/codec/packed/corridors.h"
#include "lrcore/codec/packed/doubles.h"
#include "lrcore/codec/packed/packed_writer.h"

namespace lacedring {
namespace {

constexpr std::uint32_t kMostPackedVertices = 1U << 29;  // keeps folded BESIDE steps below 2^30

Result<EncodedPacked> write_stream(const CornerTable& table, const Corridors& corridors) {
    EncodedPacked out;
    LR_ASSIGN(std::vector<std::uint32_t> words,
              write_packed(CorridorSteps(table, corridors), table.vertex_count, out.statistics));
    out.words = std::move(words);
    return out;
}

}  // namespace

Result<EncodedPacked> encode_packed(const CornerTable& table, const Rings& rings, PackedProfile profile) {
    if (table.vertex_count > kMostPackedVertices) {
        return Error{
            ErrorCode::too_large,
            detail::message(table.vertex_count, " vertices; a packed stream numbers at most ", kMostPackedVertices)};
    }
    Corridors corridors = profile == PackedProfile::small ? walk_corridors(table, rings) : walk_pieces(table, rings);
    Result<EncodedPacked> encoded = write_stream(table, corridors);
    if (!encoded) return encoded;
    EncodedPacked& out = *encoded;
    out.statistics.ring_vertices = corridors.ring_vertices;
    for (const CornerId c : corridors.corners) out.triangle_order.push_back(triangle(c).value);
    out.vertex_order = std::move(corridors.vertex_order);
    return encoded;
}

namespace {

Result<PackedChoice> encode_smallest(const CornerTable& table, const RingOptions& ring, const OptimizeOptions& optimize,
                                     PackedProfile profile) {
    Rings rings = expand_rings(table, ring);
    LR_ASSIGN(EncodedPacked plain, encode_packed(table, rings, profile));
    PackedChoice out{std::move(plain), 0};
    if (optimize.passes == 0) return out;
    LR_ASSIGN(EncodedPacked optimized,
              encode_packed(table, optimize_rings(table, std::move(rings), optimize), profile));
    if (optimized.words.size() < out.stream.words.size()) out = {std::move(optimized), optimize.passes};
    return out;
}

}  // namespace

Result<PackedChoice> encode_smallest_packed(const CornerTable& table, const RingOptions& ring,
                                            const OptimizeOptions& optimize, PackedProfile profile) {
    const std::optional<Doubles> doubles = find_doubles(table);
    if (!doubles) return encode_smallest(table, ring, optimize, profile);
    Result<PackedChoice> out = encode_smallest(doubles->table, ring, optimize, profile);
    if (out) add_doubles(out->stream, *doubles);
    return out;
}

}  // namespace lacedring
