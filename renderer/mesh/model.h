#pragma once
// A mesh made ready to draw, from its own index list and from its streams.

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

/// What a vertex is drawn with by View::material: LR_SHADING_WORDS.
struct Shading {
    float texture[4];         ///< TEXCOORD_0, TEXCOORD_1
    std::uint16_t colour[4];  ///< COLOR_0, 65535 is 1
};

/// Positions are moved and scaled so that the used vertices fill the unit sphere: f32 depth and derivatives then mean
/// the same for every mesh, and all sources draw exactly the same numbers. One subtraction and one product of floats
/// do it, which a shader repeats to the bit (unit_position of shaders/draw/draw_push.glsl).
struct Model {
    std::span<const std::uint32_t> indices;  ///< of the mesh, which must outlive the model; 3 a triangle
    std::vector<float> positions;            ///< 3 a vertex, in the mesh's own vertex order
    std::vector<float> normals;              ///< 3 a vertex, unit
    EncodedLean lean;
    EncodedPacked packed;                   ///< empty unless asked for
    EncodedVertices vertices;               ///< likewise: the positions, in the packed stream's vertex order
    lacedring::Surface surface;             ///< which the streams are of
    EncodedSeams lean_seams, packed_seams;  ///< of a mesh with seams. copy_order: the mesh's vertex of every copy
    std::string exact;                      ///< why they are lossless although a lattice was asked for, or empty
    std::array<double, 3> centre{};         ///< of the unit sphere, in the mesh's coordinates: floats
    double radius = 1;                      ///< likewise
    std::array<float, 4> unit{0, 0, 0, 1};  ///< centre and 1 / radius: DrawConstants::unit
    /// What View::material draws: of its triangles, which must outlive the model; null: none. And what it reads of each
    /// vertex; empty: there is nothing.
    const Materials* materials = nullptr;
    std::uint64_t materials_number = 0;  ///< another one after each add_materials, in the whole program
    std::vector<Shading> shading;
    double mean_edge = 0;  ///< mean length of the triangles' edges, of the unit sphere

    std::uint32_t surface_of(std::uint32_t vertex) const {
        return surface.has_seams() ? surface.vertex_of[vertex] : vertex;
    }
    std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(positions.size() / 3); }
    std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(indices.size() / 3); }
};

struct ModelOptions {
    RingOptions ring{};
    LeanOptions lean{};
    bool packed = false;  ///< the packed stream too
    /// And a vertex stream of the positions: lossless, or on a lattice where that can be. The model's positions, and
    /// normals where the mesh has none, are then of what it decodes to. With `packed` only.
    std::optional<VertexOptions> vertices = {};
    OptimizeOptions optimize = {.passes = 0};  ///< of the rings; the cost is each stream's own
    /// The surface of the mesh, whose triangles the streams hold. They have seam sections where it has seams.
    lacedring::Surface surface = {};
};

/// The surface's triangles: `model.indices`, or those of its surface.
std::vector<std::uint32_t> surface_triangles(const Model& model);

/// The positions of the surface's vertices, 3 floats each. Cost: O(V).
std::vector<float> surface_positions(const Model& model);

/// A model without streams, for who encodes them himself: positions, normals, sizes. Cost: O(V + T).
/// Errors: unsupported (no triangles, extent zero or past f32), invalid_argument (a surface of another mesh).
Result<Model> make_surface(const Mesh& mesh, const lacedring::Surface& surface = {});

/// Adds the materials of the mesh that the model was made of, and its shading. `materials` has to outlive the model.
void add_materials(Model& model, const Mesh& mesh, const Materials& materials);

/// Makes the seam sections of the model's streams anew, where it has a surface of its own. Errors: encode_seams'.
Result<void> encode_seams(Model& model);

/// Normalises, and encodes the streams (corner table, ring, streams). Cost: O(V + T).
/// Errors: make_surface's, build_corner_table's too_large, encode_seams'.
Result<Model> make_model(const Mesh& mesh, const ModelOptions& options = {});

}  // namespace lacedring::gpu
