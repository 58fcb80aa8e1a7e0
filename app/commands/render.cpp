// lacedring render MESH -o OUT.png

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/cli/camera_options.h"
#include "app/cli/gpu_options.h"
#include "app/cli/help.h"
#include "app/cli/option_rules.h"
#include "app/cli/output.h"
#include "app/cli/values.h"
#include "app/commands/commands.h"
#include "renderer/draw/png.h"
#include "renderer/draw/renderer.h"

namespace lacedring::app {
namespace {

struct RenderOptions {
    std::vector<std::string> inputs;
    InputOptions input;
    OutputOptions output;
    std::string source = "lean";
    std::string path = "compute";
    std::string view;             ///< "": material if the file has any, else smooth
    std::uint32_t positions = 0;  ///< bits
    RingChoice ring;
    bool no_warts = false;
    PictureSize size;
    /// 0: kSamples, or fewer if the device's limit is lower.
    std::uint32_t samples = 0;
    double crease = 40;
    gpu::CameraOptions camera;
    gpu::ContextOptions context;
    bool json = false;
};

constexpr std::uint32_t kSamples = 3;

using ContextPointer = std::unique_ptr<gpu::Context>;

/// Draws one mesh. Creates `context` if it is null, after the mesh is read. Returns an Exit.
int render(const RenderOptions& options, const std::string& input, const std::filesystem::path& output,
           ContextPointer& context, RunLog& log) {
    MeshInput from{input, options.input};
    from.options.materials = options.view.empty() || options.view == "material";
    const Result<LoadedMesh> loaded = load_file(from, log);
    if (!loaded) return fail(input, loaded.error());
    const Mesh* mesh = &loaded->mesh;
    const std::string view_name = !options.view.empty()     ? options.view
                                  : loaded->has_materials() ? "material"
                                                            : "smooth";
    constexpr std::string_view kExtensions[] = {".png"};
    if (const auto good = check_output(output, options.output, log, kExtensions); !good) {
        return fail(output_name(output), good.error());
    }
    // Pictures show the paper's ring, without the optimizer, unless --optimize is given.
    OptimizeOptions optimize = optimize_options(options.ring, kLeanRingCost);
    if (options.ring.optimize == "auto") optimize.passes = 0;
    const gpu::Source source = gpu::find_named(gpu::kSources, options.source).value_or(gpu::Source::lean);
    gpu::ModelOptions model_options{ring_options(options.ring, mesh->triangle_count()),
                                    {.wart_skipping = !options.no_warts},
                                    gpu::is_packed(source),
                                    {},
                                    std::move(optimize)};
    model_options.surface = loaded->surface;
    if (source == gpu::Source::packed_vertices)
        model_options.vertices = position_options(options.positions, options.ring.threads);
    Result<gpu::Model> model = gpu::make_model(*mesh, model_options);
    if (!model) return fail(input, model.error());
    if (view_name == "material") gpu::add_materials(*model, *mesh, loaded->materials);
    if (!model->exact.empty()) log.note(input_name(input), "POSITION stays lossless: " + model->exact);
    if (!context) {
        Result<ContextPointer> made = gpu::Context::create(options.context);
        if (!made) return fail(input, made.error());
        context = std::move(*made);
    }

    gpu::RendererOptions renderer_options;
    renderer_options.view = gpu::find_named(gpu::kViews, view_name).value_or(gpu::View::smooth);
    // An explicit --samples is used as it is, or drawing fails; the default falls back to fewer samples.
    const std::uint32_t samples =
        options.samples != 0
            ? options.samples
            : gpu::Target::fitting_samples(*context, {options.size.width, options.size.height}, kSamples);
    renderer_options.samples = samples;
    renderer_options.crease = options.crease;
    renderer_options.width = options.size.width * samples;
    renderer_options.height = options.size.height * samples;
    constexpr std::uint64_t kWorthSaying = std::uint64_t{1} << 30;
    std::uint64_t device_bytes = 0;
    Result<gpu::Picture> drawn = [&]() -> Result<gpu::Picture> {
        Result<gpu::Renderer> renderer = gpu::Renderer::create(*context, renderer_options);
        if (!renderer) return renderer.error();
        const gpu::Path path = gpu::find_named(gpu::kPaths, options.path).value_or(gpu::Path::compute);
        device_bytes = context->arena().used() + renderer->device_bytes(*model, source, path);
        if (device_bytes > kWorthSaying) {
            log.note(input_name(input),
                     fmt::format("drawing takes {:.1f} GB of device memory", static_cast<double>(device_bytes) / 1e9));
            log.flush();  // before the memory is taken, which may end the process
        }
        Result<gpu::Drawable> drawable = renderer->upload(*model, source, path);
        if (!drawable) return drawable.error();
        for (const std::string& note : renderer->notes()) log.note(input_name(input), note);
        const Result<gpu::Camera> camera =
            gpu::make_camera(*model, options.camera, renderer_options.width, renderer_options.height);
        if (!camera) return camera.error();
        return renderer->draw(*drawable, *model, *camera, true);
    }();
    const std::size_t messages = print_validation(*context);
    if (!drawn) return fail(input, drawn.error());
    const Result<std::vector<std::byte>> png = gpu::encode_png(gpu::finish(*drawn, samples));
    if (!png) return fail(output_name(output), png.error());
    const std::span<const std::byte> parts[] = {*png};
    if (const Result<void> written = write_output(output, parts); !written) {
        return fail(output_name(output), written.error());
    }
    std::uint64_t covered = 0;
    for (const std::uint32_t id : drawn->triangles) covered += id != 0 ? 1 : 0;
    const double share = static_cast<double>(covered) / static_cast<double>(drawn->pixels());
    if (options.json) {
        const gpu::DeviceInfo& info = context->info();
        nlohmann::ordered_json out = {{"schema", 1},
                                      {"file", input_name(input)},
                                      {"output", output.string()},
                                      {"device", {{"name", info.name}, {"driver", info.driver}, {"api", info.api}}},
                                      {"size", {options.size.width, options.size.height}},
                                      {"samples", samples * samples},
                                      {"source", options.source},
                                      {"path", options.path},
                                      {"view", view_name},
                                      {"triangles", model->triangle_count()},
                                      {"covered", share},
                                      {"device_bytes", device_bytes},
                                      {"validation_messages", messages}};
        print_json(out);
    }
    log.wrote(output_name(output),
              fmt::format("{}x{} pixels, {} bytes; {}, {} {}, covers {:.1f} % of the picture; {}", options.size.width,
                          options.size.height, png->size(), count_text(model->triangle_count(), "triangle"),
                          options.source, view_name, 100 * share, context->info().name));
    return messages == 0 ? done : check_failed;
}

int run_render(const RenderOptions& options, RunLog& log) {
    const auto outputs = output_paths(options.inputs, options.output, ".png");
    if (!outputs) return fail(output_name(options.output.path), outputs.error());
    ContextPointer context;
    return for_each_input(options.inputs, log, [&](std::size_t i) {
        return render(options, options.inputs[i], (*outputs)[i], context, log);
    });
}

}  // namespace

void add_render(CLI::App& program, Action& action) {
    auto options = std::make_shared<RenderOptions>();
    CLI::App* command = program.add_subcommand("render", "draw a mesh into a PNG file");
    command->add_option("MESH", options->inputs, "mesh files or .lr files; - is standard input")->required();
    add_output(*command, options->output, ".png file to write; FOLDER/ for several inputs; - is standard output");
    add_input_options(*command, options->input, 220);
    allow_words(command->add_option("--source", options->source, "draw from {}"), gpu::names_of(gpu::kSources))
        ->capture_default_str();
    add_position_bits(*command, options->positions);
    allow_words(command->add_option("--path", options->path, "decode on the device by {}"), gpu::names_of(gpu::kPaths))
        ->capture_default_str();
    allow_words(
        command->add_option("--view", options->view, "show {}; default: material if the file has any, else smooth"),
        gpu::names_of(gpu::kViews));
    allow_numbers(command->add_option("--crease", options->crease,
                                      "draw edges sharper than ANGLE degrees, with --view silhouette"),
                  0, 180)
        ->type_name("ANGLE")
        ->capture_default_str();
    add_ring_options(*command, options->ring);
    add_threads(*command, {&options->input.threads, &options->ring.threads});
    command->add_flag("--no-warts", options->no_warts, "leave out wart skipping");
    add_size(*command, options->size);
    allow_whole_numbers(command->add_option("--samples", options->samples, "samples along each side of a pixel, {}"), 1,
                        8)
        ->default_str(std::to_string(kSamples));
    add_camera(*command, options->camera);
    add_device_options(*command, options->context);
    add_json(*command, options->json);

    const auto shows_ring = [options] {
        const auto view = gpu::find_named(gpu::kViews, options->view);
        return view && gpu::has_ring(*view);
    };
    auto rules = std::make_shared<OptionRules>(*command);
    rules->forbid("--json goes with one mesh, and not with -o -",
                  [options] { return options->json && (options->inputs.size() != 1 || options->output.path == "-"); });
    rules->forbid("--source plain goes with --path compute only",
                  [options] { return options->source == "plain" && options->path != "compute"; });
    rules->only_with({"--positions"}, "--source packed_vertices",
                     [options] { return options->source == "packed_vertices"; });
    rules->only_with({"--crease"}, "--view silhouette", [options] { return options->view == "silhouette"; });
    rules->only_with({"--ring", "--k", "--seeds", "--random-seed", "--optimize"},
                     "--source lean, packed or packed_vertices, or --view class, ring or offsets",
                     [options, shows_ring] { return options->source != "plain" || shows_ring(); });
    rules->only_with({"--no-warts"}, "--source lean, or --view class, ring or offsets",
                     [options, shows_ring] { return options->source == "lean" || shows_ring(); });
    rules->only_with({"--k"}, "--ring hybrid", [options] { return options->ring.ring == "hybrid"; });
    rules->only_with({"--random-seed"}, "several --seeds, or --optimize", [options] {
        const std::string& passes = options->ring.optimize;
        return options->ring.seeds != 1 || (passes != "auto" && passes != "0");
    });
    add_example(*command, "render bunny.ply -o bunny.png --view ring", "renderer.md");
    command->callback([options, rules, &action] {
        rules->check();
        action = [options](RunLog& log) { return run_render(*options, log); };
    });
}

}  // namespace lacedring::app
