#pragma once
// Reads and writes mesh files, and welds meshes.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "lacedring/base.hpp"
#include "lacedring/materials.hpp"
#include "lacedring/mesh.hpp"

namespace lacedring {

enum class MeshFormat : std::uint8_t {
    any,  ///< recognized by content if the format has a signature, else by the extension
    gltf,
    obj,
    off,
    ply,
    stl,
};

struct ReadOptions {
    MeshFormat format = MeshFormat::any;
    bool allow_outside = false;  ///< a glTF may name buffers outside its own folder
    /// Memory limit in bytes for the mesh and the caller's data. 0: 512 MiB or 128 times the bytes read, whichever is
    /// more. There must be a limit because a small file can place its meshes very often.
    std::uint64_t max_bytes = 0;
    std::uint32_t triangle_bytes = 0;  ///< bytes per triangle that the caller will need beside the mesh
    std::uint64_t held_bytes = 0;      ///< bytes of max_bytes that the caller uses already
};

struct ReadReport {
    /// Contents of the file that the mesh lacks, each with its count: "3 materials".
    std::vector<std::string> left_out;
    MeshFormat format = MeshFormat::any;       ///< format of the file
    std::size_t primitives = 1;                ///< number of triangle primitives joined into the mesh
    std::vector<std::filesystem::path> files;  ///< other files that were opened
    std::vector<std::uint64_t> streams;        ///< bytes of each stream of a packed scene, its part codes included
};

/// Reads glTF/GLB (also packed scenes: scene.hpp), OBJ, PLY, OFF/COFF or STL. All meshes and primitives are joined into
/// one triangle list with node transforms applied (read_primitives, primitives.hpp, keeps them apart). The mesh has the
/// attributes that all primitives have, and NORMAL if any primitive has it: the others' normals are computed from their
/// triangles. Polygons are triangulated (docs/formats-read.md). STL vertices at one position are merged.
/// `report`, if given, is filled even on an error. `materials`, if given, gets a glTF's materials. The mesh then has
/// each of TEXCOORD_0, TEXCOORD_1 and COLOR_0 that some primitive has, as floats; the other primitives get 0, or 1 for
/// colors. The report lists the images that cannot be read.
/// Errors: cannot_open, malformed, unsupported, too_large, memory_limit. Untrusted input: safe. Cost: O(bytes read +
/// mesh).
Result<Mesh> read_mesh(const std::filesystem::path& path, const ReadOptions& options = {}, ReadReport* report = nullptr,
                       Materials* materials = nullptr);

/// Reads a mesh from a file in memory. `name` gives the extension and the folder of a glTF's buffers. If it is empty,
/// the format is recognized by content only, and buffers in files are errors.
Result<Mesh> read_mesh(std::span<const std::byte> bytes, const std::filesystem::path& name,
                       const ReadOptions& options = {}, ReadReport* report = nullptr, Materials* materials = nullptr);

/// Differences of a written file from the mesh, a line each: "NORMAL: 3 without a direction were made from the
/// triangles".
using WriteNotes = std::vector<std::string>;

/// Writes GLB, binary PLY or OBJ by the extension of `path` (.glb, .ply, .obj). PLY keeps every attribute bit for bit;
/// GLB keeps what glTF can hold, and OBJ positions, normals, texture coordinates and colors (docs/formats-read.md).
/// `notes`, if given, lists all differences; `bytes`, if given, receives the file's size. The file is complete or
/// untouched (write_file). Errors: cannot_write, invalid_argument (extension, or a mesh that breaks its invariants),
/// unsupported (no triangles), too_large (GLB above 4 GiB). Cost: O(file).
Result<void> write_mesh(const Mesh& mesh, const std::filesystem::path& path, WriteNotes* notes = nullptr,
                        std::uint64_t* bytes = nullptr);

/// Writes GLB (MeshFormat::gltf), PLY or OBJ to an open file descriptor.
Result<void> write_mesh(const Mesh& mesh, MeshFormat format, int descriptor, WriteNotes* notes = nullptr,
                        std::uint64_t* bytes = nullptr);

/// The bytes that write_mesh writes.
Result<std::vector<std::byte>> mesh_file_bytes(const Mesh& mesh, MeshFormat format, WriteNotes* notes = nullptr);

/// The format that write_mesh chooses for a path; any: it cannot write the path.
MeshFormat writable_format(const std::filesystem::path& path);

enum class Weld {
    none,
    attributes,  ///< merges vertices that agree in all attributes
    position,    ///< merges vertices at the same POSITION; the first one's attributes are kept
};

/// Attribute values that Weld::position drops because they differ from the kept vertex's.
struct WeldReport {
    std::uint32_t vertices = 0;           ///< number of vertices that lose some value
    std::vector<std::string> attributes;  ///< names of the attributes that lose some value
};

/// Merges vertices whose values have identical bits (in POSITION, -0 equals 0). The first vertex of each group is kept
/// unchanged, in the order of first appearance. Triangles keep their order; some may become degenerate. Unused vertices
/// are merged, too. `report` may be null. Cost: O(V) expected time, O(V log V) at most; about 4 bytes a vertex and 10
/// to 17 bytes a group beside the result.
Mesh weld(const Mesh& mesh, Weld mode, WeldReport* report = nullptr);

}  // namespace lacedring
