// lacedring report MESH... -o OUT.html: figures, charts and pictures of meshes as one page.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <span>

#include "app/cli/option_rules.h"
#include "app/cli/output.h"
#include "app/commands/commands.h"
#include "app/report/html.h"
#include "app/report/page.h"
#ifdef LACEDRING_GPU
#include "app/cli/camera_options.h"
#include "app/report/pictures.h"
#include "renderer/vk/device_error.h"
#endif

namespace lacedring::app {
namespace {

struct ReportOptions {
    std::vector<std::string> paths;
    OutputOptions output;
    InputOptions input;
    RingChoice ring;
    bool no_gpu = false;
#ifdef LACEDRING_GPU
    PictureSize size{960, 720};
    gpu::CameraOptions camera;  ///< of every mesh
    gpu::ContextOptions context;
#endif
    std::string command;  ///< as it was given
};

/// The command with the options that were given, positional arguments last.
std::string command_line(const CLI::App& command) {
    std::string out = "lacedring " + command.get_name(), positional;
    bool dashes = false;  // does a file look like an option?
    for (const CLI::Option* option : command.get_options()) {
        if (option->count() == 0) continue;
        const bool flag = option->get_items_expected_max() == 0;
        for (const std::string& value : option->results()) {
            const bool dash = value.starts_with('-');
            if (!option->nonpositional()) {
                positional += ' ' + shell_word(value);
                dashes = dashes || dash;
            } else if (flag && value == "true") {
                out += ' ' + option->get_name();
            } else {
                out += ' ' + option->get_name() + (flag || dash ? '=' : ' ') + shell_word(value);
            }
        }
    }
    return out + (dashes ? " --" : "") + positional;
}

#ifdef LACEDRING_GPU
/// The device, unless there shall or can be none: then `skipped` says why. Errors: those of a device asked for.
Result<std::unique_ptr<gpu::Context>> open_device(const ReportOptions& options, std::string& skipped) {
    if (options.no_gpu) {
        skipped = "--no-gpu";
        return std::unique_ptr<gpu::Context>();
    }
    Result<std::unique_ptr<gpu::Context>> context = gpu::Context::create(options.context);
    if (!context && context.error().code == gpu::kNoDevice && !asks_for_device(options.context)) {
        skipped = context.error().message;
        return std::unique_ptr<gpu::Context>();
    }
    return context;
}
#endif

int run_report(const ReportOptions& options, RunLog& log) {
    ReportPage page;
    page.command = options.command;
    page.version = LACEDRING_VERSION;
    std::string skipped = "built without Vulkan";
#ifdef LACEDRING_GPU
    skipped.clear();
    const Result<std::unique_ptr<gpu::Context>> device = open_device(options, skipped);
    if (!device) return fail(options.paths.front(), device.error());
    gpu::Context* context = device->get();
    if (context != nullptr) {
        const gpu::DeviceInfo& info = context->info();
        page.device = fmt::format("{}, {}, Vulkan {}", info.name, info.driver, info.api);
        const std::uint32_t samples = report_samples(*context, options.size);
        page.samples = samples * samples;
    }
#endif
    std::vector<MeshReport> meshes;
    std::size_t messages = 0;
    const int exit = for_each_input(options.paths, log, [&](std::size_t i) {
        const std::string& path = options.paths[i];
        const auto leave_out = [&](const std::string& why, int code) {
            page.left_out.emplace_back(path, why);
            return code;
        };
        const Result<LoadedMesh> mesh = load_file({path, options.input}, log);
        if (!mesh) return leave_out(mesh.error().message, fail(path, mesh.error()));
        std::string invalid;
        Result<MeshReport> report = measure_mesh(path, *mesh, options.ring, invalid);
        if (!report) return leave_out(report.error().message, fail(path, report.error()));
        if (!invalid.empty()) {
            say("lacedring: {}: {}\n", path, invalid);
            return leave_out(invalid, check_failed);
        }
        report->no_pictures = skipped;
#ifdef LACEDRING_GPU
        if (context != nullptr) {
            const Result<void> drawn =
                draw_pictures(*context, options.size, options.camera, *mesh, options.ring, *report);
            if (!drawn) return leave_out(drawn.error().message, fail(path, drawn.error()));
        }
#endif
        meshes.push_back(std::move(*report));
        return int{done};
    });
    if (meshes.empty()) return exit;
#ifdef LACEDRING_GPU
    if (context != nullptr) messages = print_validation(*context);
    if (std::ranges::all_of(meshes, [](const MeshReport& mesh) { return mesh.pictures.empty(); })) {
        page.device.clear();
        skipped = meshes.front().no_pictures;
    }
#endif
    constexpr std::string_view kExtensions[] = {".html", ".htm"};
    if (const auto good = check_output(options.output.path, options.output, log, kExtensions); !good) {
        return fail(output_name(options.output.path), good.error());
    }
    page.meshes = meshes;
    const std::string text = report_page(page);
    const std::span<const std::byte> part = std::as_bytes(std::span(text));
    if (const Result<void> written = write_output(options.output.path, std::span(&part, 1)); !written) {
        return fail(output_name(options.output.path), written.error());
    }
    const std::string line = fmt::format("{}: {}, {} bytes; {}\n", output_name(options.output.path),
                                         counted(meshes.size(), "mesh", "meshes"), text.size(),
                                         skipped.empty() ? "drawn on " + page.device : "no pictures: " + skipped);
    options.output.path == "-" ? say("{}", line) : print("{}", line);
    return exit == done && messages != 0 ? check_failed : exit;
}

}  // namespace

void add_report(CLI::App& program, Action& action) {
    auto options = std::make_shared<ReportOptions>();
    CLI::App* command = program.add_subcommand("report", "figures, charts and pictures of meshes as one HTML page");
    command->add_option("MESH", options->paths, "mesh files")->required();
    add_output(*command, options->output, "the HTML file; - for standard output");
    add_input_options(*command, options->input, 350);
    add_ring_options(*command, options->ring);
    command->add_flag("--no-gpu", options->no_gpu, "no pictures");
#ifdef LACEDRING_GPU
    add_size(*command, options->size);
    command->get_option("--size")->description("pixels of a picture, 960x720 unless told");
    add_camera(*command, options->camera);
    add_device_options(*command, options->context);
#endif
    auto rules = std::make_shared<OptionRules>(*command);
    rules->never_with({"--size", "--up", "--camera-position", "--camera-focal-point", "--camera-azimuth-angle",
                       "--camera-elevation-angle", "--camera-zoom-factor", "--camera-view-angle", "--device",
                       "--device-memory", "--validation"},
                      "--no-gpu");
    command->callback([options, rules, &action, command] {
        rules->check();
        options->command = command_line(*command);
        action = [options](RunLog& log) { return run_report(*options, log); };
    });
}

}  // namespace lacedring::app
