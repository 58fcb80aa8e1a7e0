#pragma once
// What a model is drawn from, and how: its index list or one of its streams, by one of four paths.

#include <array>
#include <cstdint>

#include "lacedring/seams.hpp"
#include "lacedring/streams.hpp"
#include "lacedring/vertices.hpp"
#include "renderer/mesh/model.h"
#include "renderer/mesh/named.h"

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

constexpr std::array<Named<Path>, 4> kPaths{{{"compute", Path::compute, "compute"},
                                             {"pull", Path::pull, "vertex pulling"},
                                             {"geometry", Path::geometry, "geometry shader"},
                                             {"mesh", Path::mesh, "mesh shader"}}};
constexpr std::array<Named<Source>, 4> kSources{
    {{"plain", Source::plain, "index list"},
     {"lean", Source::lean, "lean"},
     {"packed", Source::packed, "packed"},
     {"packed_vertices", Source::packed_vertices, "packed, with vertices"}}};

/// Is this source there in the model?
bool has_source(const Model& model, Source source);
/// The seams of its stream; null where the mesh has none, and for Source::plain.
const EncodedSeams* seams_of(const Model& model, Source source);
/// Bytes of its stream of triangles, seams included; 0 of Source::plain.
std::uint64_t connectivity_bytes(const Model& model, Source source);
/// Triangles of it, degenerate ones of a stream included; vertices that are drawn of it.
std::uint64_t slots_of(const Model& model, Source source);
std::uint32_t vertices_of(const Model& model, Source source);

/// What the streams' words are read through. They are of the model, which must stay as it is.
struct StreamViews {
    LeanView lean;      ///< wherever the model has it: it knows the ring
    PackedView packed;  ///< these only of a source that has them
    VertexView vertices;
    SeamView seams;
};
/// Reads the headers of all streams that a source of the model is drawn from, so that nobody reads them again. Errors:
/// malformed, invalid_argument (no such stream in the model, or one of another mesh). Cost: O(1).
Result<StreamViews> view_streams(const Model& model, Source source);

}  // namespace lacedring::gpu
