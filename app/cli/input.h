#pragma once
// Reads the input of commands: mesh files, .lr files, standard input.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/mesh_input.h"
#include "app/cli/run_log.h"
#include "lacedring/base.hpp"
#include "lacedring/lr_file.hpp"
#include "lacedring/mesh.hpp"
#include "lacedring/primitives.hpp"
#include "lacedring/surface.hpp"

namespace CLI {
class App;
}  // namespace CLI

namespace lacedring::app {

/// Adds --weld, --no-weld, --weld-tolerance, --input-format, --allow-outside and --max-memory, and sets
/// InputOptions::triangle_bytes.
void add_input_options(CLI::App& command, InputOptions& options, std::uint32_t triangle_bytes);

/// Adds only --allow-outside, or only --max-memory.
void add_allow_outside(CLI::App& command, InputOptions& options);
void add_max_memory(CLI::App& command, InputOptions& options);

/// The library's form of these options.
ReadOptions read_options(const InputOptions& options);

/// Name of an input in messages and JSON: the path, or "standard input".
std::string input_name(const std::string& path);

/// Reads the whole file, or standard input. Errors: those of read_file.
Result<std::vector<std::byte>> read_input(const std::string& path, const InputOptions& options, RunLog& log);

/// A mesh and its surface.
struct LoadedMesh {
    Mesh mesh;
    /// The surface has no seams after --no-weld and --weld=attributes.
    Surface surface;
    std::optional<LrContents> lr;             ///< contents of an .lr file
    std::vector<std::uint64_t> streams = {};  ///< ReadReport::streams
    Materials materials = {};                 ///< if InputOptions::materials

    bool has_materials() const { return !materials.of_triangle.empty() && materials.materials.size() > 1; }
};

/// Builds the corner table of the surface. Errors: those of build_corner_table.
Result<CornerTable> surface_table(const LoadedMesh& loaded);

/// Reads and welds a mesh; validates and decodes an .lr file. Notes in `log` which data of the file are not kept.
Result<LoadedMesh> load_file(const MeshInput& input, RunLog& log);

/// A primitive of a scene, welded on its own.
struct LoadedPrimitive {
    std::size_t mesh = 0, number = 0;  ///< as in Primitive
    std::string name;                  ///< of the mesh, shortened
    PrimitiveMode mode = PrimitiveMode::triangles;
    std::size_t placed = 0;  ///< number of nodes that place it
    Mesh geometry;
    Surface surface;

    /// "mesh 2, primitive 0 (wheel)"
    std::string label() const;
};

struct LoadedScene {
    LoadedMesh joined;
    // Both empty unless the file has several primitives.
    std::vector<LoadedPrimitive> primitives;
    std::vector<PlacedMesh> placed;
};

/// Like load_file, and also loads the primitives of a glTF that has several. Errors: also those of read_primitives.
Result<LoadedScene> load_scene(const MeshInput& input, RunLog& log);

}  // namespace lacedring::app
