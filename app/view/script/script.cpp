#include "app/view/script/script.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/cli/camera_options.h"
#include "app/cli/print.h"
#include "lacedring/file.hpp"
#include "renderer/vk/try.h"

namespace lacedring::view {
namespace {

constexpr double kPatience = 300;  // seconds that a line may wait

Error wrong(const std::string& why) {
    return {ErrorCode::invalid_argument, why};
}

bool parse(const std::string& text, double& out) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
    return error == std::errc() && end == text.data() + text.size() && std::isfinite(out);
}

bool is_whole(double number) {
    return number == std::floor(number);
}

std::optional<int> key_named(const std::string& name) {
    static const std::map<std::string, int> kNames{
        {"escape", key_escape}, {"enter", key_enter}, {"tab", key_tab},
        {"home", key_home},     {"end", key_end},     {"left", key_left},
        {"right", key_right},   {"up", key_up},       {"down", key_down},
        {"delete", key_delete}, {"f1", key_f1},       {"f5", key_f5},
        {"f12", key_f12},       {"?", '/'},           {"backspace", key_backspace}};
    if (const auto at = kNames.find(name); at != kNames.end()) return at->second;
    if (name.size() != 1) return std::nullopt;
    const auto c = static_cast<unsigned char>(name[0]);
    return std::isalnum(c) != 0 || c == '.' ? std::optional(std::toupper(c)) : std::nullopt;
}

std::optional<int> button_named(const std::string& name) {
    if (name == "left") return 0;
    if (name == "right") return 1;
    if (name == "middle") return 2;
    return std::nullopt;
}

/// `set NAME on|off`
struct Switch {
    const char* name;
    void (*set)(State& state, bool on);
};
constexpr std::array<Switch, 8> kSwitches{
    {{"warts", [](State& state, bool on) { state.ring.warts = on; }},
     {"panels", [](State& state, bool on) { state.panels = on; }},
     {"outlines", [](State& state, bool on) { state.outlines = on; }},
     {"help", [](State& state, bool on) { state.help = on; }},
     {"turntable", [](State& state, bool on) { state.turntable = on; }},
     {"choices", [](State& state, bool on) { state.drawer = on ? Drawer::choices : Drawer::none; }},
     {"numbers", [](State& state, bool on) { state.drawer = on ? Drawer::numbers : Drawer::none; }},
     {"decode", [](State& state, bool on) { state.shown.decode_again = on; }}}};

/// `set NAME NUMBER`: what the panels take, so that they show it.
struct NumberSetting {
    const char* name;
    double low, high;
    bool whole;
    void (*set)(State& state, double number);
};
constexpr std::array<NumberSetting, 9> kNumbers{
    {{"samples", 1, 3, true, [](State& state, double n) { state.samples = static_cast<std::uint32_t>(n); }},
     {"divider", 0, 1, false, [](State& state, double n) { state.divider = n; }},
     {"k", 1, 1e6, true, [](State& state, double n) { state.ring.k = static_cast<std::uint32_t>(n); }},
     {"seeds", 1, 1e4, true, [](State& state, double n) { state.ring.seeds = static_cast<std::uint32_t>(n); }},
     {"seed", 0, 1e6, true, [](State& state, double n) { state.ring.random_seed = static_cast<std::uint64_t>(n); }},
     {"passes", 0, 1e4, true, [](State& state, double n) { state.ring.passes = static_cast<std::uint32_t>(n); }},
     {"growth", 0, 4e9, true, [](State& state, double n) { state.growth = n; }},
     {"speed", 1, 1e6, false, [](State& state, double n) { state.growth_speed = n; }},
     {"fps", 0, 1000, true, [](State& state, double n) { state.frame_cap = static_cast<std::uint32_t>(n); }}}};

}  // namespace

Result<Script> Script::read(const std::filesystem::path& path) {
    constexpr std::uint64_t kMost = std::uint64_t{64} << 20;
    const bool standard_input = path == "-";
    LR_ASSIGN(const std::vector<std::byte> bytes,
              standard_input ? read_descriptor(STDIN_FILENO, kMost) : read_file(path, kMost));
    std::istringstream file(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    Script out;
    out.name_ = standard_input ? "standard input" : path.string();
    std::size_t number = 0;
    for (std::string text; std::getline(file, text);) {
        ++number;
        std::istringstream words(text);
        Line line{number, {}};
        for (std::string word; words >> word;) {
            if (word[0] == '#') break;
            line.words.push_back(word);
        }
        if (!line.words.empty()) out.lines_.push_back(std::move(line));
    }
    return out;
}

Script Script::screenshot(const std::string& path) {
    Script out;
    out.name_ = "--screenshot";
    out.lines_ = {{1, {"wait", "ready"}}, {2, {"screenshot", path}}, {3, {"close"}}};
    return out;
}

Result<void> Script::advance(Viewer& viewer, Window& window, std::deque<Event>& events) {
    while (events.empty()) {
        if (frames_ > 0) {
            --frames_;
            return {};
        }
        if (at_ >= lines_.size()) {
            events.push_back({.kind = Event::close});  // nobody else could
            return {};
        }
        const Line& line = lines_[at_];
        if (waited_ == 0) waiting_since_ = std::chrono::steady_clock::now();
        const Result<bool> ran = run(line, viewer, window, events);
        if (!ran) return Error{ran.error().code, fmt::format("{}:{}: {}", name_, line.number, ran.error().message)};
        if (!*ran) {
            ++waited_;
            const double waited =
                std::chrono::duration<double>(std::chrono::steady_clock::now() - waiting_since_).count();
            if (waited > kPatience) return wrong(fmt::format("{}:{}: waited too long", name_, line.number));
            return {};
        }
        waited_ = 0;
        ++at_;
    }
    return {};
}

Result<bool> Script::wait(const Line& line, Viewer& viewer) {
    const std::string what = line.words.size() == 2 ? line.words[1] : "";
    const State& state = viewer.state();
    const bool failed = !state.error.empty() && !state.progress.busy && !state.open;
    // What lines before this one changed shows in the next frame.
    const bool changing = what == "settled" || what == "optimised" || what == "ready";
    if (changing && waited_ < 2) return false;
    if (what == "mesh") return state.document != nullptr || failed;
    if (what == "settled")
        return viewer.settled() || failed || (!state.progress.busy && !state.document && !state.open);
    if (what == "optimised") return (state.document && state.document->optimised && viewer.settled()) || failed;
    if (what == "tables") return state.tables != nullptr || failed;
    if (what == "formats") return state.formats != nullptr || failed;
    if (what == "ready")
        return (state.document && state.document->optimised && state.formats && viewer.settled()) || failed;
    if (what == "error") return !state.error.empty();
    if (what == "shaders") {
        if (viewer.shaders() == nullptr) return wrong("no sources of shaders to wait for");
        if (waited_ == 0) look_ = viewer.shaders()->next_look();
        return state.shaders.looks >= look_;
    }
    return wrong("wait what: mesh, settled, optimised, tables, formats, ready, shaders, error");
}

Result<bool> Script::set(const Line& line, Viewer& viewer) {
    if (line.words.size() != 3) return wrong("set NAME VALUE");
    const std::string &name = line.words[1], &value = line.words[2];
    State& state = viewer.state();
    state.choices_changed = true;
    const auto named = [&](const auto& table, auto& out) -> Result<bool> {
        const auto found = gpu::find_named(table, value);
        if (!found) return wrong("no such " + name + ": " + value);
        out = *found;
        return true;
    };
    if (name == "view") {
        // It needs LR tables, which come later than the surface, and goes with every view.
        if (value == "silhouette") return wrong("the viewer has no view silhouette: set outlines on");
        return named(kViews, state.shown.view);
    }
    if (name == "mode") return named(kModes, state.shown.mode);
    if (name == "source") return named(kSources, state.shown.source);
    if (name == "path") {
        if (value == "mesh" && !state.mesh_shaders) return wrong("the device has no mesh shaders: " + state.device);
        return named(gpu::kPaths, state.shown.path);
    }
    if (name == "paint") return named(kPaints, state.paint);
    if (name == "ring") return named(kRings, state.ring.hybrid);
    for (const Switch& one : kSwitches) {
        if (name != one.name) continue;
        if (value != "on" && value != "off") return wrong(name + " is on or off");
        one.set(state, value == "on");
        return true;
    }
    for (const NumberSetting& one : kNumbers) {
        if (name != one.name) continue;
        double number = 0;
        if (!parse(value, number) || number < one.low || number > one.high || (one.whole && !is_whole(number))) {
            return wrong(
                fmt::format("{} is a {}number from {} to {}", name, one.whole ? "whole " : "", one.low, one.high));
        }
        one.set(state, number);
        return true;
    }
    return wrong("nothing is called " + name);
}

Result<bool> Script::run(const Line& line, Viewer& viewer, Window& window, std::deque<Event>& events) {
    const std::vector<std::string>& words = line.words;
    const std::string& what = words[0];
    const auto number = [&](std::size_t i, double& out) { return i < words.size() && parse(words[i], out); };
    const auto alone = [&] { return words.size() == 1; };
    double x = 0, y = 0, x2 = 0, y2 = 0;
    State& state = viewer.state();
    if (what == "wait") return wait(line, viewer);
    if (what == "set") return set(line, viewer);
    if (what == "open" || what == "drop") {
        if (words.size() < 2 || (what == "open" && words.size() > 2)) {
            return wrong(what == "open" ? "open PATH" : "drop PATH...");
        }
        events.push_back({.kind = Event::drop, .paths = {words.begin() + 1, words.end()}});
    } else if (what == "move") {
        if (words.size() != 3 || !number(1, x) || !number(2, y)) return wrong("move X Y");
        events.push_back({.kind = Event::move, .x = x, .y = y});
    } else if (what == "click" || what == "press" || what == "release") {
        if (words.size() > 4 || !number(1, x) || !number(2, y)) return wrong(what + " X Y [left|right|middle]");
        const auto button = button_named(words.size() > 3 ? words[3] : "left");
        if (!button) return wrong("a button is left, right or middle");
        events.push_back({.kind = Event::move, .x = x, .y = y});
        if (what != "release") events.push_back({.kind = Event::button, .code = *button, .down = true, .x = x, .y = y});
        if (what != "press") events.push_back({.kind = Event::button, .code = *button, .down = false, .x = x, .y = y});
    } else if (what == "drag") {
        if (words.size() > 6 || !number(1, x) || !number(2, y) || !number(3, x2) || !number(4, y2)) {
            return wrong("drag X Y X Y [BUTTON]");
        }
        const auto button = button_named(words.size() > 5 ? words[5] : "left");
        if (!button) return wrong("a button is left, right or middle");
        events.push_back({.kind = Event::move, .x = x, .y = y});
        events.push_back({.kind = Event::button, .code = *button, .down = true, .x = x, .y = y});
        constexpr int kSteps = 8;
        for (int i = 1; i <= kSteps; ++i) {
            events.push_back({.kind = Event::move, .x = x + (x2 - x) * i / kSteps, .y = y + (y2 - y) * i / kSteps});
        }
        events.push_back({.kind = Event::button, .code = *button, .down = false, .x = x2, .y = y2});
    } else if (what == "scroll") {
        if (words.size() != 4 || !number(1, x) || !number(2, y) || !number(3, y2)) return wrong("scroll X Y STEPS");
        events.push_back({.kind = Event::move, .x = x, .y = y});
        events.push_back({.kind = Event::scroll, .y = y2});
    } else if (what == "key") {
        const auto code = words.size() > 1 ? key_named(words[1]) : std::nullopt;
        if (!code) return wrong("key NAME [shift] [control]");
        unsigned modifiers = 0;
        for (std::size_t i = 2; i < words.size(); ++i) {
            if (words[i] != "shift" && words[i] != "control") return wrong("key NAME [shift] [control]");
            modifiers |= words[i] == "shift" ? mod_shift : mod_control;
        }
        events.push_back({.kind = Event::key, .code = *code, .down = true, .modifiers = modifiers});
        events.push_back({.kind = Event::key, .code = *code, .down = false});
    } else if (what == "resize") {
        constexpr double kMost = 32767;  // X's
        const auto fits = [](double n) { return n >= 1 && n <= kMost && is_whole(n); };
        if (words.size() != 3 || !number(1, x) || !number(2, y) || !fits(x) || !fits(y)) return wrong("resize W H");
        if (waited_ == 0) window.set_size(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
        // The window system decides; a second is enough for it to.
        if (viewer.window().width == static_cast<std::uint32_t>(x) &&
            viewer.window().height == static_cast<std::uint32_t>(y)) {
            return true;
        }
        return waited_ > 60;
    } else if (what == "minimise" && alone()) {
        window.minimise(true);
        events.push_back({.kind = Event::resize});
    } else if (what == "restore" && alone()) {
        window.minimise(false);
        const VkExtent2D extent = window.extent();
        events.push_back({.kind = Event::resize, .x = double(extent.width), .y = double(extent.height)});
    } else if (what == "close" && alone()) {
        events.push_back({.kind = Event::close});
    } else if (what == "frames") {
        constexpr double kMost = 1e6;
        if (words.size() != 2 || !number(1, x) || x < 0 || x > kMost || !is_whole(x)) return wrong("frames N");
        frames_ = static_cast<int>(x);
    } else if (what == "camera") {
        Result<gpu::CameraOptions> camera = app::parse_camera({words.begin() + 1, words.end()});
        if (!camera) return camera.error();
        if (!state.document) return wrong("there is no mesh to look at yet: wait mesh");
        if (const Result<void> framed = viewer.frame_all(*camera); !framed) return framed.error();
    } else if (what == "screenshot") {
        const bool now = words.size() == 3 && words[2] == "now";
        if (words.size() != 2 && !now) return wrong("screenshot FILE [now]");
        if (!now && (waited_ < 2 || !viewer.settled())) {
            // What was changed must be drawn, and settle, first.
            if (waited_ < 2 || state.document)
                return waited_ > 600 ? wrong("nothing settles: no screenshot") : Result<bool>(false);
        }
        const Result<gpu::Picture> picture = now ? viewer.window_picture() : viewer.picture();
        if (!picture) return picture.error();
        if (const Result<void> written = gpu::write_png(words[1], *picture); !written) {
            return Error{written.error().code, words[1] + ": " + written.error().message};
        }
    } else if (what == "turntable-png") {
        double pictures = 90;
        if (words.size() < 2 || words.size() > 3 || (words.size() == 3 && !number(2, pictures)) || pictures < 1 ||
            pictures > 1e6) {
            return wrong("turntable-png FOLDER [PICTURES]");
        }
        if (state.turntable_job) return false;
        if (turning_) {
            turning_ = false;
            if (!state.error.empty()) return Error{ErrorCode::cannot_write, state.error};
            return true;
        }
        if (waited_ < 2 || !viewer.settled()) return waited_ > 600 ? wrong("nothing settles") : Result<bool>(false);
        state.error.clear();
        if (const Result<void> begun = viewer.start_turntable(words[1], static_cast<std::uint32_t>(pictures)); !begun) {
            return Error{begun.error().code, words[1] + ": " + begun.error().message};
        }
        turning_ = true;
        return false;
    } else if (what == "ray") {
        // The triangle that a ray through the pixel hits, by looking at all of them.
        if (words.size() != 3 || !number(1, x) || !number(2, y)) return wrong("ray X Y");
        std::int64_t hit = -1;
        if (state.document) {
            const auto found = ray_hit(*state.document, viewer.orbit().eye(), viewer.ray(x, y));
            if (found) hit = *found;
        }
        const std::int64_t selected = state.selection.any() ? std::int64_t{triangle(state.selection.corner).value} : -1;
        app::print("{}\n", nlohmann::ordered_json{{"ray", hit}, {"selected", selected}}.dump());
    } else if (what == "copy") {
        if (words.size() != 3) return wrong("copy FROM TO");
        std::error_code error;
        if (!std::filesystem::copy_file(words[1], words[2], std::filesystem::copy_options::overwrite_existing, error)) {
            return Error{ErrorCode::cannot_write, words[2] + ": " + error.message()};
        }
    } else if (what == "print" && alone()) {
        app::print("{}\n", state_text(viewer));
        state.longest_frame = 0;
        std::fflush(stdout);
    } else {
        for (const char* known : {"minimise", "restore", "close", "print"}) {
            if (what == known) return wrong(what + " stands alone");
        }
        return wrong("no such line: " + what);
    }
    return true;
}

}  // namespace lacedring::view
