#include "lacedring/lacedring.hpp"
#include "lacedring/topology.hpp"
#include "lrcore/base/try.h"

namespace lacedring {
namespace {

/// Sets vertex_order, triangle_order and copies of `out` from the map. Returns the copied vertices and their originals.
std::vector<VertexCopy> translate(const LrMap& map, const std::vector<VertexId>& originals, EncodedLr& out) {
    const std::size_t mesh_vertices = map.vertex.size() - originals.size();
    std::vector<std::uint32_t> number(mesh_vertices);
    for (std::uint32_t v = 0; v < map.vertex.size(); ++v) {
        if (map.vertex[v].value < mesh_vertices) number[map.vertex[v].value] = v;
    }
    std::vector<VertexCopy> copies;
    out.vertex_order.reserve(map.vertex.size());
    for (std::uint32_t v = 0; v < map.vertex.size(); ++v) {
        const std::uint32_t u = map.vertex[v].value;
        const std::uint32_t original = u < mesh_vertices ? u : originals[u - mesh_vertices].value;
        if (u >= mesh_vertices) copies.push_back({v, number[original]});
        out.vertex_order.push_back(original);
    }
    for (const TriangleId t : map.triangle) {
        if (!t.is_null()) out.triangle_order.push_back(t.value);
    }
    out.copies = static_cast<std::uint32_t>(copies.size());
    return copies;
}

}  // namespace

Result<EncodedLr> encode_lr(CornerTable table, const RingOptions& ring, const OptimizeOptions& optimize,
                            bool wart_skipping) {
    const std::vector<VertexId> originals = split_fans(table);
    RingOptions one = ring;
    one.one_per_shell = true;
    LrMap map;
    const Rings rings = optimize_rings(table, expand_rings(table, one), optimize);
    LR_ASSIGN(const LrTable lr, build_lr(table, rings, {.wart_skipping = wart_skipping}, &map));
    EncodedLr out;
    out.words = serialize(lr, translate(map, originals, out));
    out.statistics = lr.statistics;
    out.k = ring.k;
    return out;
}

Result<EncodedLr> encode_compact_lr(CornerTable table, const RingOptions& ring,
                                    std::span<const std::uint32_t> periods) {
    const std::vector<VertexId> originals = split_fans(table);
    LR_ASSIGN(const CompactChoice best, smallest_compact_lr(table, ring, periods));
    EncodedLr out;
    out.words = serialize(best.compact, translate(best.map, originals, out));
    out.statistics = best.lr.statistics;
    out.k = best.k;
    return out;
}

}  // namespace lacedring
