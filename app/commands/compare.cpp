// lacedring compare MESH: draws a mesh from its index list and from its streams, and compares the pixels.

#include "renderer/verify/compare.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "app/cli/gpu_options.h"
#include "app/cli/help.h"
#include "app/cli/option_rules.h"
#include "app/cli/output.h"
#include "app/cli/progress.h"
#include "app/cli/values.h"
#include "app/commands/commands.h"
#include "app/formats/scene_check.h"
#include "renderer/vk/device_error.h"

namespace lacedring::app {
namespace {

struct CompareOptions {
    MeshInput input;
    OutputOptions diff;
    std::set<std::string> sources, paths;  ///< empty: all
    std::uint32_t positions = 0;           ///< bits
    PictureSize size;
    gpu::ContextOptions context;
    bool json = false;

    bool compares(const std::string& source) const { return sources.empty() || sources.contains(source); }
};

struct Compared {
    const char* source;
    const char* path;
    gpu::Subject subject;
    gpu::Comparison comparison;
};

/// A path that was not compared, and why.
struct Skipped {
    const char* path;
    std::string reason;
};

/// The scene that the drawn mesh was joined from.
struct DrawnScene {
    std::size_t primitives = 0;  ///< 0: the file has a single primitive
    std::size_t placed = 0;      ///< primitives, counted once per node
    std::size_t mirrored = 0;    ///< placed ones whose node mirrors them
    std::size_t triangles = 0;   ///< in all placed primitives
    /// The first difference between the drawn mesh and the primitives; empty if there is none.
    std::string why;
};

/// Checks that the drawn mesh consists of every primitive as placed by every node.
DrawnScene check_scene(const LoadedScene& scene, double tolerance) {
    DrawnScene out;
    out.primitives = scene.primitives.size();
    if (out.primitives == 0) return out;
    std::vector<std::size_t> mirrored(scene.primitives.back().mesh + 1);  // mirroring placements of each mesh
    for (const PlacedMesh& placed : scene.placed) {
        if (placed.mesh < mirrored.size() && mirrors(placed.placement)) ++mirrored[placed.mesh];
    }
    for (const LoadedPrimitive& primitive : scene.primitives) {
        out.placed += primitive.placed;
        out.mirrored += mirrored[primitive.mesh];
        out.triangles += primitive.placed * primitive.geometry.triangle_count();
    }
    const PlacedDifference difference = check_placed(scene, tolerance);
    if (!difference.why.empty()) {
        out.why = (difference.primitive == nullptr ? "" : difference.primitive->label() + ": ") + difference.why;
    }
    return out;
}

/// Returns whether the pictures show almost nothing of the mesh. All results agree on this.
bool is_blank(std::span<const Compared> all) {
    return std::any_of(all.begin(), all.end(), [](const Compared& compared) { return compared.comparison.blank; });
}

nlohmann::ordered_json comparison_json(const CompareOptions& options, const gpu::DeviceInfo& info,
                                       std::span<const Compared> all, std::span<const Skipped> skipped,
                                       std::size_t messages, const std::string& diff, const DrawnScene& scene) {
    nlohmann::ordered_json out = {{"schema", 1},
                                  {"file", input_name(options.input.path)},
                                  {"device", {{"name", info.name}, {"driver", info.driver}, {"api", info.api}}},
                                  {"size", {options.size.width, options.size.height}},
                                  {"views", all[0].comparison.views}};
    out["results"] = nlohmann::ordered_json::array();
    for (const Compared& compared : all) {
        const gpu::Comparison& c = compared.comparison;
        nlohmann::ordered_json result = {{"source", compared.source},
                                         {"path", compared.path},
                                         {"pixels_different", c.pixels_different},
                                         {"max_channel_difference", c.max_channel_difference},
                                         {"triangle_ids_different", c.triangle_ids_different},
                                         {"indices_equal_cpu", c.indices_equal_cpu}};
        if (c.vertices_equal_cpu) result["vertices_equal_cpu"] = *c.vertices_equal_cpu;
        result.update({{"raw_pixels_different", c.raw_pixels_different},
                       {"raw_max_channel_difference", c.raw_max_channel_difference},
                       {"raw_pixels_beyond_one", c.raw_pixels_beyond_one},
                       {"covered_pixels", c.covered_pixels},
                       {"distinct_ids", c.distinct_ids},
                       {"blank", c.blank},
                       {"validation_messages", messages}});
        out["results"].push_back(std::move(result));
    }
    out["blank"] = is_blank(all);
    out["skipped"] = nlohmann::ordered_json::array();
    for (const Skipped& s : skipped) out["skipped"].push_back({{"path", s.path}, {"reason", s.reason}});
    if (!diff.empty()) out["diff"] = diff;
    if (scene.primitives > 0) {
        out["scene"] = {{"primitives", scene.primitives}, {"placed", scene.placed},  {"mirrored", scene.mirrored},
                        {"triangles", scene.triangles},   {"ok", scene.why.empty()}, {"why", scene.why}};
    }
    return out;
}

void print_table(const CompareOptions& options, const gpu::DeviceInfo& info, std::span<const Compared> all,
                 std::size_t messages) {
    print("{}: plain against streams, {} views of {}x{} on {}\n", options.input.path, all[0].comparison.views,
          options.size.width, options.size.height, info.name);
    const auto width = [](const Compared& compared) { return std::strlen(compared.source) > 9 ? 17 : 10; };
    print("  {:<40}", "");
    for (const Compared& compared : all) print("{:>{}}", compared.source, width(compared));
    print("\n  {:<40}", "");
    for (const Compared& compared : all) print("{:>{}}", compared.path, width(compared));
    const auto row = [&](const char* what, const auto& value) {
        print("\n  {:<40}", what);
        for (const Compared& compared : all) print("{:>{}}", value(compared.comparison), width(compared));
    };
    row("pixels that differ", [](const gpu::Comparison& c) { return c.pixels_different; });
    row("largest difference, of 255", [](const gpu::Comparison& c) { return c.max_channel_difference; });
    row("triangle numbers that differ", [](const gpu::Comparison& c) { return c.triangle_ids_different; });
    row("indices as the CPU decodes", [](const gpu::Comparison& c) { return c.indices_equal_cpu ? "yes" : "NO"; });
    row("vertices as the CPU decodes", [](const gpu::Comparison& c) {
        return !c.vertices_equal_cpu ? "-" : *c.vertices_equal_cpu ? "yes" : "NO";
    });
    row("raw pixels that differ", [](const gpu::Comparison& c) { return c.raw_pixels_different; });
    row("  in % of those covered", [](const gpu::Comparison& c) {
        return fmt::format("{:.4f}", 100 * static_cast<double>(c.raw_pixels_different) /
                                         static_cast<double>(std::max<std::uint64_t>(1, c.covered_pixels)));
    });
    row("  by more than 1/255", [](const gpu::Comparison& c) { return c.raw_pixels_beyond_one; });
    row("  at most, of 255", [](const gpu::Comparison& c) { return c.raw_max_channel_difference; });
    row("pixels covered", [](const gpu::Comparison& c) { return c.covered_pixels; });
    row("triangles seen", [](const gpu::Comparison& c) { return c.distinct_ids; });
    if (options.context.validation) print("\n  {:<40}{:>10}", "validation messages", messages);
    print("\n");
}

std::string verdict(bool passed, std::span<const Compared> all, std::uint32_t triangles) {
    if (!passed) return "DIFFERENT";
    if (!is_blank(all)) return "the same pictures";
    const gpu::Comparison& c = all[0].comparison;
    return fmt::format("nothing to be seen: {} of {} triangles on {} pixels; nothing differs", c.distinct_ids,
                       triangles, c.covered_pixels);
}

int run_compare(const CompareOptions& options, RunLog& log) {
    MeshInput input = options.input;
    input.options.materials = true;
    Result<LoadedScene> loaded = load_scene(input, log);
    if (!loaded) return fail(options.input.path, loaded.error());
    const DrawnScene scene = check_scene(*loaded, options.input.options.tolerance);
    loaded->primitives = {};
    const Mesh* mesh = &loaded->joined.mesh;
    constexpr std::string_view kExtensions[] = {".png"};
    if (const auto good = check_output(options.diff.path, options.diff, log, kExtensions); !good) {
        return fail(options.diff.path, good.error());
    }
    gpu::ModelOptions model_options{.packed = true, .surface = loaded->joined.surface};
    if (options.compares("packed_vertices"))
        model_options.vertices = position_options(options.positions, options.input.options.threads);
    Result<gpu::Model> model = gpu::make_model(*mesh, model_options);
    if (!model) return fail(options.input.path, model.error());
    if (loaded->joined.has_materials()) gpu::add_materials(*model, *mesh, loaded->joined.materials);
    if (!model->exact.empty()) log.note(input_name(options.input.path), "POSITION stays lossless: " + model->exact);
    const Result<std::unique_ptr<gpu::Context>> context = gpu::Context::create(options.context);
    if (!context) return fail(options.input.path, context.error());
    std::vector<Compared> all;
    std::vector<Skipped> skipped;
    for (const auto& [path_name, path, path_label] : gpu::kPaths) {
        if (path == gpu::Path::mesh && (*context)->info().max_mesh_groups == 0) {
            skipped.push_back({path_name, "the device has no mesh shaders (VK_EXT_mesh_shader)"});
            continue;
        }
        if (!options.paths.empty() && !options.paths.contains(path_name)) {
            skipped.push_back({path_name, "--path"});
            continue;
        }
        for (const auto& [source_name, source, source_label] : gpu::kSources) {
            if (source == gpu::Source::plain || !options.compares(source_name)) continue;
            if (options.sources.empty() && options.paths.empty() &&
                gpu::is_slow(source, path, model->triangle_count())) {
                skipped.push_back({path_name, fmt::format("{} of more than {} triangles: --source {} compares it",
                                                          source_name, gpu::kMostPulled, source_name)});
                continue;
            }
            all.push_back({source_name, path_name, {source, path}, {}});
        }
    }
    if (all.empty()) return fail(options.input.path, Error{gpu::kNoDevice, skipped.back().reason});
    gpu::CompareOptions compare_options;
    compare_options.width = options.size.width;
    compare_options.height = options.size.height;
    if (model->materials != nullptr) compare_options.view = gpu::View::material;
    std::vector<gpu::Subject> subjects;
    for (const Compared& compared : all) subjects.push_back(compared.subject);
    Result<std::vector<gpu::Comparison>> comparisons = [&] {
        std::optional<ProgressBar> bar;
        compare_options.progress = [&bar](std::uint32_t done, std::uint32_t total) {
            if (!bar) bar.emplace("comparing", total);
            bar->show(done);
        };
        return gpu::compare(**context, *model, subjects, compare_options);
    }();
    if (!comparisons) {
        print_validation(**context);
        return fail(options.input.path, comparisons.error());
    }
    for (std::size_t i = 0; i < all.size(); ++i) all[i].comparison = std::move((*comparisons)[i]);
    const std::size_t messages = print_validation(**context);

    // A difference is always drawn: into --diff, else into a file in the working folder named after the mesh.
    const auto other =
        std::find_if(all.begin(), all.end(), [](const Compared& compared) { return !compared.comparison.same(); });
    const bool same = other == all.end();
    std::string diff = options.diff.path;
    if (diff.empty() && !same) diff = std::filesystem::path(options.input.path).stem().string() + ".diff.png";
    if (!diff.empty()) {
        const Compared& shown = same ? all.front() : *other;
        if (const Result<void> written = gpu::write_png(diff, shown.comparison.picture); !written) {
            return fail(diff, written.error());
        }
    }
    const bool passed = same && messages == 0 && scene.why.empty();
    if (options.json) {
        print_json(comparison_json(options, (*context)->info(), all, skipped, messages, diff, scene));
    } else {
        print_table(options, (*context)->info(), all, messages);
        for (const Skipped& s : skipped) print("  {} not compared: {}\n", s.path, s.reason);
        if (!diff.empty()) print("  differences drawn in {}\n", diff);
        if (scene.primitives > 0) {
            print("  {} primitives at {} places, {} of them mirrored: {} triangles{}\n", scene.primitives, scene.placed,
                  scene.mirrored, scene.triangles, scene.why.empty() ? "" : "; " + scene.why);
        }
        print("{}\n", verdict(passed, all, model->triangle_count()));
    }
    return passed ? done : check_failed;
}

}  // namespace

void add_compare(CLI::App& program, Action& action) {
    auto options = std::make_shared<CompareOptions>();
    CLI::App* command =
        program.add_subcommand("compare", "draw a mesh from its indices and from its streams, and compare the pixels");
    command->add_option("MESH", options->input.path, "mesh file or .lr file; - is standard input")->required();
    add_input_options(*command, options->input.options, 250);
    add_threads(*command, {&options->input.options.threads});
    add_force(*command, options->diff);
    add_size(*command, options->size);
    allow_words(command->add_option("--path", options->paths, "compare only {} (several: A,B)"),
                gpu::names_of(gpu::kPaths))
        ->delimiter(',');
    allow_words(command->add_option("--source", options->sources, "compare only {} (several: A,B)"),
                gpu::names_of(std::span(gpu::kSources).subspan(1)))
        ->delimiter(',');
    add_position_bits(*command, options->positions);
    command->add_option("--diff", options->diff.path, "write a picture of the differences even if there are none")
        ->type_name("FILE.png");
    add_device_options(*command, options->context);
    add_json(*command, options->json);
    auto rules = std::make_shared<OptionRules>(*command);
    rules->only_with({"--positions"}, "--source packed_vertices",
                     [options] { return options->compares("packed_vertices"); });
    add_example(*command, "compare bunny.ply", "renderer.md");
    command->callback([options, rules, &action] {
        rules->check();
        action = [options](RunLog& log) { return run_compare(*options, log); };
    });
}

}  // namespace lacedring::app
