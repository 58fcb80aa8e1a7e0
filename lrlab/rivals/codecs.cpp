#include "lrlab/rivals/codecs.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lrcore/base/try.h"
#include "lrlab/rivals/limit.h"

namespace lacedring {
namespace {

CodedIndices encode(std::vector<std::uint32_t> ordered, std::uint32_t vertex_count) {
    // Index codec version 1, as gltfpack; the library's default is version 0, for readers from before 2020.
    static const bool newest = (meshopt_encodeIndexVersion(1), true);
    (void)newest;
    CodedIndices out;
    std::vector<std::uint32_t> number(vertex_count);
    const std::size_t used =
        meshopt_optimizeVertexFetchRemap(number.data(), ordered.data(), ordered.size(), vertex_count);
    std::uint32_t behind = static_cast<std::uint32_t>(used);
    out.order.resize(vertex_count);
    for (std::uint32_t v = 0; v < vertex_count; ++v) {
        if (number[v] == UINT32_MAX) number[v] = behind++;  // unused vertices come last
        out.order[number[v]] = v;
    }
    for (std::uint32_t& v : ordered) v = number[v];
    out.bytes.resize(meshopt_encodeIndexBufferBound(ordered.size(), vertex_count));
    out.bytes.resize(meshopt_encodeIndexBuffer(out.bytes.data(), out.bytes.size(), ordered.data(), ordered.size()));
    out.indices.resize(ordered.size());
    if (!decode_meshopt_indices(out.bytes, out.indices)) out.indices.clear();
    return out;
}

/// A scale that keeps squared areas within the range of floats: 1, or a power of two, which is exact.
float down_scale(std::span<const float> positions) {
    constexpr float kLarge = 0x1p30F;
    float largest = 0;
    for (const float x : positions)
        largest = std::max(largest, std::min(std::abs(x), std::numeric_limits<float>::max()));
    return largest > kLarge ? std::ldexp(1.0F, -std::ilogb(largest)) : 1.0F;
}

}  // namespace

Result<std::vector<std::uint32_t>> best_cache_order(std::span<const std::uint32_t> indices,
                                                    std::uint32_t vertex_count) {
    LR_TRY(check_valences(indices, vertex_count));
    std::vector<std::uint32_t> ordered(indices.size());
    if (!indices.empty()) {
        meshopt_optimizeVertexCache(ordered.data(), indices.data(), indices.size(), vertex_count);
    }
    return ordered;
}

bool decode_meshopt_indices(std::span<const std::uint8_t> bytes, std::span<std::uint32_t> indices) {
    return meshopt_decodeIndexBuffer(indices.data(), indices.size(), bytes.data(), bytes.size()) == 0;
}

std::vector<std::uint8_t> encode_meshopt_vertices(std::span<const std::uint16_t> values) {
    constexpr std::size_t kSize = 4 * sizeof(std::uint16_t);
    std::vector<std::uint8_t> out(meshopt_encodeVertexBufferBound(values.size() / 4, kSize));
    out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), values.data(), values.size() / 4, kSize));
    return out;
}

bool decode_meshopt_vertices(std::span<const std::uint8_t> bytes, std::span<std::uint16_t> values) {
    return meshopt_decodeVertexBuffer(values.data(), values.size() / 4, 4 * sizeof(std::uint16_t), bytes.data(),
                                      bytes.size()) == 0;
}

Result<std::array<CodedIndices, 2>> encode_meshopt_orders(std::span<const std::uint32_t> indices,
                                                          std::uint32_t vertex_count) {
    std::array<CodedIndices, 2> out;
    if (indices.empty()) {
        for (CodedIndices& coded : out) coded = encode({}, vertex_count);
        return out;
    }
    LR_ASSIGN(std::vector<std::uint32_t> best, best_cache_order(indices, vertex_count));
    out[0] = encode(std::move(best), vertex_count);
    std::vector<std::uint32_t> ordered(indices.size());
    meshopt_optimizeVertexCacheStrip(ordered.data(), indices.data(), indices.size(), vertex_count);
    out[1] = encode(std::move(ordered), vertex_count);
    return out;
}

Result<CodedIndices> encode_meshopt_indices(std::span<const std::uint32_t> indices, std::uint32_t vertex_count) {
    LR_ASSIGN(auto orders, encode_meshopt_orders(indices, vertex_count));
    auto& [cache, strip] = orders;
    return std::move(strip.bytes.size() < cache.bytes.size() ? strip : cache);
}

Result<Meshlets> make_meshlets(std::span<const std::uint32_t> indices, std::span<const float> positions) {
    constexpr std::size_t kVertices = 64, kTriangles = 124;
    Meshlets out;
    if (indices.empty()) return out;
    const auto vertex_count = static_cast<std::uint32_t>(positions.size() / 3);
    LR_TRY(check_valences(indices, vertex_count));
    std::vector<float> scaled;
    if (const float scale = down_scale(positions); scale != 1) {
        constexpr float kMost = std::numeric_limits<float>::max();  // positions rounded from doubles may be infinite
        scaled.reserve(positions.size());
        for (const float x : positions) scaled.push_back(std::clamp(x, -kMost, kMost) * scale);
        positions = scaled;
    }
    LR_TRY(check_places(indices, positions));
    const std::size_t most = meshopt_buildMeshletsBound(indices.size(), kVertices, kTriangles);
    std::vector<meshopt_Meshlet> meshlets(most);
    std::vector<unsigned int> vertices(most * kVertices);
    std::vector<unsigned char> corners(most * kTriangles * 3);
    meshlets.resize(meshopt_buildMeshlets(meshlets.data(), vertices.data(), corners.data(), indices.data(),
                                          indices.size(), positions.data(), positions.size() / 3, 3 * sizeof(float),
                                          kVertices, kTriangles, 0));
    for (const meshopt_Meshlet& m : meshlets) {
        out.bytes +=
            sizeof m + sizeof(std::uint32_t) * m.vertex_count + (std::size_t{3} * m.triangle_count + 3) / 4 * 4;
        for (unsigned i = 0; i < 3 * m.triangle_count; ++i) {
            out.indices.push_back(vertices[m.vertex_offset + corners[m.triangle_offset + i]]);
        }
    }
    if (out.indices.size() != indices.size()) {
        return Error{ErrorCode::unsupported, fmt::format("meshoptimizer gives back {} of {} triangles",
                                                         out.indices.size() / 3, indices.size() / 3)};
    }
    return out;
}

}  // namespace lacedring
