// Left: what is opened and how it is shown.
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "app/view/panels.h"
#include "app/view/theme.h"

namespace lr::view {
namespace {

constexpr float kLabel = 92;  // nominal pixels before a field

void label(const char* text) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", text);
    ImGui::SameLine(px(kLabel));
    ImGui::SetNextItemWidth(-1);
}

template <class T, std::size_t N>
bool choose(const char* name, const std::array<std::pair<const char*, T>, N>& values, T& value) {
    const auto at = std::find_if(values.begin(), values.end(), [&](const auto& v) { return v.second == value; });
    bool changed = false;
    label(name);
    ImGui::PushID(name);
    if (ImGui::BeginCombo("##", at == values.end() ? "" : at->first)) {
        for (const auto& [text, v] : values) {
            if (ImGui::Selectable(text, v == value)) {
                value = v;
                changed = true;
            }
        }
        ImGui::EndCombo();
    }
    ImGui::PopID();
    return changed;
}

bool number(const char* name, std::uint32_t& value, int low, int high) {
    label(name);
    ImGui::PushID(name);
    int text = static_cast<int>(value);
    const bool changed = ImGui::InputInt("##", &text, 1, 10);
    ImGui::PopID();
    if (changed) value = static_cast<std::uint32_t>(std::clamp(text, low, high));
    return changed;
}

void list_files(State& state, const std::vector<std::string>& files) {
    for (const std::string& path : files) {
        const bool current = state.document && std::filesystem::path(state.document->path).filename() ==
                                                   std::filesystem::path(path).filename();
        ImGui::PushID(path.c_str());
        if (ImGui::Selectable(std::filesystem::path(path).filename().c_str(), current)) state.open = path;
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", path.c_str());
        ImGui::PopID();
    }
    if (files.empty()) ImGui::TextDisabled("none");
}

void draw_files(State& state) {
    if (!ImGui::BeginTabBar("files")) return;
    const ImVec2 size{0, std::max(px(80), ImGui::GetContentRegionAvail().y - px(6))};
    if (ImGui::BeginTabItem("Folder")) {
        ImGui::BeginChild("folder", size);
        list_files(state, state.files);
        ImGui::EndChild();
        ImGui::EndTabItem();
    }
    if (ImGui::BeginTabItem("Recent")) {
        ImGui::BeginChild("recent", size);
        list_files(state, state.recent);
        ImGui::EndChild();
        ImGui::EndTabItem();
    }
    ImGui::EndTabBar();
}

void swatch(unsigned r, unsigned g, unsigned b, const char* text) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float side = ImGui::GetTextLineHeight() - px(4);
    ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y + px(2)}, {at.x + side, at.y + px(2) + side}, rgba(r, g, b),
                                              px(2));
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + side + px(6));
    ImGui::TextDisabled("%s", text);
}

/// How the ring-expander is watched.
void draw_growth(State& state) {
    const double end = state.growth_end();
    label("Speed");
    auto speed = static_cast<float>(state.growth_speed);
    if (ImGui::SliderFloat("##speed", &speed, 1, 1e6F, "%.0f /s", ImGuiSliderFlags_Logarithmic)) {
        state.growth_speed = static_cast<double>(speed);
    }
    label("Invaded");
    auto invaded = static_cast<int>(std::min(state.growth, end));
    if (ImGui::SliderInt("##invaded", &invaded, 0, static_cast<int>(end))) {
        state.growing = false;
        state.growth = invaded;
    }
    if (ImGui::Button(state.growing ? "Pause" : "Grow")) {
        if (!state.growing && state.growth >= end) state.growth = 0;
        state.growing = !state.growing;
    }
    ImGui::SameLine();
    if (ImGui::Button("Step")) {
        state.growing = false;
        state.growth = std::min(std::floor(state.growth) + 1, end);
    }
    ImGui::SameLine();
    if (ImGui::Button("Restart")) state.growth = 0;
    const float column = px(138);
    swatch(LR_GROWTH_INVADED_COLOUR, "invaded");
    ImGui::SameLine(column);
    swatch(LR_GROWTH_NEWEST_COLOUR, "newest");
    swatch(LR_GROWTH_RIGHT_COLOUR, "never invaded");
    ImGui::SameLine(column);
    swatch(LR_GROWTH_NOT_YET_COLOUR, "not yet");
    swatch(LR_GROWTH_LINE_COLOUR, "ring");
    ImGui::SameLine(column);
    swatch(LR_GROWTH_FRONT_COLOUR, "front");
}

void draw_view(State& state) {
    heading("View");
    using gpu::View;
    constexpr std::array<std::pair<const char*, View>, 6> kViews{{{"smooth", View::smooth},
                                                                  {"flat", View::flat},
                                                                  {"triangle classes", View::triangle_class},
                                                                  {"ring order", View::ring},
                                                                  {"wireframe", View::wire},
                                                                  {"offsets", View::offsets}}};
    constexpr std::array<std::pair<const char*, Paint>, 4> kPaints{{{"none", Paint::none},
                                                                    {"corridors", Paint::corridors},
                                                                    {"blocks", Paint::blocks},
                                                                    {"ring-expander", Paint::growth}}};
    constexpr std::array<std::pair<const char*, Mode>, 3> kModes{
        {{"stream", Mode::single}, {"plain | stream", Mode::split}, {"difference", Mode::difference}}};
    constexpr std::array<std::pair<const char*, std::uint32_t>, 3> kSamples{{{"1", 1}, {"4", 2}, {"9", 3}}};
    Shown& shown = state.shown;
    bool changed = choose("Show", kViews, shown.view);
    if (choose("Colours", kPaints, state.paint)) {
        changed = true;
        if (state.paint == Paint::growth) {
            state.growth = 0;
            state.growing = true;
        }
    }
    if (state.paint == Paint::growth && state.document) draw_growth(state);
    changed |= choose("Picture", kModes, shown.mode);
    changed |= choose("Samples", kSamples, state.samples);
    constexpr std::array<std::pair<const char*, std::uint32_t>, 4> kCaps{
        {{"30 a second", 30}, {"60 a second", 60}, {"120 a second", 120}, {"no limit", 0}}};
    choose("Pictures", kCaps, state.frame_cap);
    state.choices_changed |= changed;
    ImGui::Checkbox("outlines", &state.outlines);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Silhouettes, borders and creases, asked of the LR tables");
    label("Turntable");
    auto speed = static_cast<float>(state.turntable_speed);
    ImGui::Checkbox("##turn", &state.turntable);
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderFloat("##degrees", &speed, -90, 90, "%.0f deg/s"))
        state.turntable_speed = static_cast<double>(speed);
}

void draw_stream(State& state) {
    heading("Stream");
    using gpu::Path;
    using gpu::Source;
    constexpr std::array<std::pair<const char*, Source>, 3> kSources{
        {{"index list", Source::plain}, {"lean", Source::lean}, {"packed", Source::packed}}};
    constexpr std::array<std::pair<const char*, Path>, 4> kAll{{{"compute", Path::compute},
                                                                {"vertex pulling", Path::pull},
                                                                {"geometry shader", Path::geometry},
                                                                {"mesh shader", Path::mesh}}};
    constexpr std::array<std::pair<const char*, Path>, 3> kThree{{kAll[0], kAll[1], kAll[2]}};
    Shown& shown = state.shown;
    bool changed = choose("Format", kSources, shown.source);
    changed |= state.mesh_shaders ? choose("Path", kAll, shown.path) : choose("Path", kThree, shown.path);
    if (shown.path == Path::compute) {
        ImGui::Checkbox("decode every frame", &shown.decode_again);
    }
    state.choices_changed |= changed;
}

void draw_ring(State& state) {
    heading("Ring");
    constexpr std::array<std::pair<const char*, bool>, 2> kRings{{{"ring-expander", false}, {"hybrid", true}}};
    RingSettings& ring = state.ring;
    choose("Made by", kRings, ring.hybrid);
    if (ring.hybrid) number("k", ring.k, 1, 1000000);
    number("Seeds", ring.seeds, 1, 10000);
    auto seed = static_cast<std::uint32_t>(ring.random_seed);
    if (number("First seed", seed, 0, 1000000)) ring.random_seed = seed;
    number("Passes", ring.passes, 0, 10000);
    ImGui::Checkbox("skip warts", &ring.warts);
}

}  // namespace

void draw_choices(State& state) {
    draw_view(state);
    draw_stream(state);
    draw_ring(state);
    ImGui::Dummy({0, px(4)});
    if (ImGui::Button("Screenshot")) state.screenshot = true;
    ImGui::SameLine();
    if (ImGui::Button("Turntable PNG")) state.turntable_pictures = true;
    ImGui::Dummy({0, px(4)});
    draw_files(state);
}

}  // namespace lr::view
