#pragma once
// A mesh prepared for drawing: normalized positions, normals, and the streams to draw it from.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lacedring/base.hpp"
#include "lacedring/lacedring.hpp"
#include "lacedring/materials.hpp"
#include "lacedring/mesh.hpp"
#include "lacedring/ring.hpp"
#include "lacedring/seams.hpp"
#include "lacedring/surface.hpp"
#include "lacedring/vertices.hpp"

namespace lacedring::gpu {

/// Texture coordinates and color of a vertex for View::material: LR_SHADING_WORDS words.
struct Shading {
    float texture[4];        ///< TEXCOORD_0, TEXCOORD_1
    std::uint16_t color[4];  ///< COLOR_0, 65535 is 1
};

/// Positions are moved and scaled so that the used vertices fill the unit sphere: f32 depth and derivatives then have
/// the same precision for every mesh, and all sources draw the same numbers. This takes one float subtraction and one
/// float product, which shaders repeat bit for bit (unit_position in shaders/draw/draw_push.glsl).
struct Model {
    std::span<const std::uint32_t> indices;  ///< 3 per triangle; the mesh's own, which must outlive the model
    std::vector<float> positions;            ///< 3 per vertex, in the mesh's own vertex order
    std::vector<float> normals;              ///< 3 per vertex, of length 1
    EncodedLean lean;
    EncodedPacked packed;                   ///< empty unless ModelOptions::packed
    EncodedVertices vertices;               ///< positions in the packed stream's vertex order; may be empty
    lacedring::Surface surface;             ///< the surface that the streams encode
    EncodedSeams lean_seams, packed_seams;  ///< if the mesh has seams. copy_order: the mesh's vertex of every copy
    std::string exact;                      ///< why `vertices` is lossless although a lattice was requested, or empty
    std::array<double, 3> center{};         ///< of the unit sphere, in the mesh's coordinates; float values
    double radius = 1;                      ///< of the unit sphere, in the mesh's coordinates
    std::array<float, 4> unit{0, 0, 0, 1};  ///< center and 1 / radius: DrawConstants::unit
    const Materials* materials = nullptr;   ///< for View::material; must outlive the model. Null: none
    std::uint64_t materials_number = 0;     ///< unique in the program for each add_materials call; 0 before
    std::vector<Shading> shading;           ///< for View::material, by vertex of the mesh; may be empty
    double mean_edge = 0;                   ///< mean length of the triangles' edges, in the unit sphere

    std::uint32_t surface_of(std::uint32_t vertex) const {
        return surface.has_seams() ? surface.vertex_of[vertex] : vertex;
    }
    std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(positions.size() / 3); }
    std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(indices.size() / 3); }
};

struct ModelOptions {
    RingOptions ring{};
    LeanOptions lean{};
    bool packed = false;  ///< encodes the packed stream, too
    /// With `packed`: encodes a vertex stream of the positions, lossless or on a lattice if possible. The model takes
    /// its positions, and its normals if the mesh has none, from the decoded stream.
    std::optional<VertexOptions> vertices = {};
    OptimizeOptions optimize = {.passes = 0};  ///< of the rings, by each stream's own cost function
    /// The surface of the mesh. The streams hold its triangles, and get seam sections if it has seams.
    lacedring::Surface surface = {};
};

/// The triangles of the model's surface, 3 vertices each: model.indices if it has no seams.
std::vector<std::uint32_t> surface_triangles(const Model& model);

/// The positions of the surface's vertices, 3 floats each. Cost: O(V).
std::vector<float> surface_positions(const Model& model);

/// Makes a model without streams (positions, normals, sizes), for callers that encode the streams themselves.
/// Cost: O(V + T).
/// Errors: unsupported (no triangles, extent zero or past f32), invalid_argument (a surface of another mesh).
Result<Model> make_surface(const Mesh& mesh, const lacedring::Surface& surface = {});

/// Adds materials, and the shading of the mesh that the model was made from. `materials` must outlive the model.
void add_materials(Model& model, const Mesh& mesh, const Materials& materials);

/// Encodes the seam sections of the model's streams again, if its surface has seams. Errors: those of encode_seams.
Result<void> encode_seams(Model& model);

/// Makes a model and encodes its streams (corner table, ring, streams). Cost: O(V + T) per seed and pass. Errors: those
/// of make_surface, build_corner_table, encode_lean, encode_smallest_packed, encode_vertices and encode_seams.
Result<Model> make_model(const Mesh& mesh, const ModelOptions& options = {});

}  // namespace lacedring::gpu
