#pragma once
// Reads and writes scenes: a .glb, or a .gltf with its buffers in files beside it.

#include <filesystem>
#include <string>

#include "app/cli/input.h"
#include "app/cli/output.h"
#include "lacedring/scene.hpp"

namespace lacedring::app {

/// The files of a scene.
struct SceneOutput {
    std::filesystem::path path;
    std::string bin, fallback;  ///< URIs of a .gltf's buffers; "" for a .glb

    explicit SceneOutput(const std::filesystem::path& path);
};

/// Reads a glTF or GLB file, or standard input. Errors: those of read_file; unsupported (the bytes are neither).
Result<std::vector<std::byte>> read_scene(const std::string& path, const InputOptions& options, RunLog& log);

/// Applies check_output to all files of the scene, then writes the buffers and the document. Adds a note if the scene
/// refers to image files, which are not copied, and `input` is in another folder. Returns the size of all files in
/// bytes. Errors: invalid_argument, cannot_write, too_large.
Result<std::uint64_t> write_scene(const SceneFile& scene, const std::string& input, const SceneOutput& output,
                                  const OutputOptions& options, RunLog& log);

/// Size in bytes of an input (`file` bytes) and of the other files it refers to.
std::uint64_t input_bytes(std::uint64_t file, const ReadReport& read);

}  // namespace lacedring::app
