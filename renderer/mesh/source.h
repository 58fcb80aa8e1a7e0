#pragma once
// Sources a model is drawn from (its index list or one of its streams), and the four paths from a stream to a picture.

#include <array>
#include <cstdint>

#include "lacedring/seams.hpp"
#include "lacedring/streams.hpp"
#include "lacedring/vertices.hpp"
#include "renderer/mesh/model.h"
#include "renderer/mesh/named.h"

namespace lacedring::gpu {

/// The data that triangles and positions come from.
enum class Source {
    plain,            ///< the mesh's own index list and vertex order
    lean,             ///< the lean stream, with its vertex order
    packed,           ///< the packed stream, with its vertex order
    packed_vertices,  ///< the packed stream, with positions from a vertex stream
};
/// True if triangles come from the packed stream.
constexpr bool is_packed(Source source) {
    return source == Source::packed || source == Source::packed_vertices;
}

/// The shader stage that decodes a stream's triangles. Source::plain is always drawn with Path::compute.
enum class Path {
    compute,   ///< compute shaders expand the streams to an index buffer and a vertex buffer before drawing
    pull,      ///< the vertex shader decodes the triangle of its vertex; no index buffer, no vertex buffer bound
    geometry,  ///< a geometry shader decodes four slots per point
    mesh,      ///< a mesh shader decodes 64 slots per workgroup (VK_EXT_mesh_shader)
};

/// Without Path::compute, drawing Source::packed_vertices decodes half a block of vertices on average for each corner.
/// With more triangles than this, a picture takes seconds on lavapipe: it is drawn only on request.
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

/// True if the model has the streams of this source.
bool has_source(const Model& model, Source source);
/// The seam section of the source's stream; null if the mesh has no seams, and for Source::plain.
const EncodedSeams* seams_of(const Model& model, Source source);
/// Bytes of the source's triangle stream, seams included; 0 for Source::plain.
std::uint64_t connectivity_bytes(const Model& model, Source source);
/// Number of triangles of a source (degenerate ones of a stream included), and of vertices that it draws.
std::uint64_t slots_of(const Model& model, Source source);
std::uint32_t vertices_of(const Model& model, Source source);

/// Views of the model's streams. The model must not change while they are used.
struct StreamViews {
    LeanView lean;      ///< set whenever the model has a lean stream: views of the ring need it
    PackedView packed;  ///< this and the next two: only if the source has the stream
    VertexView vertices;
    SeamView seams;
};
/// Reads and checks the headers of all streams that a source is drawn from. Errors: malformed, invalid_argument (the
/// model has no such stream, or one of another mesh). Cost: O(1).
Result<StreamViews> view_streams(const Model& model, Source source);

}  // namespace lacedring::gpu
