#pragma once
// meshoptimizer's compressed index and vertex formats.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/base.hpp"

namespace lacedring {

/// A mesh's triangles in an order of the rival's choosing, and what they are stored in. `order[new] = old` vertex.
struct CodedIndices {
    std::vector<std::uint8_t> bytes;
    std::vector<std::uint32_t> indices;  ///< as they are decoded again, in the new numbers
    std::vector<std::uint32_t> order;
};

/// meshopt_encodeIndexBuffer, version 1, of meshopt_optimizeVertexCache's order, then of that for strips, vertices in
/// the order in which they are used. Decoding starts at the first triangle. `indices` has no degenerate triangles.
/// Errors: those of check_valences.
Result<std::array<CodedIndices, 2>> encode_meshopt_orders(std::span<const std::uint32_t> indices,
                                                          std::uint32_t vertex_count);

/// The smaller of the two. Errors: those of check_valences.
Result<CodedIndices> encode_meshopt_indices(std::span<const std::uint32_t> indices, std::uint32_t vertex_count);

/// meshopt_decodeIndexBuffer. False if `bytes` are no such stream of so many indices.
bool decode_meshopt_indices(std::span<const std::uint8_t> bytes, std::span<std::uint32_t> indices);

/// meshopt_encodeVertexBuffer, of 4 integers a vertex: `values` has as many.
std::vector<std::uint8_t> encode_meshopt_vertices(std::span<const std::uint16_t> values);

/// meshopt_decodeVertexBuffer. False if `bytes` are no such stream of so many values.
bool decode_meshopt_vertices(std::span<const std::uint8_t> bytes, std::span<std::uint16_t> values);

/// The triangles in the order that meshopt_optimizeVertexCache thinks best. Errors: those of check_valences.
Result<std::vector<std::uint32_t>> best_cache_order(std::span<const std::uint32_t> indices, std::uint32_t vertex_count);

/// meshopt_buildMeshlets, 64 vertices and 124 triangles each, as a mesh shader reads them: 16 bytes a meshlet, 4 for
/// each of its vertices, 3 for each triangle, filled up to 4. `positions` has three a vertex. Positions
/// above 2^30 are scaled down first, so that areas do not overflow.
/// Errors: those of check_valences and check_places; unsupported (meshoptimizer loses triangles).
struct Meshlets {
    std::size_t bytes = 0;
    std::vector<std::uint32_t> indices;  ///< as they come out, in the mesh's numbers
};
Result<Meshlets> make_meshlets(std::span<const std::uint32_t> indices, std::span<const float> positions);

}  // namespace lacedring
