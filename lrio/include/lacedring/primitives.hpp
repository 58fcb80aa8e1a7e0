#pragma once
// Reads the triangle primitives of a scene one by one, with all their attributes.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "lacedring/base.hpp"
#include "lacedring/mesh.hpp"
#include "lacedring/mesh_files.hpp"

namespace lacedring {

enum class PrimitiveMode : std::uint8_t { triangles, strip, fan };

struct Primitive {
    std::size_t mesh = 0;    ///< index of its mesh in the file
    std::size_t number = 0;  ///< its index in the mesh
    PrimitiveMode mode = PrimitiveMode::triangles;
    /// In the primitive's own coordinates. Strips and fans are converted to triangles. POSITION is first, and converted
    /// to floats; all other attributes keep their types and bits.
    Mesh geometry;
};

/// A 4 x 4 matrix in column-major order, as in glTF.
using Placement = std::array<double, 16>;

inline constexpr Placement kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/// An instance of a mesh in the scene.
struct PlacedMesh {
    std::size_t mesh = 0;
    Placement placement = kIdentity;
};

struct PrimitiveList {
    /// The primitives of all meshes that the scene places, in the order of the file. Each has triangles.
    std::vector<Primitive> primitives;
    /// In the order in which read_mesh joins them: all primitives of the first, then of the second, ...
    std::vector<PlacedMesh> placed;
    std::vector<std::string> mesh_names;  ///< of the file's meshes; "": unnamed
};

/// Reads the triangle primitives of a glTF's default scene; a file of another format is one primitive. Successive
/// primitives of a mesh that share their accessors get only the vertices that their triangles use; other primitives
/// keep all vertices. `report`, if given, is filled even on an error. Errors and safety: as read_mesh; the memory limit
/// counts each primitive once. Cost: O(bytes read), O(n log n) where vertices are shared.
Result<PrimitiveList> read_primitives(const std::filesystem::path& path, const ReadOptions& options = {},
                                      ReadReport* report = nullptr);

/// Reads the primitives from a file in memory; `name` as in read_mesh.
Result<PrimitiveList> read_primitives(std::span<const std::byte> bytes, const std::filesystem::path& name,
                                      const ReadOptions& options = {}, ReadReport* report = nullptr);

/// Applies a placement: transforms positions, normals and tangents as read_mesh does (docs/formats-read.md), which
/// makes them floats, and reverses the triangles if the placement mirrors. The identity changes nothing. Cost: O(mesh).
Mesh place(const Mesh& mesh, const Placement& placement);

/// Is the determinant of the linear part negative?
bool mirrors(const Placement& placement);

}  // namespace lacedring
