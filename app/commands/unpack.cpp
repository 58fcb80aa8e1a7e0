// lacedring unpack PACKED... -o PLAIN.glb|.gltf

#include <CLI/CLI.hpp>
#include <memory>

#include "app/cli/help.h"
#include "app/cli/print.h"
#include "app/cli/scene_output.h"
#include "app/commands/commands.h"

namespace lacedring::app {
namespace {

struct UnpackCommand {
    std::vector<std::string> inputs;
    InputOptions input;
    OutputOptions output;
};

/// Returns an Exit.
int unpack_file(const UnpackCommand& options, const std::string& input, const std::filesystem::path& path,
                RunLog& log) {
    const auto bytes = read_scene(input, options.input, log);
    if (!bytes) return fail(input, bytes.error());
    const SceneOutput output(path);
    UnpackReport report;
    const auto scene =
        unpack_scene(*bytes, input == "-" ? "" : input, output.bin, read_options(options.input), &report);
    for (std::filesystem::path& file : report.read.files) log.read(file);
    if (!scene) return fail(input, scene.error());
    const auto written = write_scene(*scene, input, output, options.output, log);
    if (!written) return fail(output_name(path), written.error());
    if (!is_packed_scene(*bytes)) log.note(input_name(input), "is no packed scene: it is written as it is");
    log.wrote(output_name(path),
              fmt::format("{}, {}, {} bytes; packed {} bytes", count_text(report.primitives, "primitive"),
                          count_text(report.triangles, "triangle"), *written, input_bytes(bytes->size(), report.read)));
    return done;
}

int run_unpack(const UnpackCommand& options, RunLog& log) {
    const auto outputs = output_paths(options.inputs, options.output, ".glb");
    if (!outputs) return fail(output_name(options.output.path), outputs.error());
    return for_each_input(options.inputs, log,
                          [&](std::size_t i) { return unpack_file(options, options.inputs[i], (*outputs)[i], log); });
}

}  // namespace

void add_unpack(CLI::App& program, Action& action) {
    auto options = std::make_shared<UnpackCommand>();
    CLI::App* command = program.add_subcommand("unpack", "write a packed scene as plain glTF");
    command->add_option("PACKED", options->inputs, ".gltf or .glb files that pack wrote; - is standard input")
        ->required();
    add_output(*command, options->output,
               ".glb or .gltf file to write; FOLDER/ for several inputs; - is standard output");
    add_allow_outside(*command, options->input);
    add_max_memory(*command, options->input);
    add_example(*command, "unpack small.glb -o plain.glb", "command-line.md");
    command->callback([options, &action] { action = [options](RunLog& log) { return run_unpack(*options, log); }; });
}

}  // namespace lacedring::app
