// The program lacedring-view, run by `lacedring view [MESH]`: parses the command line, makes window and device, and
// runs the loop of events and frames.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <exception>
#include <thread>

#include "app/cli/camera_options.h"
#include "app/cli/command.h"
#include "app/cli/gpu_options.h"
#include "app/cli/help.h"
#include "app/cli/option_rules.h"
#include "app/cli/values.h"
#include "app/view/script/script.h"
#include "app/view/session/threads.h"
#include "app/view/ui/viewer.h"
#include "app/view/window/window.h"
#include "renderer/vk/swapchain.h"

namespace lacedring::view {
namespace {

using Clock = std::chrono::steady_clock;

const Clock::time_point kStart = Clock::now();
constexpr std::chrono::milliseconds kPatience{500};  // longest wait for threads at the end

struct Options {
    ViewerOptions viewer;
    app::PictureSize size;
    gpu::ContextOptions context;
    std::string script, screenshot;
    double scale = 0;  ///< 0: the display's
    bool no_panels = false;
};

/// Handles events up to and including the first press of a button or key: ImGui must see a press one frame before its
/// release.
void feed(Viewer& viewer, std::deque<Event>& events) {
    while (!events.empty()) {
        const Event event = std::move(events.front());
        events.pop_front();
        viewer.handle(event);
        const bool more_moves = event.kind == Event::move && !events.empty() && events.front().kind == Event::move;
        if ((event.kind == Event::button || event.kind == Event::key) && event.down) return;
        // End the frame after the last of several moves: panels must know the mouse's position before a press.
        if (event.kind == Event::move && !more_moves && !events.empty()) return;
    }
}

Result<void> loop(Viewer& viewer, Window& window, gpu::Swapchain& swapchain, Script* script) {
    std::deque<Event> events;
    Clock::time_point last = Clock::now();
    std::string title;
    const VkExtent2D extent = window.extent();
    viewer.handle({.kind = Event::resize, .x = double(extent.width), .y = double(extent.height)});
    while (!viewer.closing()) {
        // If nothing moves, sleep until an event or a thread wakes us, at most 0.1 s, so that progress bars advance.
        const bool rest = events.empty() && !viewer.moving() && (script == nullptr || script->waiting());
        for (Event& event : window.poll(rest ? 0.1 : 0.0)) {
            // With a script, ignore the input of the real mouse and keyboard.
            if (script == nullptr || event.kind == Event::resize || event.kind == Event::refresh) {
                events.push_back(std::move(event));
            }
        }
        if (script != nullptr) {
            if (const Result<void> ran = script->advance(viewer, window, events); !ran) return ran;
        }
        const bool asleep = script == nullptr && events.empty() && viewer.idle();
        feed(viewer, events);
        if (viewer.closing()) break;  // no further frame is needed
        const Clock::time_point now = Clock::now();
        // A script's clock counts frames, so that it gives the same pictures on every machine.
        const double seconds = script != nullptr ? 1.0 / 60 : std::chrono::duration<double>(now - last).count();
        last = now;
        if (asleep) continue;
        if (const Result<void> drawn = viewer.frame(seconds); !drawn) return drawn;
        if (viewer.visible()) {
            const Result<bool> shown = swapchain.show(viewer.image(), viewer.extent(), viewer.window());
            if (!shown) return shown.error();
            viewer.state().facts.window_too_large = !*shown;
            viewer.presented(std::chrono::duration<double>(Clock::now() - now).count());
            double& started = viewer.state().facts.started;
            if (started == 0) started = std::chrono::duration<double>(Clock::now() - kStart).count();
        }
        if (std::string next = viewer.title(); next != title) window.set_title(title = std::move(next));
        if (const std::string text = viewer.take_clipboard(); !text.empty()) {
            window.set_clipboard(text);
            if (script == nullptr) app::print("{}\n", text);
        }
        if (script != nullptr) continue;  // without a frame limit
        // Limit the frame rate: not every driver waits for the display.
        const std::uint32_t cap = viewer.visible() ? viewer.state().choices.frame_cap : 20;
        if (cap == 0) continue;
        std::this_thread::sleep_until(
            now + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / cap)));
    }
    return {};
}

/// Ends the process at once, without destroying objects that threads still use.
[[noreturn]] void leave(int code) {
    std::fflush(stdout);
    std::_Exit(code);
}

int run(Options& options, Threads& threads) {
    std::optional<Script> script;
    if (!options.script.empty()) {
        Result<Script> read = Script::read(options.script);
        if (!read) return app::fail(options.script, read.error());
        script = std::move(*read);
    } else if (!options.screenshot.empty()) {
        script = Script::screenshot(options.screenshot);
    }
    std::error_code error;
    if (!options.viewer.shaders.empty() && !std::filesystem::is_directory(options.viewer.shaders, error)) {
        return app::fail(options.viewer.shaders.string(), {ErrorCode::cannot_open, "is not a folder"});
    }
    Result<std::unique_ptr<Window>> window = Window::create(options.size.width, options.size.height);
    if (!window) return app::fail("view", window.error());
    options.context.instance_extensions = (*window)->extensions();
    options.context.device_extensions = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
    // Hiding the window contacts the window system first: if its connection is lost, only that error is reported.
    const auto fail = [&](const std::string& on, const Error& what) {
        (*window)->hide();
        return app::fail(on, what);
    };
    const Result<std::unique_ptr<gpu::Context>> context = gpu::Context::create(options.context);
    if (!context) return fail("view", context.error());
    const Result<VkSurfaceKHR> surface = (*window)->surface((*context)->instance());
    if (!surface) return fail("view", surface.error());
    (*window)->limit_size((*context)->limits().maxImageDimension2D);
    options.viewer.scale = options.scale > 0 ? options.scale : (*window)->scale();
    options.viewer.panels = !options.no_panels;
    options.viewer.keep_recent = !script.has_value();
    if (!script) options.viewer.patience = 4;
    options.viewer.wake = Window::wake;
    const auto exit_code = [&](const std::string& failed_on, const Result<void>& done) {
        const std::size_t messages = app::print_validation(**context);
        if (!done) return fail(failed_on, done.error());
        return static_cast<int>(messages == 0 ? app::done : app::check_failed);
    };
    std::string failed_on = "view";
    const Result<void> done = [&]() -> Result<void> {
        Result<gpu::Swapchain> swapchain = gpu::Swapchain::create(**context, *surface);
        if (!swapchain) return swapchain.error();
        Result<std::unique_ptr<Viewer>> viewer = Viewer::create(**context, threads, options.viewer);
        if (!viewer) return viewer.error();
        Result<void> looped = loop(**viewer, **window, *swapchain, script ? &*script : nullptr);
        // Without a mesh, the screenshot has failed.
        if (looped && !options.screenshot.empty() && !(*viewer)->state().facts.document) {
            failed_on = "--screenshot";
            looped = Error{ErrorCode::malformed, (*viewer)->state().facts.error};
        }
        (*window)->hide();
        // The device must be idle before its objects are destroyed. If a thread still uses it after kPatience, end the
        // process without destroying anything.
        if (!(*viewer)->stop(kPatience)) leave(exit_code(failed_on, looped));
        return looped;
    }();
    vkDestroySurfaceKHR((*context)->instance(), *surface, nullptr);
    return exit_code(failed_on, done);
}

int start(int argc, char** argv, Threads& threads) {
    CLI::App program("open a window that shows a mesh, its ring and its formats");
    program.name("lacedring view");
    app::format_help(program);
    Options options;
    auto* mesh = program.add_option("MESH", options.viewer.input.path, "mesh file or .lr file");
    app::add_input_options(program, options.viewer.input.options, 250);
    options.viewer.input.options.materials = true;
    app::add_size(program, options.size);
    app::allow_numbers(
        program.add_option("--scale", options.scale, "enlarge the panels {} times; default: as the display asks"), 0.5,
        8);
    program.add_flag("--no-panels", options.no_panels, "hide the panels until Tab is pressed");
    app::allow_whole_numbers(
        program.add_option("--fps", options.viewer.frame_cap, "draw at most so many frames per second; 0: no limit"), 0,
        1000)
        ->capture_default_str();
    auto* screenshot =
        program.add_option("--screenshot", options.screenshot, "write a picture when everything is shown, and exit")
            ->type_name("FILE")
            ->needs(mesh);
    program.add_option("--script", options.script, "run the commands in FILE")->type_name("FILE")->excludes(screenshot);
    program
        .add_option("--shaders", options.viewer.shaders, "compile the shaders in FOLDER whenever one of them changes")
        ->type_name("FOLDER");
    app::add_camera(program, options.viewer.camera);
    app::add_device_options(program, options.context);
    app::add_example(program, "view bunny.ply", "viewer.md");
    app::OptionRules rules(program);
    rules.never_with({"--fps"}, "--screenshot");
    rules.forbid("--scale has no effect with --screenshot and --no-panels",
                 [&] { return options.scale > 0 && options.no_panels && !options.screenshot.empty(); });
    program.failure_message([](const CLI::App*, const CLI::Error& error) {
        return fmt::format("lacedring: {} (lacedring view --help lists the options)\n", error.what());
    });
    try {
        program.parse(argc, argv);
        rules.check();
    } catch (const CLI::ParseError& error) {
        return program.exit(error) == 0 ? app::done : app::wrong_usage;
    }
    return run(options, threads);
}

}  // namespace
}  // namespace lacedring::view

int main(int argc, char** argv) {
    lacedring::view::Threads threads;
    int code = lacedring::app::bad_input;
    try {
        code = lacedring::view::start(argc, argv, threads);
    } catch (const std::bad_alloc&) {
        std::fputs("lacedring: not enough memory\n", stderr);
    } catch (const std::exception& error) {  // a bug: our own code never throws
        lacedring::app::say("lacedring: internal error: {}\n", error.what());
    }
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
        std::fputs("lacedring: standard output: cannot be written\n", stderr);
        if (code == lacedring::app::done) code = lacedring::app::bad_input;
    }
    // Do not wait longer for threads that wait for a disk or compute: end the process.
    if (!threads.finish(lacedring::view::kPatience)) lacedring::view::leave(code);
    return code;
}
