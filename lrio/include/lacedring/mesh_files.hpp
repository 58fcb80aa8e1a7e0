#pragma once
// Mesh files in and out.

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
    any,  ///< told by content where the format has a signature, else by the extension
    gltf,
    obj,
    off,
    ply,
    stl,
};

struct ReadOptions {
    MeshFormat format = MeshFormat::any;
    bool allow_outside = false;  ///< a glTF may name buffers outside its own folder
    /// Bytes that the mesh, and what the caller makes of it, may take. 0: 512 MiB, or 128 times the bytes that were
    /// read where that is more. A small file can place its meshes very often.
    std::uint64_t max_bytes = 0;
    std::uint32_t triangle_bytes = 0;  ///< that the caller will take for each triangle beside the mesh
    std::uint64_t held_bytes = 0;      ///< of max_bytes, that the caller has taken already
};

struct ReadReport {
    /// Contents of the file that the mesh lacks, each with its count: "3 materials".
    std::vector<std::string> left_out;
    MeshFormat format = MeshFormat::any;       ///< the file's
    std::size_t primitives = 1;                ///< of triangles, that the mesh was joined of
    std::vector<std::filesystem::path> files;  ///< opened beside the file
    std::vector<std::uint64_t> streams;        ///< bytes of each stream of a packed scene, its part codes included
};

/// Reads glTF/GLB (packed scenes, too: scene.hpp), OBJ, PLY, OFF/COFF or STL. Several meshes or primitives become one
/// list of all triangles, node transforms applied, attributes kept where every primitive has them; NORMAL where any has
/// it, made from the triangles of the others (read_primitives, primitives.hpp, gives each primitive with all it has).
/// Polygons are cut into triangles that cover them (docs/formats-read.md). STL vertices at one position are merged.
/// `report`, if given, is filled even on an error. Errors: cannot_open, malformed, unsupported, too_large,
/// memory_limit. Untrusted input: safe. Cost: O(what is read).
/// `materials`, if given, gets what a glTF's triangles look like. The mesh then has TEXCOORD_0, TEXCOORD_1 and COLOR_0,
/// as floats, wherever some primitive has them: 0, or 1 of colors, where others lack them. Images that cannot be read
/// are told of in the report.
Result<Mesh> read_mesh(const std::filesystem::path& path, const ReadOptions& options = {}, ReadReport* report = nullptr,
                       Materials* materials = nullptr);

/// The same of a file that is in memory. `name` gives the extension, and the folder in which a glTF's buffers are
/// looked for; without a name there is neither.
Result<Mesh> read_mesh(std::span<const std::byte> bytes, const std::filesystem::path& name,
                       const ReadOptions& options = {}, ReadReport* report = nullptr, Materials* materials = nullptr);

/// Differences of a written file from the mesh, a line each: "NORMAL: 3 of no length were made from the triangles".
using WriteNotes = std::vector<std::string>;

/// Writes GLB, binary PLY or OBJ by the extension of `path` (.glb, .ply, .obj). PLY keeps every attribute bit for bit;
/// GLB keeps what glTF can hold, and OBJ positions, normals, texture coordinates and colors (docs/formats-read.md).
/// `notes`, if given, tells of everything else; `bytes`, if given, gets the file's size. The file is whole or untouched
/// (write_file). Errors: cannot_write, invalid_argument (extension, or a mesh that breaks its invariants), unsupported
/// (no triangles), too_large (GLB above 4 GiB). Cost: O(file).
Result<void> write_mesh(const Mesh& mesh, const std::filesystem::path& path, WriteNotes* notes = nullptr,
                        std::uint64_t* bytes = nullptr);

/// The same to an open descriptor: GLB (MeshFormat::gltf), PLY or OBJ.
Result<void> write_mesh(const Mesh& mesh, MeshFormat format, int descriptor, WriteNotes* notes = nullptr,
                        std::uint64_t* bytes = nullptr);

/// The bytes of such a file.
Result<std::vector<std::byte>> mesh_file_bytes(const Mesh& mesh, MeshFormat format, WriteNotes* notes = nullptr);

/// The format that write_mesh takes for a path; any: none.
MeshFormat writable_format(const std::filesystem::path& path);

enum class Weld {
    none,
    attributes,  ///< vertices that are the same in all attributes become one
    position,    ///< vertices at the same POSITION become one; the first one's attributes are kept
};

/// Attribute values that Weld::position drops: those that differ from the kept vertex's.
struct WeldReport {
    std::uint32_t vertices = 0;           ///< that lose some attribute's value
    std::vector<std::string> attributes;  ///< of which values are lost
};

/// Merges vertices whose values have identical bits; of POSITION, -0 is 0. The first of each group is kept as it is, in
/// the order of first appearance. Triangles keep their order; some may become degenerate. Unused vertices take part.
/// Cost: O(V) expected time, O(V log V) at most; about 4 bytes a vertex and 10 to 17 a group beside the result.
/// `report` may be null.
Mesh weld(const Mesh& mesh, Weld mode, WeldReport* report = nullptr);

}  // namespace lacedring
