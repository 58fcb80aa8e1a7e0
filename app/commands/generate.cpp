// lacedring generate KIND -o OUT --triangles N [--seed S]

#include "lrlab/generate/generate.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/cli/help.h"
#include "app/cli/output.h"
#include "app/cli/values.h"
#include "app/commands/commands.h"
#include "lacedring/mesh_files.hpp"

namespace lacedring::app {
namespace {

struct GenerateOptions {
    std::string kind, format;
    OutputOptions output;
    std::uint64_t triangles = 10000, seed = 1;
};

constexpr std::uint64_t kMostTriangles = std::uint64_t{1} << 30;  // of 2^29 vertices, each with six triangles around it

int run_generate(const GenerateOptions& options, RunLog& log) {
    const std::string& output = options.output.path;
    const bool standard = output == "-";
    if (standard == options.format.empty()) {
        return fail(output_name(output),
                    Error{ErrorCode::invalid_argument,
                          standard ? "needs --output-format glb, ply or obj" : "--output-format goes with -o -"});
    }
    if (const auto good = check_mesh_output(output, options.output, log); !good)
        return fail(output_name(output), good.error());
    const Result<Mesh> mesh = generate(options.kind, options.triangles, options.seed);
    if (!mesh) return fail(fmt::format("--triangles {}", options.triangles), mesh.error());
    std::uint64_t bytes = 0;
    const Result<void> written =
        standard ? write_mesh(*mesh, writable_format("x." + options.format), STDOUT_FILENO, nullptr, &bytes)
                 : write_mesh(*mesh, output, nullptr, &bytes);
    if (!written) return fail(output_name(output), written.error());
    log.wrote(output_name(output), written_text(*mesh, bytes));
    return done;
}

}  // namespace

void add_generate(CLI::App& program, Action& action) {
    auto options = std::make_shared<GenerateOptions>();
    CLI::App* command = program.add_subcommand("generate", "make a procedural mesh of any size");
    std::string described;
    std::vector<std::string> kinds;
    for (const GeneratorInfo& kind : generators()) {
        described += fmt::format("\n{:<9}{}", kind.name, kind.description);
        kinds.emplace_back(kind.name);
    }
    allow_words(command->add_option("KIND", options->kind, "kind of mesh:" + described), kinds)->required();
    add_output(*command, options->output, ".glb, .ply or .obj file to write; - is standard output");
    allow_words(command->add_option("--output-format", options->format, "write {}; goes with -o -"),
                {"glb", "ply", "obj"});
    allow_whole_numbers(command->add_option("--triangles", options->triangles, "make about so many triangles"), 1,
                        kMostTriangles)
        ->capture_default_str();
    allow_whole_numbers(command->add_option("--seed", options->seed, "random seed of the shape"), 0, UINT64_MAX)
        ->capture_default_str();
    add_example(*command, "generate blob -o blob.ply --triangles 1e6", "command-line.md");
    command->callback([options, &action] { action = [options](RunLog& log) { return run_generate(*options, log); }; });
}

}  // namespace lacedring::app
