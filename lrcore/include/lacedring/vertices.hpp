#pragma once
// Vertex streams: the attribute of a mesh's vertices, in the order of a connectivity stream, in blocks of 128 vertices
// that decode alone. docs/vertex-format.md has the format to the bit.
//
// Each block stores a vertex as the difference from what the two vertices before it lead one to expect: along a ring,
// neighbors in the stream are neighbors in the mesh.

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

/// Vertices of a block.
constexpr std::uint32_t kVertexBlock = 128;

/// The meaning of a stream's integers.
enum class VertexMapping : std::uint8_t {
    integers,    ///< themselves
    lattice,     ///< points of a lattice through the origin: integer * step, exact as a float
    octahedral,  ///< unit vectors by two integers; tangents by those and the sign of their w
    floats,      ///< the bits of floats
    decimals,    ///< floats that were decimal text: integer / 10^digits, and exceptions
    doubles,     ///< the bits of doubles
};

/// Values of an attribute somewhere in memory: vertices * components, tightly packed, little-endian.
struct VertexValues {
    ComponentType type = ComponentType::f32;
    std::uint8_t components = 3;
    bool normalized = false;  ///< integers stand for [0,1] or [-1,1]
    std::span<const std::byte> data;

    std::size_t stride() const { return size_of(type) * components; }
};

struct VertexOptions {
    /// lattice and octahedral take floats (a lattice also doubles) and lose something; any other mapping is lossless
    /// and what suits the type, whichever is named. Floats that are smaller as decimals, which are lossless, become
    /// those.
    VertexMapping mapping = VertexMapping::floats;
    /// lattice: of the integers along the largest extent, 1 to 22; octahedral: of each integer, 2 to 16.
    std::uint32_t bits = 14;
    /// lattice: the step instead of `bits`. Meshes with the same step meet without cracks where they met before. It is
    /// rounded up to where every product is exact; a power of two never is.
    float step = 0;
    double lost_before = 0;  ///< lattice and octahedral: the error that the values have already (quantize_vertices)
    unsigned threads = 1;    ///< run on at most that many; the same words for any
};

/// The least step of at least `step` whose products with all integers up to largest / step are floats: for meshes that
/// are to share a lattice, of which `largest` is the farthest coordinate from 0. 0: there is none.
float lattice_step(double step, double largest);

/// Replaces values by those that a stream of them decodes to, so that vertices that become the same can be merged
/// before they are encoded. Returns the largest error of any component, for VertexOptions::lost_before. `values` are
/// floats, tightly packed; `options` say lattice or octahedral. Cost: O(V). Errors: encode_vertices'; the values are
/// then as they were.
Result<double> quantize_vertices(std::span<std::byte> values, std::uint8_t components, const VertexOptions& options);

struct EncodedVertices {
    std::vector<std::uint32_t> words;  ///< the whole stream
    double largest_error = 0;          ///< of any component of any vertex; at most half the step of a lattice
};

/// Encodes an attribute. Cost: O(V) time, one to five microseconds a vertex on one thread; 4 bytes a component beside
/// the stream. Errors: invalid_argument (sizes, bits, a mapping that the type does not have, more than 16 integers a
/// vertex; values for a lattice that are not finite, or so far from the origin that floats have no such step; tangents
/// with a w other than 1 or -1), too_large (16 GiB).
Result<EncodedVertices> encode_vertices(const VertexValues& values, const VertexOptions& options = {});

/// A vertex stream somewhere in memory, its header read. Holds no copy.
struct VertexView {
    std::span<const std::uint32_t> words;
    std::uint32_t vertices = 0;
    VertexMapping mapping = VertexMapping::integers;
    ComponentType type = ComponentType::f32;
    bool normalized = false;
    std::uint8_t components = 0;   ///< values of the attribute a vertex
    std::uint8_t integers = 0;     ///< of the stream a vertex: one less if octahedral, twice as many of doubles
    std::uint8_t bits = 0;         ///< octahedral: of each integer
    std::uint8_t digits = 0;       ///< decimals: behind the point
    std::uint32_t exceptions = 0;  ///< decimals: floats that are stored as they are
    float step = 0;                ///< of a lattice
    float largest_error = 0;

    std::uint32_t blocks() const { return vertices / kVertexBlock + (vertices % kVertexBlock == 0 ? 0 : 1); }
    /// Bytes of the decoded attribute.
    std::size_t decoded_bytes() const { return std::size_t{vertices} * components * size_of(type); }
};

/// Reads the header and checks sizes only. Errors: malformed. Untrusted input: safe.
Result<VertexView> view_vertices(std::span<const std::uint32_t> words);

/// Checks everything that decoders rely on, the checksum included. Cost: O(V). Untrusted input: safe.
Result<VertexView> validate_vertices(std::span<const std::uint32_t> words);

/// The attribute's values: view.decoded_bytes() of them. Cost: O(V), no allocation.
void decode_vertices(const VertexView& view, std::span<std::byte> values);

/// validate_vertices and decode_vertices in one pass, for a stream whose header alone was read. Errors: malformed; the
/// values are then of no use. Cost: O(V), no allocation. Untrusted input: safe.
Result<void> decode_vertices_checked(const VertexView& view, std::span<std::byte> values);

/// Integers of the vertices of one block, view.integers each; at most kVertexBlock vertices.
void decode_vertex_block(const VertexView& view, std::uint32_t block, std::span<std::uint32_t> integers);

}  // namespace lacedring
