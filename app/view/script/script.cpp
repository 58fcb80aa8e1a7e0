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
#include "app/view/ui/settings.h"
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
    constexpr std::array<std::string_view, 3> kNames{"left", "right", "middle"};
    const auto at = std::ranges::find(kNames, name);
    if (at == kNames.end()) return std::nullopt;
    return static_cast<int>(at - kNames.begin());
}

/// Parses the words after the first one as numbers.
bool numbers(const std::vector<std::string>& words, std::initializer_list<double*> out) {
    std::size_t i = 1;
    for (double* number : out) {
        if (i >= words.size() || !parse(words[i++], *number)) return false;
    }
    return true;
}

bool is_count(double number, double low, double high) {
    return number >= low && number <= high && is_whole(number);
}

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
    while (events.empty() && !viewer.closing()) {
        if (frames_ > 0) {
            --frames_;
            return {};
        }
        if (at_ >= lines_.size()) {
            events.push_back({.kind = Event::close});  // the end of the script ends the viewer
            return {};
        }
        const Line& line = lines_[at_];
        if (waited_ == 0) waiting_since_ = std::chrono::steady_clock::now();
        const Result<bool> ran = run(line.words, {viewer, window, events});
        if (!ran) return Error{ran.error().code, fmt::format("{}:{}: {}", name_, line.number, ran.error().message)};
        if (!*ran) {
            ++waited_;
            const double waited =
                std::chrono::duration<double>(std::chrono::steady_clock::now() - waiting_since_).count();
            if (waited > kPatience) return wrong(fmt::format("{}:{}: waited too long", name_, line.number));
            return {};
        }
        waited_ = seen_ = 0;
        ++at_;
    }
    return {};
}

const std::vector<Script::Command>& Script::commands() {
    constexpr std::size_t kAny = SIZE_MAX;
    static const std::vector<Command> kCommands{
        {"open", "open PATH", 1, 1, &Script::open},
        {"drop", "drop PATH...", 1, kAny, &Script::open},
        {"move", "move X Y", 2, 2, &Script::move},
        {"click", "click X Y [left|right|middle]", 2, 3, &Script::click},
        {"press", "press X Y [left|right|middle]", 2, 3, &Script::click},
        {"release", "release X Y [left|right|middle]", 2, 3, &Script::click},
        {"drag", "drag X Y X Y [left|right|middle]", 4, 5, &Script::drag},
        {"scroll", "scroll X Y STEPS", 3, 3, &Script::scroll},
        {"key", "key NAME [shift] [control]", 1, 3, &Script::key},
        {"resize", "resize W H", 2, 2, &Script::resize},
        {"minimize", "minimize", 0, 0, &Script::minimize},
        {"restore", "restore", 0, 0, &Script::minimize},
        {"close", "close", 0, 0, &Script::close},
        {"set", "set NAME VALUE", 2, 2, &Script::set},
        {"camera", "camera OPTIONS", 0, kAny, &Script::camera},
        {"frames", "frames N", 1, 1, &Script::frames},
        {"wait", "wait mesh|settled|optimized|tables|formats|ready|shaders|error", 1, 1, &Script::wait},
        {"copy", "copy FROM TO", 2, 2, &Script::copy},
        {"screenshot", "screenshot FILE [now]", 1, 2, &Script::save},
        {"turntable-png", "turntable-png FOLDER [PICTURES]", 1, 2, &Script::save_turn},
        {"print", "print", 0, 0, &Script::print},
        {"ray", "ray X Y", 2, 2, &Script::ray},
    };
    return kCommands;
}

Result<bool> Script::run(const Words& words, const Stage& stage) {
    const auto command = std::ranges::find(commands(), words[0], &Command::name);
    if (command == commands().end()) return wrong("no such line: " + words[0]);
    if (words.size() - 1 < command->least || words.size() - 1 > command->most) return wrong(command->usage);
    Result<bool> done = (this->*command->run)(words, stage);
    if (!done && done.error().message.empty()) return wrong(command->usage);
    return done;
}

namespace {

/// An error whose message is the command's usage.
Error misused() {
    return wrong("");
}

Result<bool> performed(Viewer& viewer, const Action& action) {
    if (const Result<void> done = viewer.perform(action); !done) return done.error();
    return true;
}

}  // namespace

Result<bool> Script::open(const Words& words, const Stage& stage) {
    return performed(stage.viewer, action::Open{{words.begin() + 1, words.end()}});
}

Result<bool> Script::move(const Words& words, const Stage& stage) {
    double x = 0, y = 0;
    if (!numbers(words, {&x, &y})) return misused();
    stage.events.push_back({.kind = Event::move, .x = x, .y = y});
    return true;
}

Result<bool> Script::click(const Words& words, const Stage& stage) {
    double x = 0, y = 0;
    const auto button = button_named(words.size() > 3 ? words[3] : "left");
    if (!numbers(words, {&x, &y}) || !button) return misused();
    stage.events.push_back({.kind = Event::move, .x = x, .y = y});
    for (const bool down : {true, false}) {
        if (words[0] == (down ? "release" : "press")) continue;
        stage.events.push_back({.kind = Event::button, .code = *button, .down = down, .x = x, .y = y});
    }
    return true;
}

Result<bool> Script::drag(const Words& words, const Stage& stage) {
    double x = 0, y = 0, x2 = 0, y2 = 0;
    const auto button = button_named(words.size() > 5 ? words[5] : "left");
    if (!numbers(words, {&x, &y, &x2, &y2}) || !button) return misused();
    stage.events.push_back({.kind = Event::move, .x = x, .y = y});
    stage.events.push_back({.kind = Event::button, .code = *button, .down = true, .x = x, .y = y});
    constexpr int kSteps = 8;
    for (int i = 1; i <= kSteps; ++i) {
        stage.events.push_back({.kind = Event::move, .x = x + (x2 - x) * i / kSteps, .y = y + (y2 - y) * i / kSteps});
    }
    stage.events.push_back({.kind = Event::button, .code = *button, .down = false, .x = x2, .y = y2});
    return true;
}

Result<bool> Script::scroll(const Words& words, const Stage& stage) {
    double x = 0, y = 0, steps = 0;
    if (!numbers(words, {&x, &y, &steps})) return misused();
    stage.events.push_back({.kind = Event::move, .x = x, .y = y});
    stage.events.push_back({.kind = Event::scroll, .y = steps});
    return true;
}

Result<bool> Script::key(const Words& words, const Stage& stage) {
    const auto code = key_named(words[1]);
    if (!code) return misused();
    unsigned modifiers = 0;
    for (std::size_t i = 2; i < words.size(); ++i) {
        if (words[i] != "shift" && words[i] != "control") return misused();
        modifiers |= words[i] == "shift" ? mod_shift : mod_control;
    }
    stage.events.push_back({.kind = Event::key, .code = *code, .down = true, .modifiers = modifiers});
    stage.events.push_back({.kind = Event::key, .code = *code, .down = false});
    return true;
}

Result<bool> Script::resize(const Words& words, const Stage& stage) {
    constexpr double kMost = 32767;  // limit of X
    double x = 0, y = 0;
    if (!numbers(words, {&x, &y}) || !is_count(x, 1, kMost) || !is_count(y, 1, kMost)) return misused();
    const auto width = static_cast<std::uint32_t>(x), height = static_cast<std::uint32_t>(y);
    if (waited_ == 0) stage.window.set_size(width, height);
    // The window system may refuse the size: wait for at most a second.
    return (stage.viewer.window().width == width && stage.viewer.window().height == height) || waited_ > 60;
}

Result<bool> Script::minimize(const Words& words, const Stage& stage) {
    const bool gone = words[0] == "minimize";
    stage.window.minimize(gone);
    const VkExtent2D extent = gone ? VkExtent2D{} : stage.window.extent();
    stage.events.push_back({.kind = Event::resize, .x = double(extent.width), .y = double(extent.height)});
    return true;
}

Result<bool> Script::close(const Words&, const Stage& stage) {
    return performed(stage.viewer, action::Do::close);
}

Result<bool> Script::set(const Words& words, const Stage& stage) {
    const Result<Action> action = parse_setting(words[1], words[2]);
    if (!action) return action.error();
    return performed(stage.viewer, *action);
}

Result<bool> Script::camera(const Words& words, const Stage& stage) {
    LR_ASSIGN(const gpu::CameraOptions camera, app::parse_camera({words.begin() + 1, words.end()}));
    if (!stage.viewer.state().facts.document) return wrong("there is no mesh to look at yet: wait mesh");
    return performed(stage.viewer, action::FrameAll{camera});
}

Result<bool> Script::frames(const Words& words, const Stage&) {
    double count = 0;
    if (!numbers(words, {&count}) || !is_count(count, 0, 1e6)) return misused();
    frames_ = static_cast<int>(count);
    return true;
}

Result<bool> Script::wait(const Words& words, const Stage& stage) {
    const std::string& what = words[1];
    const Facts& facts = stage.viewer.state().facts;
    const std::shared_ptr<const Document>& document = facts.document;
    const bool settled = stage.viewer.settled();
    const bool failed = !facts.error.empty() && !facts.progress.busy;
    // Changes by earlier lines are visible from the next frame on.
    const bool changing = what == "settled" || what == "optimized" || what == "ready";
    if (changing && waited_ < 2) return false;
    if (what == "mesh") return (document && document->stand_in == 0) || failed;
    if (what == "settled") return settled || failed || (!facts.progress.busy && !document);
    if (what == "optimized") return (document && document->optimized && settled) || failed;
    if (what == "tables") return facts.tables != nullptr || failed;
    if (what == "formats") return facts.formats != nullptr || failed;
    if (what == "ready") return (document && document->optimized && facts.formats && settled) || failed;
    // The notice is on the screen two frames after the error.
    if (what == "error") return !facts.error.empty() && ++seen_ > 3;
    if (what == "shaders") {
        if (stage.viewer.shaders() == nullptr) return wrong("no shader sources to wait for");
        if (waited_ == 0) check_ = stage.viewer.shaders()->next_check();
        return facts.shaders.checks >= check_;
    }
    return misused();
}

Result<bool> Script::copy(const Words& words, const Stage&) {
    std::error_code error;
    if (!std::filesystem::copy_file(words[1], words[2], std::filesystem::copy_options::overwrite_existing, error)) {
        return Error{ErrorCode::cannot_write, words[2] + ": " + error.message()};
    }
    return true;
}

Result<bool> Script::settle(const Viewer& viewer) const {
    if (waited_ >= 2 && viewer.settled()) return true;
    return waited_ > 600 ? wrong("the picture does not settle") : Result<bool>(false);
}

Result<bool> Script::save(const Words& words, const Stage& stage) {
    const bool now = words.size() == 3;
    if (now && words[2] != "now") return misused();
    const bool empty = waited_ >= 2 && !stage.viewer.state().facts.document;
    if (!now && !empty) {
        if (const Result<bool> there = settle(stage.viewer); !there || !*there) return there;
    }
    return performed(stage.viewer, action::SavePicture{words[1], now});
}

Result<bool> Script::save_turn(const Words& words, const Stage& stage) {
    double pictures = 90;
    if (words.size() > 2 && (!parse(words[2], pictures) || pictures < 1 || pictures > 1e6)) return misused();
    Viewer& viewer = stage.viewer;
    std::string& error = viewer.state().facts.error;
    if (viewer.turning()) return false;
    if (std::exchange(turning_, false)) {
        return error.empty() ? Result<bool>(true) : Error{ErrorCode::cannot_write, error};
    }
    if (const Result<bool> there = settle(viewer); !there || !*there) return there;
    error.clear();
    LR_TRY(viewer.perform(action::SaveTurn{words[1], static_cast<std::uint32_t>(pictures)}));
    turning_ = true;
    return false;
}

Result<bool> Script::print(const Words&, const Stage& stage) {
    app::print("{}\n", state_text(stage.viewer));
    stage.viewer.state().facts.longest_frame = 0;
    std::fflush(stdout);
    return true;
}

/// Prints the triangle that a ray through the pixel hits, found by testing all triangles.
Result<bool> Script::ray(const Words& words, const Stage& stage) {
    double x = 0, y = 0;
    if (!numbers(words, {&x, &y})) return misused();
    const Facts& facts = stage.viewer.state().facts;
    std::int64_t hit = -1;
    if (facts.document) {
        const auto found = ray_hit(*facts.document, stage.viewer.orbit().eye(), stage.viewer.ray(x, y));
        if (found) hit = *found;
    }
    const std::int64_t selected = facts.selection.any() ? std::int64_t{triangle(facts.selection.corner).value} : -1;
    app::print("{}\n", nlohmann::ordered_json{{"ray", hit}, {"selected", selected}}.dump());
    return true;
}

}  // namespace lacedring::view
