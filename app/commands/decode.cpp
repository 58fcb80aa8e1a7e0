// lacedring decode IN.lr... -o OUT.glb|.ply|.obj

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "app/cli/help.h"
#include "app/cli/output.h"
#include "app/cli/values.h"
#include "app/commands/commands.h"
#include "lacedring/lr_file.hpp"
#include "lacedring/mesh_files.hpp"

namespace lacedring::app {
namespace {

namespace fs = std::filesystem;

struct DecodeOptions {
    std::vector<std::string> inputs;
    InputOptions input;  ///< only max_memory and threads
    OutputOptions output;
    std::string format;  ///< "": chosen by the extension
    bool original_order = false;
};

/// The format given by --output-format, else by the path's extension.
MeshFormat output_format(const DecodeOptions& options, const fs::path& path) {
    return writable_format(options.format.empty() ? path : fs::path("x." + options.format));
}

Result<void> write(const Mesh& mesh, const DecodeOptions& options, const fs::path& path, WriteNotes& notes,
                   std::uint64_t& bytes) {
    if (path == "-") return write_mesh(mesh, output_format(options, path), STDOUT_FILENO, &notes, &bytes);
    return write_mesh(mesh, path, &notes, &bytes);
}

/// Returns whether the mesh has joints. They index the skin of a scene, which the output does not have.
bool has_skin(const Mesh& mesh) {
    return std::ranges::any_of(mesh.attributes, [](const Attribute& a) { return a.name.starts_with("JOINTS_"); });
}

/// Returns an Exit.
int decode(const DecodeOptions& options, const std::string& input, const fs::path& output, RunLog& log) {
    const auto bytes = read_input(input, options.input, log);
    if (!bytes) return fail(input, bytes.error());
    const Result<LrFile> file = parse_lr(*bytes, options.input.max_memory << 20, thread_count(options.input.threads));
    if (!file) return fail(input, file.error());
    if (const auto good = check_mesh_output(output, options.output, log); !good) {
        return fail(output_name(output), good.error());
    }
    const Result<Mesh> mesh = options.original_order ? decode_lr_original_order(*file) : Result<Mesh>(decode_lr(*file));
    if (!mesh) return fail(input, mesh.error());
    WriteNotes notes;
    std::uint64_t written_bytes = 0;
    if (const Result<void> written = write(*mesh, options, output, notes, written_bytes); !written) {
        return fail(output_name(output), written.error());
    }
    for (const std::string& note : notes) log.note(output_name(output), note);
    if (output_format(options, output) == MeshFormat::gltf && has_skin(*mesh)) {
        log.note(output_name(output), "joints without the skin of their scene (lacedring pack keeps scenes)");
    }
    log.wrote(output_name(output), written_text(*mesh, written_bytes));
    return done;
}

int run_decode(const DecodeOptions& options, RunLog& log) {
    const bool named = options.output.path == "-" || options.output.path.ends_with('/') || options.inputs.size() > 1;
    if (named && options.format.empty()) {
        return fail(output_name(options.output.path),
                    Error{ErrorCode::invalid_argument, "needs --output-format glb, ply or obj"});
    }
    if (!named && !options.format.empty()) {
        return fail(options.output.path,
                    Error{ErrorCode::invalid_argument, "--output-format goes with -o - and -o FOLDER/"});
    }
    const auto outputs = output_paths(options.inputs, options.output, "." + options.format);
    if (!outputs) return fail(output_name(options.output.path), outputs.error());
    return for_each_input(options.inputs, log,
                          [&](std::size_t i) { return decode(options, options.inputs[i], (*outputs)[i], log); });
}

}  // namespace

void add_decode(CLI::App& program, Action& action) {
    auto options = std::make_shared<DecodeOptions>();
    CLI::App* command = program.add_subcommand("decode", "write the mesh of an .lr file as .glb, .ply or .obj");
    command->add_option("IN.lr", options->inputs, ".lr files; - is standard input")->required();
    add_output(*command, options->output, "mesh file to write; FOLDER/ for several inputs; - is standard output");
    allow_words(command->add_option("--output-format", options->format, "write {}; goes with -o - and -o FOLDER/"),
                {"glb", "ply", "obj"});
    command->add_flag("--original-order", options->original_order,
                      "restore the order before encoding (needs encode --keep-order)");
    add_max_memory(*command, options->input);
    add_threads(*command, {&options->input.threads});
    add_example(*command, "decode bunny.lr -o bunny.glb", "command-line.md");
    command->callback([options, &action] { action = [options](RunLog& log) { return run_decode(*options, log); }; });
}

}  // namespace lacedring::app
