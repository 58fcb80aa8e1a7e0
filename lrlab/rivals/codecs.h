#pragma once
// meshoptimizer's compressed index and vertex formats.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/base.hpp"

namespace lacedring {

/// Encoded triangles; the encoder chooses the order of triangles and vertices.
struct CodedIndices {
    std::vector<std::uint8_t> bytes;
    std::vector<std::uint32_t> indices;  ///< the decoded triangles, in the new vertex numbers
    std::vector<std::uint32_t> order;    ///< order[new] = old vertex
};

/// meshopt_encodeIndexBuffer, version 1, of two triangle orders: that of meshopt_optimizeVertexCache, then that for
/// strips. Vertices are in the order of their first use. `indices` has no degenerate triangles. Errors: those of
/// check_valences.
Result<std::array<CodedIndices, 2>> encode_meshopt_orders(std::span<const std::uint32_t> indices,
                                                          std::uint32_t vertex_count);

/// The smaller result of encode_meshopt_orders. Errors: those of check_valences.
Result<CodedIndices> encode_meshopt_indices(std::span<const std::uint32_t> indices, std::uint32_t vertex_count);

/// meshopt_decodeIndexBuffer. False: `bytes` is not such a stream of indices.size() indices.
bool decode_meshopt_indices(std::span<const std::uint8_t> bytes, std::span<std::uint32_t> indices);

/// meshopt_encodeVertexBuffer; `values` has 4 integers a vertex.
std::vector<std::uint8_t> encode_meshopt_vertices(std::span<const std::uint16_t> values);

/// meshopt_decodeVertexBuffer. False: `bytes` is not such a stream of values.size() values.
bool decode_meshopt_vertices(std::span<const std::uint8_t> bytes, std::span<std::uint16_t> values);

/// The triangles in the order of meshopt_optimizeVertexCache. Errors: those of check_valences.
Result<std::vector<std::uint32_t>> best_cache_order(std::span<const std::uint32_t> indices, std::uint32_t vertex_count);

/// A mesh's meshlets.
struct Meshlets {
    /// Bytes in the layout of mesh shaders: per meshlet 16, 4 for each of its vertices, 3 for each triangle, padded
    /// to 4.
    std::size_t bytes = 0;
    std::vector<std::uint32_t> indices;  ///< the meshlets' triangles, in the mesh's vertex numbers
};
/// meshopt_buildMeshlets, with at most 64 vertices and 124 triangles each. `positions` has 3 floats a vertex. Positions
/// above 2^30 are scaled down first, so that areas do not overflow. Errors: those of check_valences and check_places;
/// unsupported (meshoptimizer loses triangles).
Result<Meshlets> make_meshlets(std::span<const std::uint32_t> indices, std::span<const float> positions);

}  // namespace lacedring
