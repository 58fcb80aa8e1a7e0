// lacedring decode IN.lr -o OUT.glb|.ply|.obj

#include <memory>

#include "app/commands.h"
#include "lrcore/file/lr_file.h"
#include "lrcore/mesh/write.h"

namespace lr::app {
namespace {

struct Options {
    std::string input, output;
    bool original_order = false;
};

int run(const Options& options) {
    const Result<LrFile> file = read_lr(options.input);
    if (!file) return fail(options.input, file.error());
    const Result<Mesh> mesh = options.original_order ? decode_lr_original_order(*file) : Result<Mesh>(decode_lr(*file));
    if (!mesh) return fail(options.input, mesh.error());
    if (const Result<void> written = write_mesh(*mesh, options.output); !written) {
        return fail(options.output, written.error());
    }
    return done;
}

}  // namespace

void add_decode(CLI::App& program, Action& action) {
    auto options = std::make_shared<Options>();
    CLI::App* command = program.add_subcommand("decode", "write an .lr file as .glb, .ply or .obj");
    command->add_option("IN.lr", options->input, "the .lr file")->required();
    command->add_option("-o,--output", options->output, "the mesh file")->required();
    command->add_flag("--original-order", options->original_order,
                      "vertices and triangles in the order of the file that was encoded (with --keep-order)");
    command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace lr::app
