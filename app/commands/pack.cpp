// lacedring pack SCENE... -o OUT.glb|.gltf

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/cli/help.h"
#include "app/cli/option_rules.h"
#include "app/cli/print.h"
#include "app/cli/scene_output.h"
#include "app/cli/values.h"
#include "app/commands/commands.h"
#include "app/formats/whole_file.h"

namespace lacedring::app {
namespace {

using Json = nlohmann::ordered_json;

struct PackCommand {
    std::vector<std::string> inputs;
    InputOptions input;
    OutputOptions output;
    PackOptions pack;
    std::string document;
    bool lossless = false, resident = false;
    bool json = false;
};

std::string listed(const std::map<std::string, std::size_t>& counts) {
    std::string out;
    for (const auto& [what, count] : counts) out += fmt::format("{}{} of {}", out.empty() ? "" : ", ", count, what);
    return out;
}

std::string errors_of(const std::map<std::string, double>& errors) {
    std::string out;
    for (const auto& [name, error] : errors) {
        out += fmt::format("{}{} {:.3g}", out.empty() ? "" : ", ", printable(name), error);
    }
    return out;
}

Json report_json(const std::string& file, const PackReport& report, std::uint64_t before, std::uint64_t after) {
    Json errors = Json::object(), rest = Json::object();
    for (const auto& [name, error] : report.max_error) errors[name] = error;
    for (const auto& [what, count] : report.not_compressed) rest[what] = count;
    return {{"schema", 1},
            {"file", file},
            {"primitives", report.primitives},
            {"triangles", report.triangles},
            {"bytes_before", before},
            {"bytes_after", after},
            {"geometry_before", report.geometry_before},
            {"geometry_after", report.geometry_after},
            {"max_error", std::move(errors)},
            {"not_compressed", std::move(rest)}};
}

/// Returns an Exit.
int pack_file(const PackCommand& options, const std::string& input, const std::filesystem::path& path, RunLog& log) {
    const auto bytes = read_scene(input, options.input, log);
    if (!bytes) return fail(input, bytes.error());
    const SceneOutput output(path);
    PackOptions how = options.pack;
    how.bin_uri = output.bin;
    how.fallback_uri = output.fallback;
    how.bits.threads = thread_count(options.input.threads);
    PackReport report;
    const auto scene = pack_scene(*bytes, input == "-" ? "" : input, how, read_options(options.input), &report);
    for (std::filesystem::path& file : report.read.files) log.read(file);
    if (!scene) return fail(input, scene.error());
    const auto written = write_scene(*scene, input, output, options.output, log);
    if (!written) return fail(output_name(path), written.error());
    const std::uint64_t before = input_bytes(bytes->size(), report.read);
    for (const std::string& note : report.notes) log.note(input_name(input), note);
    if (!report.not_compressed.empty()) {
        log.note(input_name(input), "primitives not compressed: " + listed(report.not_compressed));
    }
    if (options.json) print_json(report_json(input_name(input), report, before, *written));
    const std::string errors = errors_of(report.max_error);
    log.wrote(output_name(path),
              fmt::format("{}, {}, {} bytes, before {} bytes; geometry {} bytes, before {} bytes; {}",
                          count_text(report.primitives, "primitive"), count_text(report.triangles, "triangle"),
                          *written, before, report.geometry_after, report.geometry_before,
                          errors.empty() ? "lossless" : "largest error: " + errors));
    return done;
}

int run_pack(const PackCommand& options, RunLog& log) {
    const auto outputs = output_paths(options.inputs, options.output, ".glb");
    if (!outputs) return fail(output_name(options.output.path), outputs.error());
    return for_each_input(options.inputs, log,
                          [&](std::size_t i) { return pack_file(options, options.inputs[i], (*outputs)[i], log); });
}

}  // namespace

void add_pack(CLI::App& program, Action& action) {
    auto options = std::make_shared<PackCommand>();
    CLI::App* command = program.add_subcommand("pack", "compress a glTF scene and keep everything in it");
    command->add_option("SCENE", options->inputs, ".gltf or .glb files; - is standard input")->required();
    add_output(*command, options->output,
               ".glb or .gltf file to write; FOLDER/ for several inputs; - is standard output");
    AttributeBits& bits = options->pack.bits;
    CLI::Option* lossless = command->add_flag("--lossless", options->lossless, "round nothing");
    add_attribute_bits(*command, bits);
    for (const char* name : {"--positions", "--normals", "--texcoords", "--colors", "--weights"}) {
        command->get_option(name)->excludes(lossless)->capture_default_str();
    }
    command->add_flag("--keep-order", options->pack.keep_order,
                      "let unpack restore the order of vertices and triangles");
    command->add_flag("--resident", options->resident,
                      "store streams that a GPU can draw: larger, and unpacked faster");
    command->add_flag("--fallback", options->pack.fallback,
                      "add plain buffers for loaders that do not know the extension");
    allow_words(
        command->add_option("--document", options->document, "write a .glb's JSON {}; default: packed where large"),
        {"plain", "packed"});
    add_json(*command, options->json);
    add_allow_outside(*command, options->input);
    add_max_memory(*command, options->input);
    add_threads(*command, {&options->input.threads});
    options->input.triangle_bytes = 200;
    auto rules = std::make_shared<OptionRules>(*command);
    rules->forbid("--document packed has no effect with --fallback",
                  [options] { return options->pack.fallback && options->document == "packed"; });
    rules->forbid("--json and -o - both write to standard output",
                  [options] { return options->json && options->output.path == "-"; });
    add_example(*command, "pack scene.glb -o small.glb",
                "command-line.md and docs/gltf/LACEDRING_mesh_compression/README.md");
    command->callback([options, rules, &action] {
        rules->check();
        if (options->lossless) options->pack.bits = {};
        if (options->resident) options->pack.form = LrForm::resident;
        options->pack.json = options->document == "plain"    ? SceneJson::plain
                             : options->document == "packed" ? SceneJson::packed
                                                             : SceneJson::automatic;
        action = [options](RunLog& log) { return run_pack(*options, log); };
    });
}

}  // namespace lacedring::app
