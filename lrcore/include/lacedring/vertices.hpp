#pragma once
// Vertex streams: one attribute of a mesh's vertices, in the order of a connectivity stream, in blocks of 128 vertices
// that can be decoded independently. docs/vertex-format.md specifies the format.
//
// Each block stores a vertex as the difference from a prediction by the two previous vertices: along a ring, neighbors
// in the stream are neighbors in the mesh.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/base.hpp"

namespace lacedring {

enum class ComponentType : std::uint8_t { i8 = 0, u8 = 1, i16 = 2, u16 = 3, i32 = 4, u32 = 5, f32 = 6, f64 = 7 };

/// Bytes of one component.
constexpr std::size_t size_of(ComponentType type) {
    constexpr std::uint8_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<std::size_t>(type)];
}

/// Vertices per block.
constexpr std::uint32_t kVertexBlock = 128;

/// The meaning of a stream's integers.
enum class VertexMapping : std::uint8_t {
    integers,    ///< the values themselves
    lattice,     ///< lattice points through the origin: integer * step, exact as a float
    octahedral,  ///< unit vectors as two integers; tangents also have the sign of w
    floats,      ///< the bits of floats
    decimals,    ///< floats that stem from decimal text: integer / 10^digits, and exceptions
    doubles,     ///< the bits of doubles
};

/// A view of an attribute's values: vertices * components, tightly packed, little-endian.
struct VertexValues {
    ComponentType type = ComponentType::f32;
    std::uint8_t components = 3;
    bool normalized = false;  ///< integers represent [0,1] or [-1,1]
    std::span<const std::byte> data;

    std::size_t stride() const { return size_of(type) * components; }
};

struct VertexOptions {
    /// lattice and octahedral are lossy and take floats (lattice also doubles). Any other value selects the lossless
    /// mapping for the type. Floats are stored as decimals, which are lossless, if that is smaller.
    VertexMapping mapping = VertexMapping::floats;
    /// lattice: bits of the integers along the largest extent, 1 to 22; octahedral: bits of each integer, 2 to 16.
    std::uint32_t bits = 14;
    /// lattice: the step, instead of `bits`; 0: use `bits`. Meshes with the same step stay joined without cracks. The
    /// step is rounded up until every product is exact; powers of two do not change.
    float step = 0;
    /// Lattice and octahedral: the error that the values already have (quantize_vertices).
    double lost_before = 0;
    unsigned threads = 1;  ///< maximum number; does not change the words
};

/// A step for meshes that share a lattice: the smallest step >= `step` whose products with all integers up to largest /
/// step are exact floats. `largest` is the largest absolute coordinate of the meshes. Returns 0 if there is none.
float lattice_step(double step, double largest);

/// Replaces values by the values that their stream decodes to, so that vertices that become equal can be merged before
/// encoding. Returns the largest error of any component, for VertexOptions::lost_before. `values` are floats, tightly
/// packed; options.mapping is lattice or octahedral. Cost: O(V). Errors: as encode_vertices; the values are then
/// unchanged.
Result<double> quantize_vertices(std::span<std::byte> values, std::uint8_t components, const VertexOptions& options);

struct EncodedVertices {
    std::vector<std::uint32_t> words;  ///< the whole stream
    double largest_error = 0;          ///< maximum over components; at most half a lattice's step
};

/// Encodes an attribute. Cost: O(V) time, one to five microseconds per vertex on one thread; 4 bytes per component
/// beside the stream. Errors: invalid_argument (sizes, bits, a mapping that does not fit the type, more than 16
/// integers per vertex; lattice values that are not finite, or too far from the origin for the step to be exact;
/// tangents with a w other than 1 or -1), too_large (16 GiB).
Result<EncodedVertices> encode_vertices(const VertexValues& values, const VertexOptions& options = {});

/// A view of a vertex stream with its header parsed. Does not own the words.
struct VertexView {
    std::span<const std::uint32_t> words;
    std::uint32_t vertices = 0;
    VertexMapping mapping = VertexMapping::integers;
    ComponentType type = ComponentType::f32;
    bool normalized = false;
    std::uint8_t components = 0;  ///< attribute values per vertex
    /// Stream integers per vertex: one fewer than components for octahedral, twice as many for doubles.
    std::uint8_t integers = 0;
    std::uint8_t bits = 0;         ///< octahedral: bits of each integer
    std::uint8_t digits = 0;       ///< decimals: digits after the point
    std::uint32_t exceptions = 0;  ///< decimals: number of floats stored verbatim
    float step = 0;                ///< lattice only
    float largest_error = 0;

    std::uint32_t blocks() const { return vertices / kVertexBlock + (vertices % kVertexBlock == 0 ? 0 : 1); }
    /// Bytes of the decoded attribute.
    std::size_t decoded_bytes() const { return std::size_t{vertices} * components * size_of(type); }
};

/// Reads the header and checks sizes only. Errors: malformed. Untrusted input: safe.
Result<VertexView> view_vertices(std::span<const std::uint32_t> words);

/// Checks everything that decoders rely on, including the checksum. Cost: O(V). Untrusted input: safe.
Result<VertexView> validate_vertices(std::span<const std::uint32_t> words);

/// Decodes the attribute's values: view.decoded_bytes() bytes. Cost: O(V), no allocation.
void decode_vertices(const VertexView& view, std::span<std::byte> values);

/// validate_vertices and decode_vertices in one pass, for a view of view_vertices. Errors: malformed; the values are
/// then undefined. Cost: O(V), no allocation. Untrusted input: safe.
Result<void> decode_vertices_checked(const VertexView& view, std::span<std::byte> values);

/// Decodes the integers of one block: view.integers per vertex, for at most kVertexBlock vertices.
void decode_vertex_block(const VertexView& view, std::uint32_t block, std::span<std::uint32_t> integers);

}  // namespace lacedring
