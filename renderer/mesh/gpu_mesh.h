#pragma once
// A mesh on the device: the buffers that its pictures are drawn from.

#include <array>
#include <cstdint>
#include <span>

#include "renderer/mesh/source.h"
#include "renderer/vk/buffer.h"
#include "renderer/vk/transfer.h"

namespace lacedring::gpu {

struct UploadOptions {
    Path path = Path::compute;
    /// Bytes that one storage descriptor may cover; passes process larger buffers in parts. 0: the device's
    /// maxStorageBufferRange. At least 4096. Tests make it small.
    std::uint64_t max_range = 0;
    /// 3 floats per vertex of the mesh, used instead of the model's normals if not empty. Must live until the upload
    /// ends.
    std::span<const float> normals;
    /// View::material: uploads the vertices' shading; the value is the address of GpuMaterials::table.
    std::optional<std::array<std::uint32_t, 2>> materials = {};
    bool ring = false;     ///< uploads triangle classes and the vertices' places on the rings
    bool offsets = false;  ///< with `ring`: significant bits of the triangles' offsets instead of their classes
    enum class Lines { none, ring, edges, seams } lines = Lines::none;  ///< lines to draw over the surface
};

/// Triangles are numbered by slot: in the mesh's own order for Source::plain, else in the stream's order.
/// Buffers with one value per slot are bound at the first slot of each draw command, so that none needs to fit one
/// descriptor.
struct GpuMesh {
    Source source = Source::plain;
    Path path = Path::compute;
    std::uint32_t vertex_count = 0;      ///< vertices drawn; with seams: the copies
    std::uint32_t surface_vertices = 0;  ///< vertices of the stream
    std::uint32_t slots = 0;             ///< triangles of the index buffer, degenerate ones included
    std::uint32_t draw_slots = 0;        ///< slots of every draw command but the last: a multiple of 256
    std::uint32_t draws = 0;             ///< number of draw commands
    std::uint64_t max_range = 0;         ///< largest range of a descriptor, in bytes

    Buffer vertices;  ///< Vertex; without positions if pulls_positions()
    /// u32, 3 per slot, padded to whole invocations; for streams, the device writes it. Exists with Path::compute and
    /// for streams with seams.
    Buffer indices;
    // Only for streams:
    Buffer stream;
    std::array<std::uint32_t, 4> stream_layout{};  ///< DrawConstants::stream_layout
    Buffer commands;                               ///< VkDrawIndexedIndirectCommand, written together with `indices`
    Buffer slot_triangle;                          ///< by slot: the mesh's triangle
    Buffer vertex_order;                           ///< by vertex of `vertices`: the mesh's vertex
    Buffer vertex_stream;                          ///< positions of Source::packed_vertices
    std::array<float, 4> unit{0, 0, 0, 1};         ///< DrawConstants::unit
    // Only if the surface has seams; the device writes all of them but `seams`:
    Buffer seams;          ///< the seam section
    Buffer homes;          ///< by vertex of the surface: its home copies, as lacedring_seams_homes
    Buffer copies;         ///< the index buffer over copies (`indices` is over the surface's vertices)
    Buffer copy_vertices;  ///< by copy: the surface's vertex
    Buffer positions;      ///< 3 floats per vertex of the surface; Source::packed_vertices with Path::compute
    // Only if UploadOptions ask for them:
    Buffer shading;                            ///< Shading
    std::array<std::uint32_t, 2> materials{};  ///< UploadOptions::materials
    Buffer classes;                            ///< one byte per slot: LR_CLASS_*, or LR_OFFSET_* or bits of the offset
    Buffer lines;                              ///< u32, 2 per line
    std::uint32_t line_indices = 0;

    bool decoded = false;  ///< the index buffer holds the triangles
    bool rotated = false;  ///< every triangle begins with its smallest original vertex

    /// True if shaders decode positions from the vertex stream; then no buffer holds them.
    bool pulls_positions() const { return source == Source::packed_vertices && path != Path::compute; }
    /// True if shaders read triangles from `copies` instead of decoding them from the stream.
    bool pulls_copies() const { return copies && path != Path::compute; }
    const Buffer& drawn_indices() const { return copies ? copies : indices; }
};

/// Bytes of device memory that an upload of this source allocates (`all`, before alignment), and bytes of its largest
/// buffer. An upper bound for Lines::edges and seams: counts the lines as if no two triangles shared an edge.
struct MeshBytes {
    std::uint64_t all = 0, largest = 0;
};
MeshBytes mesh_bytes(const Model& model, Source source, const UploadOptions& options);

/// A vertex as the vertex shaders read it. With Source::packed_vertices, the device writes the position, in the mesh's
/// coordinates.
struct Vertex {
    float position[3];
    float normal[3];
    float ring;  ///< place along the rings in [0, 1]; -1 off the rings
};

/// The arguments of upload_mesh.
struct Upload {
    Context& context;
    Transfer& transfer;
    const Model& model;
    Source source;
    const UploadOptions& options;
    StreamViews views;  ///< view_streams(model, source)
};

/// Uploads a mesh. The model's streams must be valid. Errors: kNoDevice (Path::mesh on a device without mesh shaders;
/// vertex numbers past the device's limit; not enough memory, checked before any is allocated), too_large (more than
/// 2^32 indices), invalid_argument (max_range; Source::plain with a path other than compute), unsupported (only
/// degenerate triangles), and those of Vulkan.
Result<GpuMesh> upload_mesh(const Upload& upload);

}  // namespace lacedring::gpu
