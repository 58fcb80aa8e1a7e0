#pragma once
// Whole meshes, connectivity and attributes, as others store them.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lacedring/base.hpp"
#include "lacedring/lr_file.hpp"
#include "lacedring/mesh.hpp"

namespace lacedring {

/// A mesh in a rival's format. The mesh that it is made of has no degenerate triangles.
struct RivalMesh {
    std::vector<std::byte> bytes;
    std::vector<double> largest_errors;  ///< of each attribute of the mesh, of any value of any vertex
    std::string invalid;                 ///< in what the decoded mesh differs beyond that; empty if in nothing
};

/// Indices and attributes as they lie in memory: u16 indices up to 65,536 vertices, else u32.
RivalMesh store_raw(const Mesh& mesh);

/// meshopt_encodeIndexBuffer and meshopt_encodeVertexBuffer, the attributes interleaved or a stream each, in
/// meshoptimizer's order for the vertex cache or that for strips: the smallest. Quantized attributes have the integers
/// of an .lr file, 8, 16 or 32 bits each; an attribute fills a multiple of 4 bytes.
/// Errors: those of check_valences; unsupported (more than 256 bytes a vertex in one attribute).
Result<RivalMesh> encode_meshopt_mesh(const Mesh& mesh, const AttributeBits& bits);

/// Draco's edgebreaker, speed 0, vertices of equal values joined first as its own tools do. Attributes are quantized by
/// Draco to the bits of the options; without bits, their values are stored as they are. Vertices of no triangle are
/// lost. Encodes a second time, with the vertices numbered, to compare triangles and values.
/// Errors: unsupported (built without Draco; Draco drops triangles, or refuses the mesh).
Result<RivalMesh> encode_draco_mesh(const Mesh& mesh, const AttributeBits& bits);

/// Draco's edgebreaker alone, at a compression level of its tools: 0 to 10, the smallest; 7 is their default. It may
/// drop triangles. Errors: unsupported (built without Draco; Draco refuses the mesh).
Result<std::vector<std::byte>> draco_bytes(const Mesh& mesh, const AttributeBits& bits, int level);

/// A mesh as a program takes it from a decoder: an index list, and each attribute's values vertex by vertex.
struct DecodedRival {
    std::vector<std::uint32_t> indices;
    std::vector<std::vector<std::byte>> attributes;
};
/// Errors: malformed; unsupported (built without Draco). Cost: O(mesh).
Result<DecodedRival> decode_draco(std::span<const std::byte> bytes);

/// "0.18, index codec 1, vertex codec 0": versions of the libraries that the program was built with; "" of one that it
/// lacks.
std::string meshopt_version();
std::string draco_version();

/// The triangles, each rotated so that its smallest vertex leads, sorted; those with a repeated vertex left out. With
/// `order`, vertex v is order[v].
std::vector<std::array<std::uint32_t, 3>> oriented_triangles(const std::vector<std::uint32_t>& indices,
                                                             const std::vector<std::uint32_t>& order);

struct VertexIntegers;  // lrcore/codec/vertices/quantize.h
/// An attribute's integers on the lattice, or octahedral, that an .lr file has for it; none where it stays lossless.
std::optional<VertexIntegers> quantized(const Attribute& attribute, const AttributeBits& bits);

}  // namespace lacedring
