#pragma once
// Writes the output files of commands. Refuses probable mistakes before anything is written.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/cli/run_log.h"
#include "lacedring/base.hpp"
#include "lacedring/mesh.hpp"

namespace CLI {
class App;
}  // namespace CLI

namespace lacedring::app {

struct OutputOptions {
    std::string path;  ///< "-": standard output
    bool force = false;
};

/// Adds -o and --force, or --force alone.
void add_output(CLI::App& command, OutputOptions& options, const std::string& what);
void add_force(CLI::App& command, OutputOptions& options);

/// Name of an output in messages: the path, or "standard output".
std::string output_name(const std::filesystem::path& path);

/// Unless --force is given, refuses an output that is one of the files read (also through links), or has the extension
/// of a kind of file that is not in `extensions` (".lr"). Errors: invalid_argument.
Result<void> check_output(const std::filesystem::path& path, const OutputOptions& options, const RunLog& log,
                          std::span<const std::string_view> extensions);

/// The same for a mesh file. Refuses an extension that write_mesh cannot write even with --force.
Result<void> check_mesh_output(const std::filesystem::path& path, const OutputOptions& options, const RunLog& log);

/// Writes `parts` one after the other to the path, or to standard output for "-". Errors: cannot_write.
Result<void> write_output(const std::filesystem::path& path, std::span<const std::span<const std::byte>> parts);

/// "12 triangles, 8 vertices, 345 bytes"
std::string written_text(const Mesh& mesh, std::uint64_t bytes);

/// Output paths, one per input: options.path for a single input, else FOLDER/STEM + `extension`; creates FOLDER.
/// Errors: invalid_argument (several inputs and no folder, or two equal outputs), cannot_write (FOLDER).
Result<std::vector<std::filesystem::path>> output_paths(const std::vector<std::string>& inputs,
                                                        const OutputOptions& options, std::string_view extension);

}  // namespace lacedring::app
