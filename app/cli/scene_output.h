#pragma once
// Writes scenes: a .glb, or a .gltf with its buffers in files beside it.

#include <filesystem>
#include <string>

#include "app/cli/output.h"
#include "lacedring/scene.hpp"

namespace lacedring::app {

/// The files of a scene.
struct SceneOutput {
    std::filesystem::path path;
    std::string bin, fallback;  ///< URIs of a .gltf's buffers; "" for a .glb

    explicit SceneOutput(const std::filesystem::path& path);
};

/// Applies check_output to all files that would be written. Errors: invalid_argument.
Result<void> check_scene_output(const SceneOutput& output, const OutputOptions& options, const RunLog& log);

/// Writes the buffers, then the document. Returns the size of all files in bytes. Errors: cannot_write, too_large.
Result<std::uint64_t> write_scene(const SceneFile& scene, const SceneOutput& output);

/// Adds a note if the scene refers to image files, which are not copied, and the output is in another folder.
void note_images(const SceneFile& scene, const std::string& input, const SceneOutput& output, RunLog& log);

/// Size in bytes of an input (`file` bytes) and of the other files it refers to.
std::uint64_t input_bytes(std::uint64_t file, const ReadReport& read);

}  // namespace lacedring::app
