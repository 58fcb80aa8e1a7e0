// Encodes whole meshes with meshoptimizer's codecs, as gltfpack -c does.

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <utility>

#include "lrcore/base/try.h"
#include "lrcore/codec/vertices/quantize.h"
#include "lrlab/rivals/codecs.h"
#include "lrlab/rivals/whole_mesh.h"

namespace lacedring {
namespace {

constexpr int kVertexCodec = MESHOPTIMIZER_VERSION >= 230 ? 1 : 0;
constexpr std::size_t kLargestStride = 256;  // limit of meshopt_encodeVertexBuffer

/// A vertex buffer.
struct VertexBuffer {
    std::size_t stride = 0;
    std::vector<std::uint8_t> data;
};

std::size_t padded(std::size_t bytes) {
    return (bytes + 3) / 4 * 4;
}

/// Packs integers to `width` bytes each, and pads each vertex to a multiple of 4 bytes.
VertexBuffer pack(const std::vector<std::uint32_t>& values, std::size_t components, std::size_t width) {
    VertexBuffer out{padded(components * width), {}};
    const std::size_t vertices = values.size() / components;
    out.data.resize(vertices * out.stride);
    for (std::size_t i = 0; i < values.size(); ++i) {
        std::uint8_t* at = out.data.data() + i / components * out.stride + i % components * width;
        std::memcpy(at, &values[i], width);  // little-endian
    }
    return out;
}

/// Packs integers to the fewest bytes. Lattice integers are made relative to the minimum of their component; octahedral
/// integers are signed.
VertexBuffer pack(VertexIntegers integers) {
    const std::size_t n = integers.components;
    if (integers.mapping == VertexMapping::octahedral) return pack(integers.values, n, integers.bits <= 8 ? 1 : 2);
    std::uint32_t most = 0;
    for (std::size_t c = 0; c < n; ++c) {
        std::int32_t low = INT32_MAX;
        for (std::size_t i = c; i < integers.values.size(); i += n)
            low = std::min(low, static_cast<std::int32_t>(integers.values[i]));
        for (std::size_t i = c; i < integers.values.size(); i += n) {
            integers.values[i] -= static_cast<std::uint32_t>(low);
            most = std::max(most, integers.values[i]);
        }
    }
    return pack(integers.values, n, most < 256 ? 1 : most < 65536 ? 2 : 4);
}

/// Pads an attribute's values to a multiple of 4 bytes a vertex.
VertexBuffer pack(const Attribute& attribute) {
    VertexBuffer out{padded(attribute.stride()), {}};
    const std::size_t vertices = attribute.data.size() / attribute.stride();
    out.data.resize(vertices * out.stride);
    for (std::size_t v = 0; v < vertices; ++v) {
        std::memcpy(out.data.data() + v * out.stride, attribute.data.data() + v * attribute.stride(),
                    attribute.stride());
    }
    return out;
}

VertexBuffer reorder(const VertexBuffer& buffer, const std::vector<std::uint32_t>& order) {
    VertexBuffer out{buffer.stride, std::vector<std::uint8_t>(buffer.data.size())};
    for (std::size_t v = 0; v < order.size(); ++v) {
        std::memcpy(out.data.data() + v * buffer.stride, buffer.data.data() + order[v] * buffer.stride, buffer.stride);
    }
    return out;
}

VertexBuffer interleave(const std::vector<VertexBuffer>& buffers, std::size_t vertices) {
    VertexBuffer out;
    for (const VertexBuffer& buffer : buffers) out.stride += buffer.stride;
    out.data.resize(vertices * out.stride);
    std::size_t offset = 0;
    for (const VertexBuffer& buffer : buffers) {
        for (std::size_t v = 0; v < vertices; ++v) {
            std::memcpy(out.data.data() + v * out.stride + offset, buffer.data.data() + v * buffer.stride,
                        buffer.stride);
        }
        offset += buffer.stride;
    }
    return out;
}

/// Appends the stream of a buffer. Returns whether it decodes to the buffer.
bool append(std::vector<std::uint8_t>& bytes, const VertexBuffer& buffer, std::size_t vertices) {
    std::vector<std::uint8_t> stream(meshopt_encodeVertexBufferBound(vertices, buffer.stride));
    stream.resize(
        meshopt_encodeVertexBuffer(stream.data(), stream.size(), buffer.data.data(), vertices, buffer.stride));
    bytes.insert(bytes.end(), stream.begin(), stream.end());
    std::vector<std::uint8_t> decoded(buffer.data.size());
    return meshopt_decodeVertexBuffer(decoded.data(), vertices, buffer.stride, stream.data(), stream.size()) == 0 &&
           decoded == buffer.data;
}

}  // namespace

Result<RivalMesh> encode_meshopt_mesh(const Mesh& mesh, const AttributeBits& bits) {
    meshopt_encodeVertexVersion(kVertexCodec);
    RivalMesh out;
    std::vector<VertexBuffer> buffers;
    std::size_t stride = 0;
    for (const Attribute& attribute : mesh.attributes) {
        std::optional<VertexIntegers> integers = quantized(attribute, bits);
        out.largest_errors.push_back(integers ? integers->largest_error : 0);
        buffers.push_back(integers ? pack(std::move(*integers)) : pack(attribute));
        stride += buffers.back().stride;
        if (buffers.back().stride > kLargestStride) {
            return Error{ErrorCode::unsupported, fmt::format("{} has more than 256 bytes a vertex", attribute.name)};
        }
    }
    LR_ASSIGN(auto orders, encode_meshopt_orders(mesh.indices, mesh.vertex_count));
    const auto triangles = oriented_triangles(mesh.indices, {});
    std::vector<std::uint8_t> smallest;
    for (const CodedIndices& coded : orders) {
        if (oriented_triangles(coded.indices, coded.order) != triangles) out.invalid = "triangles decoded differ";
        std::vector<VertexBuffer> ordered;
        for (const VertexBuffer& buffer : buffers) ordered.push_back(reorder(buffer, coded.order));
        for (const bool together : {false, true}) {
            if (together && (ordered.size() < 2 || stride > kLargestStride)) continue;
            std::vector<std::uint8_t> bytes = coded.bytes;
            bool same = true;
            if (together) {
                same = append(bytes, interleave(ordered, mesh.vertex_count), mesh.vertex_count);
            } else {
                for (const VertexBuffer& buffer : ordered) same = append(bytes, buffer, mesh.vertex_count) && same;
            }
            if (!same) out.invalid = "vertices decoded differ";
            if (smallest.empty() || bytes.size() < smallest.size()) smallest = std::move(bytes);
        }
    }
    const std::span<const std::byte> all = std::as_bytes(std::span(smallest));
    out.bytes.assign(all.begin(), all.end());
    return out;
}

std::string meshopt_version() {
    return fmt::format("{}.{}, index codec 1, vertex codec {}", MESHOPTIMIZER_VERSION / 1000,
                       MESHOPTIMIZER_VERSION % 1000 / 10, kVertexCodec);
}

}  // namespace lacedring
