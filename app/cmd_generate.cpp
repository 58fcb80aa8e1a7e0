// lacedring generate KIND -o OUT --triangles N [--seed S]

#include <fmt/format.h>

#include <memory>

#include "app/commands.h"
#include "lrcore/generate/generate.h"
#include "lrcore/mesh/write.h"

namespace lr::app {
namespace {

struct Options {
    std::string kind, output;
    std::uint64_t triangles = 10000, seed = 1;
};

int run(const Options& options) {
    const Result<Mesh> mesh = generate(options.kind, options.triangles, options.seed);
    if (!mesh) return fail("generate", mesh.error());
    if (const Result<void> written = write_mesh(*mesh, options.output); !written) {
        return fail(options.output, written.error());
    }
    fmt::print(stderr, "{}: {} triangles, {} vertices\n", options.output, mesh->triangle_count(), mesh->vertex_count);
    return done;
}

}  // namespace

void add_generate(CLI::App& program, Action& action) {
    auto options = std::make_shared<Options>();
    CLI::App* command = program.add_subcommand("generate", "procedural meshes of any size");
    std::string kinds;
    for (const GeneratorInfo& kind : generators()) kinds += fmt::format("\n  {:<9}{}", kind.name, kind.description);
    command->footer("Kinds:" + kinds);
    command->add_option("KIND", options->kind, "see below")->required();
    command->add_option("-o,--output", options->output, ".glb, .ply or .obj")->required();
    command->add_option("--triangles", options->triangles, "about how many")->capture_default_str();
    command->add_option("--seed", options->seed, "same seed, same file")->capture_default_str();
    command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace lr::app
