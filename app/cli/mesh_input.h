#pragma once
// A mesh named on the command line.

#include <cstdint>
#include <string>

namespace lacedring::app {

/// Options of every command that reads meshes.
struct InputOptions {
    std::string weld;            ///< "none", "attributes", or else position
    double tolerance = 0;        ///< of positions that are one
    std::string format;          ///< "" as read_mesh tells, or "gltf", "obj", ...
    bool keep_vertices = false;  ///< copies that do not differ stay apart
    bool allow_outside = false;
    bool materials = false;        ///< reads what triangles look like, too
    bool scene_hint = false;       ///< what a scene loses is said with the command that keeps it
    std::uint64_t max_memory = 0;  ///< MiB; 0: by the file's size (ReadOptions)
    /// Bytes that the command takes for each triangle at its peak, the mesh aside (docs/reliability.md).
    std::uint32_t triangle_bytes = 0;
    std::uint32_t threads = 0;  ///< that restore what is in storage form, at most; 0: all of the machine
};

/// One mesh. The path "-" is standard input.
struct MeshInput {
    std::string path;
    InputOptions options;
};

}  // namespace lacedring::app
