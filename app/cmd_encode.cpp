// lacedring encode MESH -o OUT.lr

#include <fmt/format.h>

#include <memory>

#include "app/commands.h"
#include "lrcore/file/lr_file.h"

namespace lr::app {
namespace {

struct Options {
    MeshInput input;
    std::string output;
    std::string format = "lean";
    RingChoice ring;
    bool no_warts = false;
    bool keep_order = false;
};

int run(const Options& options) {
    const Result<Mesh> mesh = load(options.input);
    if (!mesh) return fail(options.input.path, mesh.error());
    LrFile file;
    std::uint32_t degenerate = 0;
    {
        const Result<CornerTable> table = build_corner_table(mesh->indices, mesh->vertex_count);
        if (!table) return fail(options.input.path, table.error());
        const Rings rings = expand_rings(*table, ring_options(options.ring, mesh->triangle_count()));
        file = make_lr_file(*mesh, encode_lean(*table, rings, {.wart_skipping = !options.no_warts}), options.keep_order);
        degenerate = table->topology.degenerate;
    }
    if (const Result<void> written = write_lr(file, options.output); !written) {
        return fail(options.output, written.error());
    }
    if (degenerate > 0) fmt::print(stderr, "{}: {} degenerate triangles dropped\n", options.input.path, degenerate);
    const Result<LeanView> view = view_lean(file.lean);
    const auto triangles = static_cast<double>(mesh->triangle_count());
    fmt::print(stderr, "{}: {} triangles, connectivity {} bytes, {:.3f} references and {:.2f} bits per triangle\n",
               options.output, view->triangles, view->bytes(), static_cast<double>(view->references()) / triangles,
               8 * static_cast<double>(view->bytes()) / triangles);
    return done;
}

}  // namespace

void add_encode(CLI::App& program, Action& action) {
    auto options = std::make_shared<Options>();
    CLI::App* command = program.add_subcommand("encode", "write a mesh as an .lr file");
    command->add_option("MESH", options->input.path, "mesh file")->required();
    command->add_option("-o,--output", options->output, "the .lr file")->required();
    command->add_option("--format", options->format, "stream format")
        ->check(CLI::IsMember({"lean"}))
        ->capture_default_str();
    add_weld(*command, options->input.weld);
    add_ring_options(*command, options->ring);
    command->add_flag("--no-warts", options->no_warts, "no wart skipping");
    command->add_flag("--keep-order", options->keep_order,
                      "store the vertex and triangle permutations, for decode --original-order");
    command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace lr::app
