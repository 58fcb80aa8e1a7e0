#pragma once
// A mesh named on the command line.

#include <cstdint>
#include <string>

namespace lacedring::app {

/// Options of every command that reads meshes.
struct InputOptions {
    std::string weld;            ///< "none" or "attributes"; else by position
    double tolerance = 0;        ///< joins positions up to this distance
    std::string format;          ///< "gltf", "obj", ...; "": detected
    bool keep_vertices = false;  ///< does not merge equal copies of a vertex
    bool allow_outside = false;
    bool materials = false;  ///< reads materials, too
    bool writes = false;     ///< the command writes what it reads: notes say what is not kept, and recommend `pack`
    std::uint64_t max_memory = 0;  ///< MiB; 0: derived from the file's size (ReadOptions)
    /// Bytes per triangle that the command takes at its peak, without the mesh (docs/reliability.md).
    std::uint32_t triangle_bytes = 0;
    /// Most threads that restore streams from storage form; 0: all of the machine.
    std::uint32_t threads = 0;
};

/// The path "-" is standard input.
struct MeshInput {
    std::string path;
    InputOptions options;
};

}  // namespace lacedring::app
