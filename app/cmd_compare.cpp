// lacedring compare MESH: the mesh's own index list against its lean stream, pixel by pixel.

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/gpu_options.h"
#include "renderer/compare.h"

namespace lr::app {
namespace {

struct Options {
    MeshInput input;
    std::string diff;
    PictureSize size;
    gpu::ContextOptions context;
    bool json = false;
};

nlohmann::ordered_json to_json(const Options& options, const gpu::DeviceInfo& info, const gpu::Comparison& c,
                               std::size_t messages, const std::string& diff) {
    nlohmann::ordered_json out = {{"schema", 1},
                                  {"file", options.input.path},
                                  {"device", {{"name", info.name}, {"driver", info.driver}, {"api", info.api}}},
                                  {"size", {options.size.width, options.size.height}},
                                  {"views", c.views}};
    out["results"] = nlohmann::ordered_json::array({{{"source", "lean"},
                                                     {"path", "compute"},
                                                     {"pixels_different", c.pixels_different},
                                                     {"max_channel_difference", c.max_channel_difference},
                                                     {"triangle_ids_different", c.triangle_ids_different},
                                                     {"indices_equal_cpu", c.indices_equal_cpu},
                                                     {"raw_pixels_different", c.raw_pixels_different},
                                                     {"raw_max_channel_difference", c.raw_max_channel_difference},
                                                     {"raw_pixels_beyond_one", c.raw_pixels_beyond_one},
                                                     {"covered_pixels", c.covered_pixels},
                                                     {"distinct_ids", c.distinct_ids},
                                                     {"blank", c.blank},
                                                     {"validation_messages", messages}}});
    out["skipped"] = nlohmann::ordered_json::array();
    for (const char* path : {"geometry", "pull", "mesh"}) {
        out["skipped"].push_back({{"path", path}, {"reason", "not built yet"}});
    }
    if (!diff.empty()) out["diff"] = diff;
    return out;
}

void print_table(const Options& options, const gpu::DeviceInfo& info, const gpu::Comparison& c, std::size_t messages) {
    const double raw_share = c.covered_pixels == 0 ? 0
                                                   : 100 * static_cast<double>(c.raw_pixels_different) /
                                                         static_cast<double>(c.covered_pixels);
    fmt::print("{}: plain against lean, {} views of {}x{} on {}\n", options.input.path, c.views, options.size.width,
               options.size.height, info.name);
    fmt::print("  {:<30}{:>12}\n", "pixels that differ", c.pixels_different);
    fmt::print("  {:<30}{:>12}\n", "largest difference, of 255", c.max_channel_difference);
    fmt::print("  {:<30}{:>12}\n", "triangle numbers that differ", c.triangle_ids_different);
    fmt::print("  {:<30}{:>12}\n", "indices as the CPU decodes", c.indices_equal_cpu ? "yes" : "NO");
    fmt::print("  {:<30}{:>12}  {:.4f} % of those covered; {} by more than 1/255, at most {}/255\n",
               "raw pixels that differ", c.raw_pixels_different, raw_share, c.raw_pixels_beyond_one,
               c.raw_max_channel_difference);
    fmt::print("  {:<30}{:>12}{}\n", "pixels covered", c.covered_pixels, c.blank ? "  BLANK" : "");
    fmt::print("  {:<30}{:>12}\n", "triangles seen", c.distinct_ids);
    if (options.context.validation) fmt::print("  {:<30}{:>12}\n", "validation messages", messages);
}

int run(const Options& options) {
    const Result<Mesh> mesh = load(options.input);
    if (!mesh) return fail(options.input.path, mesh.error());
    const Result<gpu::Model> model = gpu::make_model(*mesh);
    if (!model) return fail(options.input.path, model.error());
    const Result<std::unique_ptr<gpu::Context>> context = gpu::Context::create(options.context);
    if (!context) return fail(options.input.path, context.error());
    gpu::CompareOptions compare_options;
    compare_options.width = options.size.width;
    compare_options.height = options.size.height;
    const Result<gpu::Comparison> comparison = gpu::compare(**context, *model, compare_options);
    const std::size_t messages = print_validation(**context);
    if (!comparison) return fail(options.input.path, comparison.error());

    // Where anything differs there is always a picture of it; beside the working folder's files, named after the mesh.
    std::string diff = options.diff;
    if (diff.empty() && !comparison->same())
        diff = std::filesystem::path(options.input.path).stem().string() + ".diff.png";
    if (!diff.empty()) {
        if (const Result<void> written = gpu::write_png(diff, comparison->picture); !written) {
            return fail(diff, written.error());
        }
    }
    const bool passed = comparison->same() && messages == 0;
    if (options.json) {
        print_json(to_json(options, (*context)->info(), *comparison, messages, diff));
    } else {
        print_table(options, (*context)->info(), *comparison, messages);
        if (!diff.empty()) fmt::print("  differences drawn in {}\n", diff);
        fmt::print("{}\n", passed ? "the same picture" : "DIFFERENT");
    }
    return passed ? done : check_failed;
}

}  // namespace

void add_compare(CLI::App& program, Action& action) {
    auto options = std::make_shared<Options>();
    CLI::App* command =
        program.add_subcommand("compare", "draw a mesh plain and from its stream, and compare the pixels");
    command->add_option("MESH", options->input.path, "mesh file")->required();
    add_weld(*command, options->input.weld);
    add_size(*command, options->size);
    command->add_option("--diff", options->diff, "write a picture of the differences, even if there are none")
        ->type_name("FILE.png");
    add_device_options(*command, options->context);
    command->add_flag("--json", options->json, "one JSON document on standard output");
    command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace lr::app
