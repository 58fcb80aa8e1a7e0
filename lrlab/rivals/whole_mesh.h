#pragma once
// Whole meshes (connectivity and attributes) in rival formats.

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

/// A mesh in a rival's format. The original mesh has no degenerate triangles.
struct RivalMesh {
    std::vector<std::byte> bytes;
    std::vector<double> largest_errors;  ///< largest error of each attribute of the mesh
    std::string invalid;                 ///< how the decoded mesh differs otherwise; empty: it does not
};

/// Stores plain indices and attributes: u16 indices up to 65,536 vertices, else u32.
RivalMesh store_raw(const Mesh& mesh);

/// meshopt_encodeIndexBuffer and meshopt_encodeVertexBuffer. Returns the smallest of the variants: attributes
/// interleaved or separate, triangles ordered for the vertex cache or for strips. Quantized attributes have the
/// integers of an .lr file, 8, 16 or 32 bits each; attributes are padded to 4 bytes. Errors: those of check_valences;
/// unsupported (an attribute has more than 256 bytes a vertex).
Result<RivalMesh> encode_meshopt_mesh(const Mesh& mesh, const AttributeBits& bits);

/// Draco's Edgebreaker, speed 0, after joining vertices of equal values as its tools do. Draco quantizes attributes to
/// `bits`; attributes without bits are lossless. Unused vertices are lost. Encodes a second time with numbered vertices
/// to compare triangles and values. Errors: unsupported (built without Draco; Draco drops triangles or refuses the
/// mesh).
Result<RivalMesh> encode_draco_mesh(const Mesh& mesh, const AttributeBits& bits);

/// Draco's Edgebreaker without the comparison. `level` is the compression level of Draco's tools: 0 to 10 (smallest); 7
/// is their default. Draco may drop triangles. Errors: unsupported (built without Draco; Draco refuses the mesh).
Result<std::vector<std::byte>> draco_bytes(const Mesh& mesh, const AttributeBits& bits, int level);

/// A decoded mesh: an index list, and the values of each attribute vertex by vertex.
struct DecodedRival {
    std::vector<std::uint32_t> indices;
    std::vector<std::vector<std::byte>> attributes;
};
/// Errors: malformed; unsupported (built without Draco). Cost: O(mesh).
Result<DecodedRival> decode_draco(std::span<const std::byte> bytes);

/// Versions of the libraries, such as "0.18, index codec 1, vertex codec 0"; "": built without the library.
std::string meshopt_version();
std::string draco_version();

/// The sorted triangles without degenerate ones, each rotated so that its smallest vertex comes first. A nonempty
/// `order` replaces each vertex v by order[v].
std::vector<std::array<std::uint32_t, 3>> oriented_triangles(const std::vector<std::uint32_t>& indices,
                                                             const std::vector<std::uint32_t>& order);

struct VertexIntegers;  // lrcore/codec/vertices/quantize.h
/// The lattice or octahedral integers that an .lr file has for an attribute; none if the attribute stays lossless.
std::optional<VertexIntegers> quantized(const Attribute& attribute, const AttributeBits& bits);

}  // namespace lacedring
