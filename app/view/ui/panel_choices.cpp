// The left panel: which file is open, and how it is shown.
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "app/view/ui/panels.h"
#include "app/view/ui/settings.h"
#include "app/view/window/theme.h"

namespace lacedring::view {
namespace {

constexpr float kLabel = 104;  // width of a label in nominal pixels

void label(const char* text, const char* explained) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", text);
    explain(explained);
    ImGui::SameLine(px(kLabel));
    ImGui::SetNextItemWidth(-1);
}

/// Draws a list of a setting's values. `other`: text for a value that is not in the list.
void choose(State& state, const char* name, const char* title, const char* explained, const char* other = "") {
    const Setting& setting = *find_setting(name);
    const double now = setting.get(state.choices);
    const auto at = std::ranges::find(setting.values, now, &NamedValue::value);
    label(title, explained);
    ImGui::PushID(name);
    if (ImGui::BeginCombo("##", at == setting.values.end() ? other : at->label)) {
        for (const NamedValue& value : setting.values) {
            const bool offered = state.facts.mesh_shaders || std::string_view(value.name) != "mesh";
            if (offered && ImGui::Selectable(value.label, value.value == now)) state.ask(set(name, value.value));
        }
        ImGui::EndCombo();
    }
    ImGui::PopID();
}

/// Draws a list of some values of a setting that is a number.
template <std::size_t N>
void choose_number(State& state, const char* name, const char* title, const std::pair<const char*, int> (&values)[N],
                   const char* explained) {
    const auto now = static_cast<int>(find_setting(name)->get(state.choices));
    const auto at = std::ranges::find(values, now, &std::pair<const char*, int>::second);
    label(title, explained);
    ImGui::PushID(name);
    if (ImGui::BeginCombo("##", at == std::end(values) ? std::to_string(now).c_str() : at->first)) {
        for (const auto& [text, value] : values) {
            if (ImGui::Selectable(text, value == now)) state.ask(set(name, value));
        }
        ImGui::EndCombo();
    }
    ImGui::PopID();
}

void number(State& state, const char* name, const char* title, const char* explained) {
    const Setting& setting = *find_setting(name);
    label(title, explained);
    ImGui::PushID(name);
    int value = static_cast<int>(setting.get(state.choices));
    if (ImGui::InputInt("##", &value, 1, 10)) {
        state.ask(set(name, std::clamp(static_cast<double>(value), setting.low, setting.high)));
    }
    ImGui::PopID();
}

void check(State& state, const char* name, const char* title, const char* explained) {
    bool on = find_setting(name)->get(state.choices) != 0;
    ImGui::PushID(name);
    if (ImGui::Checkbox(title, &on)) state.ask(toggle(state.choices, name));
    ImGui::PopID();
    explain(explained);
}

/// Draws a slider. `end` replaces the setting's largest value.
void slide(State& state, const char* name, double end, const char* format, ImGuiSliderFlags flags = 0) {
    const Setting& setting = *find_setting(name);
    auto value = static_cast<float>(std::min(setting.get(state.choices), end));
    ImGui::PushID(name);
    const auto low = static_cast<float>(std::max(setting.low, -std::abs(end)));
    if (ImGui::SliderFloat("##", &value, low, static_cast<float>(end), format, flags)) {
        state.ask(set(name, setting.whole ? std::round(static_cast<double>(value)) : static_cast<double>(value)));
    }
    ImGui::PopID();
}

/// Scrolls to the last item, once per path.
void show_once(const std::string& path) {
    ImGuiStorage& storage = *ImGui::GetStateStorage();
    const int now = static_cast<int>(std::hash<std::string>()(path));
    if (storage.GetInt(ImGui::GetID("shown")) == now) return;
    storage.SetInt(ImGui::GetID("shown"), now);
    ImGui::SetScrollHereY();
}

void list_files(State& state, const std::vector<std::string>& files, const char* none) {
    for (const std::string& path : files) {
        const bool current = state.facts.document && std::filesystem::path(state.facts.document->path).filename() ==
                                                         std::filesystem::path(path).filename();
        ImGui::PushID(path.c_str());
        const std::string name = std::filesystem::path(path).filename().string();
        if (ImGui::Selectable(elided(name, ImGui::GetContentRegionAvail().x).c_str(), current))
            state.ask(action::Open{{path}});
        if (current) show_once(state.facts.document->path);
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", broken(path, px(320)).c_str());
        ImGui::PopID();
    }
    if (files.empty()) ImGui::TextDisabled("%s", none);
}

void draw_files(State& state) {
    if (!ImGui::BeginTabBar("files")) return;
    // A whole number of lines, and at least three even in a low window.
    const float line = ImGui::GetTextLineHeightWithSpacing();
    const float room = ImGui::GetContentRegionAvail().y - ImGui::GetStyle().ItemSpacing.y;
    const ImVec2 size{0, line * std::max(3.0F, std::floor(room / line))};
    if (ImGui::BeginTabItem("Folder")) {
        ImGui::BeginChild("folder", size);
        list_files(state, state.facts.files, "no meshes in this folder");
        if (state.facts.files.empty() && !state.facts.sample_files.empty()) {
            ImGui::TextDisabled("samples:");
            list_files(state, state.facts.sample_files, "");
        }
        ImGui::EndChild();
        ImGui::EndTabItem();
    }
    if (ImGui::BeginTabItem("Recent")) {
        ImGui::BeginChild("recent", size);
        list_files(state, state.facts.recent, "none yet");
        ImGui::EndChild();
        ImGui::EndTabItem();
    }
    ImGui::EndTabBar();
}

/// Draws the controls for watching the ring-expander.
void draw_growth(State& state) {
    const double end = state.facts.growth_end(), at = state.choices.growth;
    label("Speed", "Triangles per second");
    slide(state, "speed", 1e6, "%.0f /s", ImGuiSliderFlags_Logarithmic);
    label("Invaded", "Triangles so far");
    slide(state, "growth", end, "%.0f");
    const bool growing = state.choices.growing;
    if (ImGui::Button(growing ? "Pause" : "Grow")) {
        if (!growing && at >= end) state.ask(set("growth", 0.0));
        state.ask(toggle(state.choices, "growing"));
    }
    ImGui::SameLine();
    if (ImGui::Button("Step")) state.ask(set("growth", std::min(std::floor(at) + 1, end)));
    ImGui::SameLine();
    if (ImGui::Button("Restart")) {
        state.ask(set("growth", 0.0));
        state.ask(set("growing", growing ? "on" : "off"));
    }
}

void draw_view(State& state) {
    heading("View");
    choose(state, "view", "Show",
           "How the surface is drawn. Material: with the file's materials. Triangle classes: T0, T1 and T2 have zero, "
           "one and two edges on the ring. Ring order: place of the vertices along the ring. Offsets: distance along "
           "the ring from a triangle's ring edge to its tip. Seams: edges at which normals, texture coordinates or "
           "other attributes change. Silhouette: with outlines");
    choose(state, "paint", "Colors",
           "Colors over the surface. Corridors: runs of triangles between two parts of the ring. Blocks: parts of the "
           "packed stream that decode on their own. Ring-expander: shows how the ring is found, triangle by triangle");
    if (state.choices.paint == Paint::growth && state.facts.document) draw_growth(state);
    check(state, "ring-line", "ring", "Draws the ring over the surface. Key E");
    ImGui::SameLine(px(kLabel));
    check(state, "outlines", "outlines", "Silhouettes, borders and creases, found with the LR tables");
    choose(state, "mode", "Compare",
           "The same picture from the index list and from the stream: side by side, or red where they differ");
    constexpr std::pair<const char*, int> kSamples[] = {{"1", 1}, {"4", 2}, {"9", 3}};
    choose_number(state, "samples", "Samples", kSamples,
                  "Samples of each pixel, once nothing moves. More samples make edges smoother and take longer. Fewer "
                  "are drawn in a very large window, or if drawing would take longer than four seconds");
    const std::uint32_t drawn = state.facts.samples;
    if (drawn != 0 && drawn < state.choices.shown.samples) {
        ImGui::SetCursorPosX(px(kLabel));
        ImGui::TextDisabled("%u drawn", drawn * drawn);
    }
    constexpr std::pair<const char*, int> kCaps[] = {
        {"30 per second", 30}, {"60 per second", 60}, {"120 per second", 120}, {"no limit", 0}};
    choose_number(state, "fps", "Pictures", kCaps, "Most pictures per second while something moves");
    label("Turntable", "Turns around the mesh, at this speed in degrees per second");
    check(state, "turntable", "##turn", "Turns around the mesh. Key T");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1);
    slide(state, "turntable-speed", 90, "%.0f\u00b0/s");
}

void draw_stream(State& state) {
    heading("Stream");
    choose(state, "source", "Format",
           "The format on the device that is drawn. Index list: three numbers per triangle. Lean: about one number. "
           "Packed: about two bits");
    choose(state, "path", "Path",
           "Where the stream becomes triangles. Compute: it is expanded once to an index list. Others: the shader of "
           "that name reads the stream in every frame");
    if (state.choices.shown.path == gpu::Path::compute) {
        check(state, "decode", "decode every frame", "Shows how long expanding takes; the picture needs it only once");
    }
    choose(
        state, "weld", "Weld",
        "Which vertices of the file are joined to one vertex of the surface. By position: vertices at the same place; "
        "streams hold the surface, and apart from it the copy at each corner. By all attributes: only equal vertices. "
        "A change reads the file again");
}

void draw_ring(State& state) {
    heading("Ring");
    choose(state, "ring", "Made by",
           "The paper's two ways to find a ring. Ring-expander goes depth first; hybrid keeps parts of the ring that "
           "are neighbors on the surface near each other along it");
    if (state.choices.ring.hybrid) {
        number(state, "k", "k", "Period of the hybrid: breadth first every k triangles. 1: always");
    }
    number(state, "seeds", "Seeds",
           "Number of seed corners that are tried in each component; the cheapest ring is kept");
    number(state, "seed", "Random seed", "For random choices: seed corners, and changes by the optimizer");
    number(state, "passes", "Passes",
           "Passes of the optimizer, which changes the ring so that fewer triangles are T0. 0: the ring as found");
    check(state, "warts", "skip warts",
          "A wart is a T0 triangle next to a dead end (T2). If lean skips warts, it does not store the three numbers "
          "of their T0");
}

}  // namespace

void draw_choices(State& state) {
    draw_view(state);
    draw_stream(state);
    draw_ring(state);
    ImGui::Dummy({0, px(1)});
    if (ImGui::Button("Screenshot")) state.ask(action::SavePicture{});
    explain("lacedring-N.png in the working folder. Key F12");
    ImGui::SameLine();
    if (ImGui::Button("Turntable PNG")) state.ask(action::SaveTurn{});
    explain("A whole turn in 90 pictures, in a folder turntable-N of the working folder");
    ImGui::Dummy({0, px(1)});
    draw_files(state);
}

}  // namespace lacedring::view
