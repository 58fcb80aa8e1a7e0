#pragma once
// Scenes that commands write: a GLB, or a .gltf and its buffers beside it.

#include <filesystem>
#include <string>

#include "app/cli/output.h"
#include "lacedring/scene.hpp"

namespace lacedring::app {

/// The files of a scene at `path`: of a .gltf the names of its buffers, which are "" of a GLB.
struct SceneOutput {
    std::filesystem::path path;
    std::string bin, fallback;

    explicit SceneOutput(const std::filesystem::path& path);
};

/// Refuses what check_output does, of all files that would be written. Errors: invalid_argument.
Result<void> check_scene_output(const SceneOutput& output, const OutputOptions& options, const RunLog& log);

/// Writes the buffers, then the document. Returns the bytes of all files. Errors: cannot_write, too_large.
Result<std::uint64_t> write_scene(const SceneFile& scene, const SceneOutput& output);

/// "FILE: images of its folder stay there" where images are files and the output lies elsewhere.
void note_images(const SceneFile& scene, const std::string& input, const SceneOutput& output, RunLog& log);

/// Bytes of an input and of the files that were read beside it.
std::uint64_t input_bytes(std::uint64_t file, const ReadReport& read);

}  // namespace lacedring::app
