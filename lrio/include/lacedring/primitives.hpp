#pragma once
// The triangle primitives of a scene one by one, each as the file has it.

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
    std::size_t mesh = 0;    ///< number of its mesh in the file
    std::size_t number = 0;  ///< its own number in the mesh
    PrimitiveMode mode = PrimitiveMode::triangles;
    /// In the primitive's own coordinates, with all its attributes, POSITION first. Strips and fans are cut into
    /// triangles. POSITION is of floats; all other values are as the file has them.
    Mesh geometry;
};

/// 4 x 4, column by column, as glTF has it.
using Placement = std::array<double, 16>;

inline constexpr Placement kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/// A place where the scene puts all primitives of a mesh.
struct PlacedMesh {
    std::size_t mesh = 0;
    Placement placement = kIdentity;
};

struct PrimitiveList {
    /// The primitives of all meshes that the scene places, in the order of the file. Each has triangles.
    std::vector<Primitive> primitives;
    /// In the order in which read_mesh joins them: primitives of the first one, of the second one, ...
    std::vector<PlacedMesh> placed;
    std::vector<std::string> mesh_names;  ///< of the file's meshes; "" where there is none
};

/// Reads the triangle primitives of a glTF's default scene; a file of another format is one primitive. Successive
/// primitives of a mesh that have the same accessors get the vertices that their triangles use; any other keeps
/// all. `report`, if given, is filled even on an error. Errors and safety: read_mesh's; the limit counts each primitive
/// once. Cost: O(what is read), O(n log n) where vertices are shared.
Result<PrimitiveList> read_primitives(const std::filesystem::path& path, const ReadOptions& options = {},
                                      ReadReport* report = nullptr);

/// The same of a file that is in memory; `name` is read_mesh's.
Result<PrimitiveList> read_primitives(std::span<const std::byte> bytes, const std::filesystem::path& name,
                                      const ReadOptions& options = {}, ReadReport* report = nullptr);

/// The mesh where a scene puts it: positions, normals and tangents transformed as read_mesh does
/// (docs/formats-read.md), floats afterwards; triangles turned round where the placement mirrors. The identity changes
/// nothing. Cost: O(mesh).
Mesh place(const Mesh& mesh, const Placement& placement);

/// Has the linear part a negative determinant?
bool mirrors(const Placement& placement);

}  // namespace lacedring
