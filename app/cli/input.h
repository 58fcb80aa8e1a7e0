#pragma once
// Meshes that commands read: files, .lr files, standard input.

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

/// Adds --weld, --no-weld, --weld-tolerance, --input-format, --allow-outside and --max-memory. `triangle_bytes`:
/// InputOptions.
void add_input_options(CLI::App& command, InputOptions& options, std::uint32_t triangle_bytes);

/// --allow-outside, or --max-memory, alone.
void add_allow_outside(CLI::App& command, InputOptions& options);
void add_max_memory(CLI::App& command, InputOptions& options);

/// The library's options for them.
ReadOptions read_options(const InputOptions& options);

/// As messages and JSON name it.
std::string input_name(const std::string& path);

/// The whole file, or standard input. Errors: those of read_file.
Result<std::vector<std::byte>> read_input(const std::string& path, const InputOptions& options, RunLog& log);

/// A mesh, its surface (with --no-weld and --weld=attributes each vertex is its own), and of an .lr file what it
/// consists of.
struct LoadedMesh {
    Mesh mesh;
    Surface surface;
    std::optional<LrContents> lr;
    std::vector<std::uint64_t> streams = {};  ///< ReadReport's
    Materials materials = {};                 ///< InputOptions::materials

    bool has_materials() const { return !materials.of_triangle.empty() && materials.materials.size() > 1; }
};

/// The corner table of the surface. Errors: build_corner_table's.
Result<CornerTable> surface_table(const LoadedMesh& loaded);

/// Reads and welds. An .lr file is validated and decoded. `log` is told what is not kept.
Result<LoadedMesh> load_file(const MeshInput& input, RunLog& log);

/// A primitive of a scene, welded by itself.
struct LoadedPrimitive {
    std::size_t mesh = 0, number = 0;  ///< Primitive's
    std::string name;                  ///< of the mesh, shortened
    PrimitiveMode mode = PrimitiveMode::triangles;
    std::size_t placed = 0;  ///< how often the scene places it
    Mesh geometry;
    Surface surface;

    /// "mesh 2, primitive 0 (wheel)"
    std::string label() const;
};

struct LoadedScene {
    LoadedMesh joined;
    std::vector<LoadedPrimitive> primitives;  ///< empty where the joined mesh is of one only
    std::vector<PlacedMesh> placed;           ///< likewise
};

/// load_file, and the primitives of a glTF that has several. Errors: also read_primitives'.
Result<LoadedScene> load_scene(const MeshInput& input, RunLog& log);

}  // namespace lacedring::app
