#pragma once
// A mesh on the device: what its picture is drawn from.

#include <array>
#include <cstdint>
#include <span>

#include "renderer/mesh/source.h"
#include "renderer/vk/buffer.h"
#include "renderer/vk/transfer.h"

namespace lacedring::gpu {

struct UploadOptions {
    Path path = Path::compute;
    /// Bytes that one storage descriptor may cover: larger buffers are worked on in parts. 0: the device's
    /// maxStorageBufferRange. At least 4096; a test makes it small.
    std::uint64_t max_range = 0;
    std::span<const float> normals;  ///< 3 a vertex of the mesh, instead of the model's; must stay while uploading
    /// Of View::material: the vertices' shading, and the address of GpuMaterials::table.
    std::optional<std::array<std::uint32_t, 2>> materials = {};
    bool ring = false;     ///< triangle classes, and the vertices' places on the rings
    bool offsets = false;  ///< significant bits of the triangles' offsets instead of their classes
    enum class Lines { none, ring, edges, seams } lines = Lines::none;  ///< drawn over the surface
};

/// Triangles are numbered by slot: for Source::plain that is the mesh's own order, for Source::packed the stream's.
/// Buffers of one value a slot are bound at the first slot of each draw command, so that none needs to fit one
/// descriptor.
struct GpuMesh {
    Source source = Source::plain;
    Path path = Path::compute;
    std::uint32_t vertex_count = 0;      ///< of those drawn: of a surface with seams its copies
    std::uint32_t surface_vertices = 0;  ///< of the stream
    std::uint32_t slots = 0;             ///< triangles of the index buffer, degenerate ones too
    std::uint32_t draw_slots = 0;        ///< slots of every draw command but the last: a multiple of 256
    std::uint32_t draws = 0;             ///< draw commands
    std::uint64_t max_range = 0;         ///< bytes a descriptor covers

    Buffer vertices;  ///< Vertex; without positions where pulls_positions()
    /// u32, 3 a slot, padded to whole invocations; of a stream: written by the device. Path::compute, and with seams
    Buffer indices;
    // Of a stream only:
    Buffer stream;
    std::array<std::uint32_t, 4> stream_layout{};  ///< DrawConstants::stream_layout
    Buffer commands;                        ///< VkDrawIndexedIndirectCommand, written by the device. As `indices`
    Buffer slot_triangle;                   ///< the mesh's triangle of each slot
    Buffer vertex_order;                    ///< the mesh's vertex of each one in `vertices`
    Buffer vertex_stream;                   ///< of the positions. Source::packed_vertices
    std::array<float, 4> unit{0, 0, 0, 1};  ///< DrawConstants::unit
    // These are there where the surface has seams. The device writes all of them but the section.
    Buffer seams;          ///< the section
    Buffer homes;          ///< of each vertex of the surface, as lacedring_seams_homes
    Buffer copies;         ///< as `indices`, which are the surface's, of copies
    Buffer copy_vertices;  ///< the surface's vertex of each copy
    Buffer positions;      ///< 3 floats a vertex of the surface. Source::packed_vertices by Path::compute
    // Only if asked for:
    Buffer shading;                            ///< Shading
    std::array<std::uint32_t, 2> materials{};  ///< UploadOptions::materials
    Buffer classes;                            ///< LR_CLASS_*, or bits of offsets, one byte a slot
    Buffer lines;                              ///< u32, 2 a line
    std::uint32_t line_indices = 0;

    bool decoded = false;  ///< the index buffer holds the triangles
    bool rotated = false;  ///< and each begins with its smallest original vertex

    /// Shaders decode each vertex when they want it; no buffer has the positions.
    bool pulls_positions() const { return source == Source::packed_vertices && path != Path::compute; }
    /// Shaders read their slots' copies, instead of decoding the stream's triangles.
    bool pulls_copies() const { return copies && path != Path::compute; }
    const Buffer& drawn_indices() const { return copies ? copies : indices; }
};

/// Device memory that a source of the model takes with these options, before alignment: all that an upload allocates.
/// `largest`: the largest buffer of it. Edges and seams are counted as if no two triangles shared an edge.
struct MeshBytes {
    std::uint64_t all = 0, largest = 0;
};
MeshBytes mesh_bytes(const Model& model, Source source, const UploadOptions& options);

/// A vertex as the vertex shaders read it. The position of Source::packed_vertices is in the mesh's coordinates, and
/// written by the device.
struct Vertex {
    float position[3];
    float normal[3];
    float ring;  ///< place along the rings in [0, 1]; -1 off the rings
};

/// All that an upload is made of.
struct Upload {
    Context& context;
    Transfer& transfer;
    const Model& model;
    Source source;
    const UploadOptions& options;
    StreamViews views;  ///< view_streams(model, source)
};

/// Errors: kNoDevice (Path::mesh where the device has none, indices past the device's, more memory than is left, which
/// is found out before any is allocated), too_large (more than 2^32 indices), invalid_argument (max_range,
/// Source::plain by another path than compute), unsupported (only degenerate triangles), and Vulkan's. The model's
/// streams must be valid.
Result<GpuMesh> upload_mesh(const Upload& upload);

}  // namespace lacedring::gpu
