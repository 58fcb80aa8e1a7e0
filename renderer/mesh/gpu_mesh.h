#pragma once
// A mesh on the device: what its picture is drawn from.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/mesh/model.h"
#include "renderer/vk/buffer.h"
#include "renderer/vk/transfer.h"

namespace lacedring::gpu {

/// Of a stream the device makes the index buffer and the draw commands.
enum class Source {
    plain,            ///< the mesh's own index list and vertex order
    lean,             ///< the lean stream, with its vertex order
    packed,           ///< the packed stream, with its vertex order
    packed_vertices,  ///< likewise, and positions from a vertex stream
};
/// True if triangles come from the packed stream.
constexpr bool is_packed(Source source) {
    return source == Source::packed || source == Source::packed_vertices;
}

/// How triangles come from a stream into a picture. Source::plain is always drawn by Path::compute.
enum class Path {
    compute,   ///< compute shaders expand the streams to an index buffer and vertices, which are drawn
    pull,      ///< the vertex shader decodes the triangle of its vertex; no index buffer, no vertex buffer bound
    geometry,  ///< a geometry shader decodes four slots a point
    mesh,      ///< a mesh shader decodes 64 slots a workgroup (VK_EXT_mesh_shader)
};

/// Without compute shaders, a draw of Source::packed_vertices decodes half a block of vertices for each corner. A
/// larger mesh than this is drawn so only on request: a picture takes seconds on lavapipe.
constexpr std::uint32_t kMostPulled = 20000;
constexpr bool is_slow(Source source, Path path, std::uint32_t triangles) {
    return source == Source::packed_vertices && path != Path::compute && triangles > kMostPulled;
}

/// By their names on the command line.
struct NamedPath {
    const char* name;
    Path path;
};
constexpr std::array<NamedPath, 4> kPaths{
    {{"compute", Path::compute}, {"pull", Path::pull}, {"geometry", Path::geometry}, {"mesh", Path::mesh}}};
std::optional<Path> path_named(std::string_view name);
struct NamedSource {
    const char* name;
    Source source;
};
constexpr std::array<NamedSource, 4> kSources{{{"plain", Source::plain},
                                               {"lean", Source::lean},
                                               {"packed", Source::packed},
                                               {"packed_vertices", Source::packed_vertices}}};
std::optional<Source> source_named(std::string_view name);
std::vector<std::string> path_names();
std::vector<std::string> source_names();

/// Is this source there in the model?
bool has_source(const Model& model, Source source);
/// The seams of its stream; null where the mesh has none, and for Source::plain.
const EncodedSeams* seams_of(const Model& model, Source source);
/// Bytes of its stream of triangles, seams included; 0 of Source::plain.
std::uint64_t connectivity_bytes(const Model& model, Source source);

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

/// Errors: kNoDevice (Path::mesh where the device has none, indices past the device's, more memory than is left, which
/// is found out before any is allocated), too_large (more than 2^32 indices), invalid_argument (max_range, no such
/// stream in the model, Source::plain by another path than compute), unsupported (only degenerate triangles), and
/// Vulkan's. The model's streams must be valid.
Result<GpuMesh> upload_mesh(Context& context, Transfer& transfer, const Model& model, Source source,
                            const UploadOptions& options);

}  // namespace lacedring::gpu
