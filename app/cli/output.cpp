#include "app/cli/output.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <set>

#include "lacedring/file.hpp"
#include "lacedring/mesh_files.hpp"

namespace lacedring::app {
namespace {

namespace fs = std::filesystem;

std::string lower_extension(const fs::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

/// Returns whether the extension belongs to a known kind of file.
bool is_known(std::string_view extension) {
    constexpr std::string_view kKnown[] = {".lr",  ".glb", ".gltf", ".bin", ".obj",  ".mtl", ".ply",  ".off", ".stl",
                                           ".png", ".jpg", ".jpeg", ".bmp", ".tga",  ".gif", ".webp", ".svg", ".pdf",
                                           ".htm", ".css", ".html", ".txt", ".json", ".csv", ".md",   ".xml", ".zip"};
    return std::find(std::begin(kKnown), std::end(kKnown), extension) != std::end(kKnown);
}

Error refused(std::string why) {
    return {ErrorCode::invalid_argument, std::move(why) + " (--force writes it)"};
}

/// Unless --force is given, refuses an output that is one of the files read.
Result<void> check_inputs(const fs::path& path, const OutputOptions& options, const RunLog& log) {
    if (options.force || path == "-" || path.empty()) return {};
    for (const fs::path& input : log.files()) {
        std::error_code missing;
        if (fs::equivalent(path, input, missing)) return refused("is an input");
    }
    return {};
}

}  // namespace

void add_output(CLI::App& command, OutputOptions& options, const std::string& what) {
    command.add_option("-o,--output", options.path, what)->type_name("FILE")->required();
    add_force(command, options);
}

void add_force(CLI::App& command, OutputOptions& options) {
    command.add_flag("--force", options.force, "write over an input, or under the extension of another format");
}

std::string output_name(const fs::path& path) {
    return path == "-" ? "standard output" : path.string();
}

Result<void> check_output(const fs::path& path, const OutputOptions& options, const RunLog& log,
                          std::span<const std::string_view> extensions) {
    if (options.force || path == "-" || path.empty()) return {};
    const std::string extension = lower_extension(path);
    if (is_known(extension) && std::find(extensions.begin(), extensions.end(), extension) == extensions.end()) {
        return refused(fmt::format("what is written is no {} file, but {}", extension, fmt::join(extensions, " or ")));
    }
    return check_inputs(path, options, log);
}

Result<void> check_mesh_output(const fs::path& path, const OutputOptions& options, const RunLog& log) {
    if (path != "-" && writable_format(path) == MeshFormat::any) {
        return Error{ErrorCode::invalid_argument, "meshes are written as .glb, .ply or .obj"};
    }
    return check_inputs(path, options, log);
}

Result<void> write_output(const fs::path& path, std::span<const std::span<const std::byte>> parts) {
    return path == "-" ? write_descriptor(STDOUT_FILENO, parts) : write_file(path, parts);
}

std::string written_text(const Mesh& mesh, std::uint64_t bytes) {
    return fmt::format("{}, {} vertices, {} bytes", count_text(mesh.triangle_count(), "triangle"), mesh.vertex_count,
                       bytes);
}

Result<std::vector<fs::path>> output_paths(const std::vector<std::string>& inputs, const OutputOptions& options,
                                           std::string_view extension) {
    std::error_code error;
    const bool named_folder = options.path.ends_with('/');
    if (inputs.size() == 1 && !named_folder) return std::vector<fs::path>{options.path};
    if (!named_folder && !fs::is_directory(options.path, error)) {
        return Error{ErrorCode::invalid_argument, "several inputs need a folder for their outputs: -o FOLDER/"};
    }
    fs::create_directory(options.path.substr(0, options.path.find_last_not_of('/') + 1), error);
    if (error) return Error{ErrorCode::cannot_write, error.message()};
    std::vector<fs::path> out;
    std::set<fs::path> taken;
    for (const std::string& input : inputs) {
        const std::string stem = input == "-" ? "stdin" : fs::path(input).stem().string();
        fs::path path = fs::path(options.path) / (stem + std::string(extension));
        if (!taken.insert(path).second) {
            return Error{ErrorCode::invalid_argument, "two inputs would be written as " + path.filename().string()};
        }
        out.push_back(std::move(path));
    }
    return out;
}

}  // namespace lacedring::app
