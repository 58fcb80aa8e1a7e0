#include "app/bench/vertices.h"

#include <algorithm>
#include <array>
#include <functional>
#include <memory>

#include "lrlab/rivals/codecs.h"

namespace lacedring::app {
namespace {

/// Positions as floats, in the given order.
std::vector<float> ordered_positions(const Mesh& mesh, std::span<const std::uint32_t> order) {
    const std::vector<float> positions = positions_f32(mesh);
    std::vector<float> out;
    out.reserve(positions.size());
    for (const std::uint32_t v : order) {
        for (std::size_t c = 0; c < 3; ++c) out.push_back(positions[3 * std::size_t{v} + c]);
    }
    return out;
}

/// Inputs and outputs of the candidates, shared by their copies.
struct Coded {
    EncodedVertices stream;
    std::vector<float> floats;
    std::vector<std::uint8_t> bytes;
    std::vector<std::uint16_t> integers;
};

/// The lattice's integers in `coded_order`, minus the minimum of each component, padded to 4 per vertex.
std::vector<std::uint16_t> as_users_store(const VertexView& view, std::span<const std::uint32_t> order,
                                          std::span<const std::uint32_t> coded_order) {
    std::vector<std::int32_t> all(std::size_t{3} * view.vertices);
    for (std::uint32_t block = 0; block < view.blocks(); ++block) {
        decode_vertex_block(view, block,
                            std::span(reinterpret_cast<std::uint32_t*>(all.data()), all.size())
                                .subspan(std::size_t{3} * kVertexBlock * block));
    }
    std::array<std::int32_t, 3> low{INT32_MAX, INT32_MAX, INT32_MAX};
    for (std::size_t i = 0; i < all.size(); ++i) low[i % 3] = std::min(low[i % 3], all[i]);
    std::vector<std::uint32_t> place(order.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) place[order[i]] = i;
    std::vector<std::uint16_t> out(4 * coded_order.size());
    for (std::size_t i = 0; i < coded_order.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            out[4 * i + c] = static_cast<std::uint16_t>(all[std::size_t{3} * place[coded_order[i]] + c] - low[c]);
        }
    }
    return out;
}

}  // namespace

Result<VertexBench> vertex_candidates(const Mesh& mesh, const VertexOptions& options,
                                      std::span<const std::uint32_t> order,
                                      std::span<const std::uint32_t> coded_order) {
    VertexBench out;
    const auto add = [&](const char* name, std::function<void()> work) {
        out.candidates.push_back({name, std::move(work), {}, {}, true});
    };
    constexpr const char* kRival = "meshopt_vertex_codec";
    auto coded = std::make_shared<Coded>();
    coded->floats = ordered_positions(mesh, order);
    Result<EncodedVertices> encoded =
        encode_vertices({ComponentType::f32, 3, false, std::as_bytes(std::span(coded->floats))}, options);
    if (!encoded) {
        for (const char* name : {"vertices", kRival}) out.absent.emplace_back(name, encoded.error().message);
        return out;
    }
    coded->stream = std::move(*encoded);
    const Result<VertexView> view = view_vertices(coded->stream.words);
    if (!view) return view.error();
    add("vertices", [coded, view = *view] { decode_vertices(view, std::as_writable_bytes(std::span(coded->floats))); });
    if (coded_order.empty() || view->mapping != VertexMapping::lattice) {
        out.absent.emplace_back(kRival, coded_order.empty() ? "meshoptimizer has no order of the vertices"
                                                            : "the positions are smaller as decimals");
        return out;
    }
    const std::vector<std::uint16_t> integers = as_users_store(*view, order, coded_order);
    coded->bytes = encode_meshopt_vertices(integers);
    coded->integers.resize(integers.size());
    if (!decode_meshopt_vertices(coded->bytes, coded->integers) || coded->integers != integers) {
        return Error{ErrorCode::invalid_argument, "meshoptimizer's vertex codec decodes other integers"};
    }
    add(kRival, [coded] { (void)decode_meshopt_vertices(coded->bytes, coded->integers); });
    return out;
}

}  // namespace lacedring::app
