// lacedring encode MESH -o OUT.lr

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <utility>

#include "app/cli/help.h"
#include "app/cli/option_rules.h"
#include "app/cli/output.h"
#include "app/cli/print.h"
#include "app/cli/values.h"
#include "app/commands/commands.h"
#include "app/formats/whole_file.h"
#include "lacedring/lacedring.hpp"
#include "lacedring/lr_file.hpp"

namespace lacedring::app {
namespace {

constexpr Format kStreamFormats[] = {Format::lean, Format::packed, Format::lr, Format::lr_compact};

struct EncodeCommand {
    std::vector<std::string> inputs;
    InputOptions input;
    OutputOptions output;
    std::string format = name_of(Format::packed);
    std::string profile = "small";
    RingChoice ring;
    bool no_warts = false;
    bool keep_order = false;
    bool orient = false;
    bool storage = false, resident = false;  ///< whether the options are given
    AttributeBits bits;

    bool is(Format one) const { return format == name_of(one); }
    /// Packed streams are stored in storage form unless --resident is given. The other formats are only resident: they
    /// are for programs that map their files.
    LrForm form() const { return is(Format::packed) && !resident ? LrForm::stored : LrForm::resident; }
};

/// "POSITION 4.8e-06, ...": the largest error of each lossy attribute; "" if all are lossless.
std::string errors_of(const std::vector<CompressedAttribute>& attributes) {
    std::string out;
    for (const CompressedAttribute& attribute : attributes) {
        if (attribute.largest_error == 0) continue;
        out += fmt::format("{}{} {:.3g}", out.empty() ? "" : ", ", printable(attribute.name), attribute.largest_error);
    }
    return out;
}

/// Bytes of connectivity in a file.
struct Connectivity {
    std::size_t bytes = 0, seams = 0;  ///< `bytes` includes `seams`
};

Connectivity connectivity_of(std::span<const std::byte> file) {
    Connectivity out;
    const Result<LrContents> contents = list_lr(file);
    if (!contents) return out;
    for (const LrSection& section : contents->sections) {
        const std::string_view other[] = {"attribute", "vertices", "vertex_order", "corner_order"};
        if (std::ranges::find(other, section.kind) == std::end(other)) out.bytes += section.bytes;
        if (section.kind == "seams") out.seams += section.bytes;
    }
    return out;
}

/// Reverses the triangles that the table holds reversed, so that neighbors agree. Returns their number.
std::uint32_t orient(Mesh& mesh, CornerTable& table) {
    for (const TriangleId t : table.triangles()) {
        if (!table.flipped(t)) continue;
        std::swap(mesh.indices[3 * std::size_t{t.value} + 1], mesh.indices[3 * std::size_t{t.value} + 2]);
    }
    table.flip.clear();
    return std::exchange(table.topology.flipped, 0);
}

/// Returns an Exit.
int encode_file(const EncodeCommand& options, const std::string& input, const std::filesystem::path& output,
                RunLog& log) {
    Result<LoadedMesh> loaded = load_file({input, options.input}, log);
    if (!loaded) return fail(input, loaded.error());
    Mesh& mesh = loaded->mesh;
    constexpr std::string_view kExtensions[] = {".lr"};
    if (const auto good = check_output(output, options.output, log, kExtensions); !good) {
        return fail(output_name(output), good.error());
    }
    Result<CornerTable> table = surface_table(*loaded);
    if (!table) return fail(input, table.error());
    const std::uint32_t degenerate = table->topology.degenerate;
    const std::size_t triangles = mesh.triangle_count() - degenerate;
    const std::uint32_t turned = options.orient ? orient(mesh, *table) : 0;
    EncodeOptions how = encode_options(
        options.ring, *std::ranges::find_if(kStreamFormats, [&](Format format) { return options.is(format); }),
        mesh.triangle_count());
    how.profile = options.profile == "cache" ? PackedProfile::cache : PackedProfile::small;
    how.wart_skipping = !options.no_warts;
    const Result<WholeFile> whole =
        make_file(mesh, loaded->surface, std::move(*table), how, options.bits, options.keep_order);
    if (!whole) return fail(input, whole.error());
    const bool stores = options.form() == LrForm::stored;
    const std::vector<std::byte> stored = stores ? serialize_lr(whole->file, LrForm::stored) : std::vector<std::byte>();
    const std::vector<std::byte>& bytes = stores ? stored : whole->bytes;
    const std::span<const std::byte> parts[] = {bytes};
    if (const Result<void> written = write_output(output, parts); !written) {
        return fail(output_name(output), written.error());
    }
    if (degenerate > 0) log.note(input_name(input), count_text(degenerate, "degenerate triangle") + " dropped");
    if (turned > 0) log.note(input_name(input), fmt::format("{} triangles reversed by --orient", turned));
    note_lossless(log, input, whole->attributes);
    const LrFile& file = whole->file;
    const Connectivity connectivity = connectivity_of(bytes);
    const auto bits = [](std::size_t size, std::size_t of) {
        return 8 * static_cast<double>(size) / static_cast<double>(of);
    };
    const std::string errors = errors_of(whole->attributes);
    log.wrote(output_name(output),
              fmt::format("{}, {}, {} bytes: {:.2f} bits per triangle, {:.2f} per vertex; connectivity {} bytes, "
                          "{:.2f} bits per triangle{}; {}{}",
                          count_text(triangles, "triangle"), vertices_text(file.vertex_count, mesh.vertex_count),
                          bytes.size(), bits(bytes.size(), triangles), bits(bytes.size(), file.vertex_count),
                          connectivity.bytes, bits(connectivity.bytes, triangles),
                          connectivity.seams == 0
                              ? ""
                              : fmt::format(", {:.2f} of them for seams", bits(connectivity.seams, triangles)),
                          errors.empty() ? "lossless" : "largest error: " + errors,
                          stores ? fmt::format("; resident {} bytes", whole->bytes.size()) : ""));
    return done;
}

int run_encode(const EncodeCommand& options, RunLog& log) {
    const auto outputs = output_paths(options.inputs, options.output, ".lr");
    if (!outputs) return fail(output_name(options.output.path), outputs.error());
    return for_each_input(options.inputs, log,
                          [&](std::size_t i) { return encode_file(options, options.inputs[i], (*outputs)[i], log); });
}

}  // namespace

void add_encode(CLI::App& program, Action& action) {
    auto options = std::make_shared<EncodeCommand>();
    CLI::App* command = program.add_subcommand("encode", "compress a mesh into an .lr file");
    command->add_option("MESH", options->inputs, "mesh files or .lr files; - is standard input")->required();
    add_output(*command, options->output, ".lr file to write; FOLDER/ for several inputs; - is standard output");
    std::vector<std::string> formats;
    for (const Format format : kStreamFormats) formats.emplace_back(name_of(format));
    allow_words(command->add_option("--format", options->format, "store the mesh as {}"), formats)
        ->capture_default_str();
    allow_words(command->add_option("--profile", options->profile,
                                    "order of packed: small (fewest bits) or cache (GPU's vertex cache)"),
                {"small", "cache"})
        ->capture_default_str();
    add_input_options(*command, options->input, 200);
    add_ring_options(*command, options->ring);
    add_threads(*command, {&options->input.threads, &options->ring.threads});
    allow_whole_numbers(command->add_option("--effort", options->ring.effort,
                                            "time to spend on a good ring, from 0 (fast) to 9 (small files)"),
                        0, 9)
        ->capture_default_str();
    add_attribute_bits(*command, options->bits);
    command->add_flag("--no-warts", options->no_warts, "leave out wart skipping (lean and lr)");
    command->add_flag("--keep-order", options->keep_order,
                      "store the order of vertices and triangles, for decode --original-order");
    CLI::Option* storage = command->add_flag("--storage", options->storage,
                                             "store smaller streams, which readers restore (packed only; its default)");
    command->add_flag("--resident", options->resident, "store streams for use in place, in a mapped file")
        ->excludes(storage);
    command->add_flag("--orient", options->orient, "reverse triangles where neighbors disagree on the orientation");
    auto rules = std::make_shared<OptionRules>(*command);
    const auto is = [options](Format format) { return options->is(format); };
    rules->only_with({"--profile"}, "--format packed", [is] { return is(Format::packed); });
    rules->only_with({"--storage"}, "--format packed", [is] { return is(Format::packed); });
    rules->only_with({"--no-warts"}, "--format lean or lr", [is] { return is(Format::lean) || is(Format::lr); });
    rules->only_with({"--optimize"}, "--format lean, packed or lr", [is] { return !is(Format::lr_compact); });
    rules->only_with({"--k"}, "--ring hybrid or --format lr-compact", [options, is] {
        return options->ring.ring == "hybrid" || (is(Format::lr_compact) && options->ring.ring.empty());
    });
    rules->only_with({"--random-seed"}, "several --seeds, or --optimize", [options, is] {
        return options->ring.seeds > 1 ||
               (!is(Format::lr_compact) &&
                ((options->ring.seeds == 0 && options->ring.effort > 0) ||
                 (options->ring.optimize == "auto" ? options->ring.effort > 0 : options->ring.optimize != "0")));
    });
    add_example(*command, "encode bunny.ply -o bunny.lr --positions 14", "choosing.md and docs/command-line.md");
    command->callback([options, rules, &action] {
        rules->check();
        options->input.keep_vertices = options->keep_order;
        options->input.writes = true;
        action = [options](RunLog& log) { return run_encode(*options, log); };
    });
}

}  // namespace lacedring::app
