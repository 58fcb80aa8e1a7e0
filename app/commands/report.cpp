// lacedring report MESH... -o OUT.html: figures, charts and pictures of meshes as one page.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <span>

#include "app/cli/help.h"
#include "app/cli/option_rules.h"
#include "app/cli/output.h"
#include "app/commands/commands.h"
#include "app/report/html.h"
#include "app/report/page.h"
#include "app/report/pictures.h"

namespace lacedring::app {
namespace {

struct ReportOptions {
    std::vector<std::string> paths;
    OutputOptions output;
    InputOptions input;
    RingChoice ring;
    ReportPictures pictures;
    std::string command;  ///< the command line
};

/// The command line as shell words: the options that were given, then the positional arguments.
std::string command_line(const CLI::App& command) {
    std::string out = "lacedring " + command.get_name(), positional;
    bool dashes = false;  // a file name begins with a dash
    for (const CLI::Option* option : command.get_options()) {
        if (option->count() == 0 || option->get_name() == "--quiet") continue;  // --quiet does not change the page
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

int run_report(ReportOptions& options, RunLog& log) {
    ReportPage page;
    page.command = options.command;
    page.version = LACEDRING_VERSION;
    const Result<ReportPictures::Device> device = options.pictures.open();
    if (!device) return fail(options.paths.front(), device.error());
    page.device = device->name;
    page.samples = device->samples;
    std::string skipped = device->skipped;
    std::vector<MeshReport> meshes;
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
        if (const Result<void> drawn = options.pictures.draw(*mesh, options.ring, *report); !drawn) {
            return leave_out(drawn.error().message, fail(path, drawn.error()));
        }
        meshes.push_back(std::move(*report));
        return int{done};
    });
    if (meshes.empty()) return exit;
    const std::size_t messages = options.pictures.print_messages();
    if (std::ranges::all_of(meshes, [](const MeshReport& mesh) { return mesh.pictures.empty(); })) {
        page.device.clear();
        skipped = meshes.front().no_pictures;
    }
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
    log.wrote(output_name(options.output.path),
              fmt::format("{}, {} bytes; {}", counted(meshes.size(), "mesh", "meshes"), text.size(),
                          skipped.empty() ? "drawn on " + page.device : "no pictures: " + skipped));
    log.flush();
    return exit == done && messages != 0 ? check_failed : exit;
}

}  // namespace

void add_report(CLI::App& program, Action& action) {
    auto options = std::make_shared<ReportOptions>();
    CLI::App* command =
        program.add_subcommand("report", "write figures, charts and pictures of meshes as one HTML page");
    command->add_option("MESH", options->paths, "mesh files or .lr files; - is standard input")->required();
    add_output(*command, options->output, ".html file to write; - is standard output");
    add_input_options(*command, options->input, 420);
    add_ring_options(*command, options->ring);
    add_threads(*command, {&options->input.threads, &options->ring.threads});
    options->pictures.add_options(*command);
    auto rules = std::make_shared<OptionRules>(*command);
    rules->never_with({"--size", "--up", "--camera-position", "--camera-focal-point", "--camera-azimuth-angle",
                       "--camera-elevation-angle", "--camera-zoom-factor", "--camera-view-angle", "--device",
                       "--device-memory", "--validation"},
                      "--no-gpu");
    add_example(*command, "report bunny.ply kitten.glb -o meshes.html", "command-line.md");
    command->callback([options, rules, &action, command] {
        rules->check();
        options->command = command_line(*command);
        action = [options](RunLog& log) { return run_report(*options, log); };
    });
}

}  // namespace lacedring::app
