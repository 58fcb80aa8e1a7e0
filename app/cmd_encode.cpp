// lacedring encode MESH -o OUT.lr

#include <fmt/format.h>

#include <memory>

#include "app/commands.h"
#include "lrcore/file/lr_file.h"
#include "lrcore/lean/lean_stream.h"
#include "lrcore/lr/lr_encode.h"
#include "lrcore/packed/packed_stream.h"

namespace lr::app {
namespace {

struct Options {
    MeshInput input;
    std::string output;
    std::string format = "lean";
    std::string profile = "small";
    RingChoice ring;
    bool no_warts = false;
    bool keep_order = false;
};

Result<LrFile> encode(const Options& options, const Mesh& mesh, CornerTable table) {
    const RingOptions ring = ring_options(options.ring, mesh.triangle_count());
    if (options.format == "lean") {
        const Rings rings =
            optimize_rings(table, expand_rings(table, ring), optimize_options(options.ring, lean_ring_cost));
        Result<LeanStream> lean = encode_lean(table, rings, {.wart_skipping = !options.no_warts});
        if (!lean) return lean.error();
        return make_lr_file(mesh, Connectivity::lean, std::move(lean->words), std::move(lean->vertex_order),
                            std::move(lean->slot_triangle), options.keep_order);
    }
    if (options.format == "packed") {
        Result<PackedChoice> choice =
            encode_smallest_packed(table, ring, optimize_options(options.ring, packed_ring_cost),
                                   options.profile == "cache" ? PackedProfile::cache : PackedProfile::small);
        if (!choice) return choice.error();
        PackedStream& packed = choice->stream;
        return make_lr_file(mesh, Connectivity::packed, std::move(packed.words), std::move(packed.vertex_order),
                            std::move(packed.triangle_order), options.keep_order);
    }
    const bool compact = options.format == "lr-compact";
    Result<EncodedLr> lr =
        compact ? encode_compact_lr(std::move(table), compact_ring_options(options.ring),
                                    ring_periods(options.ring, mesh.triangle_count()))
                : encode_lr(std::move(table), ring, optimize_options(options.ring, lr_ring_cost), !options.no_warts);
    if (!lr) return lr.error();
    return make_lr_file(mesh, compact ? Connectivity::lr_compact : Connectivity::lr, std::move(lr->words),
                        std::move(lr->vertex_order), std::move(lr->triangle_order), options.keep_order);
}

int run(const Options& options) {
    const Result<Mesh> mesh = load(options.input);
    if (!mesh) return fail(options.input.path, mesh.error());
    Result<CornerTable> table = build_corner_table(mesh->indices, mesh->vertex_count);
    if (!table) return fail(options.input.path, table.error());
    const std::uint32_t degenerate = table->topology.degenerate;
    const Result<LrFile> encoded = encode(options, *mesh, std::move(*table));
    if (!encoded) return fail(options.input.path, encoded.error());
    const LrFile& file = *encoded;
    if (const Result<void> written = write_lr(file, options.output); !written) {
        return fail(options.output, written.error());
    }
    if (degenerate > 0) fmt::print(stderr, "{}: {} degenerate triangles dropped\n", options.input.path, degenerate);
    const auto triangles = static_cast<double>(mesh->triangle_count());
    const auto bytes = static_cast<double>(file.words.size()) * 4;
    fmt::print(stderr, "{}: {} triangles, connectivity {:.0f} bytes, {:.2f} bits per triangle\n", options.output,
               mesh->triangle_count() - degenerate, bytes, 8 * bytes / triangles);
    return done;
}

}  // namespace

void add_encode(CLI::App& program, Action& action) {
    auto options = std::make_shared<Options>();
    CLI::App* command = program.add_subcommand("encode", "write a mesh as an .lr file");
    command->add_option("MESH", options->input.path, "mesh file")->required();
    command->add_option("-o,--output", options->output, "the .lr file")->required();
    command->add_option("--format", options->format, "stream format")
        ->check(CLI::IsMember({"lean", "packed", "lr", "lr-compact"}))
        ->capture_default_str();
    command->add_option("--profile", options->profile, "of packed: the fewest bits, or an order for the vertex cache")
        ->check(CLI::IsMember({"small", "cache"}))
        ->capture_default_str();
    add_weld(*command, options->input.weld);
    add_ring_options(*command, options->ring);
    command->add_flag("--no-warts", options->no_warts, "no wart skipping (lean and lr)");
    command->add_flag("--keep-order", options->keep_order,
                      "store the vertex and triangle permutations, for decode --original-order");
    command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace lr::app
