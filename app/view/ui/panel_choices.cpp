// Left: what is opened and how it is shown.
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>

#include "app/view/ui/panels.h"
#include "app/view/window/theme.h"

namespace lacedring::view {
namespace {

constexpr float kLabel = 104;  // nominal pixels before a field

void label(const char* text, const char* explained) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", text);
    explain(explained);
    ImGui::SameLine(px(kLabel));
    ImGui::SetNextItemWidth(-1);
}

/// `other`: what the list shows of a value that it does not have.
template <class T>
bool choose(const char* name, std::span<const gpu::Named<std::type_identity_t<T>>> values, T& value,
            const char* explained, float width = -1, const char* other = "") {
    const auto at = std::ranges::find(values, value, &gpu::Named<T>::value);
    bool changed = false;
    label(name, explained);
    ImGui::SetNextItemWidth(width);
    ImGui::PushID(name);
    if (ImGui::BeginCombo("##", at == values.end() ? other : at->label)) {
        for (const gpu::Named<T>& named : values) {
            if (ImGui::Selectable(named.label, named.value == value)) {
                value = named.value;
                changed = true;
            }
        }
        ImGui::EndCombo();
    }
    ImGui::PopID();
    return changed;
}

bool number(const char* name, std::uint32_t& value, int low, int high, const char* explained) {
    label(name, explained);
    ImGui::PushID(name);
    int text = static_cast<int>(value);
    const bool changed = ImGui::InputInt("##", &text, 1, 10);
    ImGui::PopID();
    if (changed) value = static_cast<std::uint32_t>(std::clamp(text, low, high));
    return changed;
}

bool check(const char* name, bool& value, const char* explained) {
    const bool changed = ImGui::Checkbox(name, &value);
    explain(explained);
    return changed;
}

/// Scrolls to the last item, once for each path.
void show_once(const std::string& path) {
    ImGuiStorage& storage = *ImGui::GetStateStorage();
    const int now = static_cast<int>(std::hash<std::string>()(path));
    if (storage.GetInt(ImGui::GetID("shown")) == now) return;
    storage.SetInt(ImGui::GetID("shown"), now);
    ImGui::SetScrollHereY();
}

void list_files(State& state, const std::vector<std::string>& files, const char* none) {
    for (const std::string& path : files) {
        const bool current = state.document && std::filesystem::path(state.document->path).filename() ==
                                                   std::filesystem::path(path).filename();
        ImGui::PushID(path.c_str());
        const std::string name = std::filesystem::path(path).filename().string();
        if (ImGui::Selectable(elided(name, ImGui::GetContentRegionAvail().x).c_str(), current)) state.open = path;
        if (current) show_once(state.document->path);
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", broken(path, px(320)).c_str());
        ImGui::PopID();
    }
    if (files.empty()) ImGui::TextDisabled("%s", none);
}

void draw_files(State& state) {
    if (!ImGui::BeginTabBar("files")) return;
    // Whole lines of it, and some even in a low window.
    const float line = ImGui::GetTextLineHeightWithSpacing();
    const float room = ImGui::GetContentRegionAvail().y - ImGui::GetStyle().ItemSpacing.y;
    const ImVec2 size{0, line * std::max(3.0F, std::floor(room / line))};
    if (ImGui::BeginTabItem("Folder")) {
        ImGui::BeginChild("folder", size);
        list_files(state, state.files, "no meshes in this folder");
        if (state.files.empty() && !state.sample_files.empty()) {
            ImGui::TextDisabled("samples:");
            list_files(state, state.sample_files, "");
        }
        ImGui::EndChild();
        ImGui::EndTabItem();
    }
    if (ImGui::BeginTabItem("Recent")) {
        ImGui::BeginChild("recent", size);
        list_files(state, state.recent, "none yet");
        ImGui::EndChild();
        ImGui::EndTabItem();
    }
    ImGui::EndTabBar();
}

/// How the ring-expander is watched.
void draw_growth(State& state) {
    const double end = state.growth_end();
    label("Speed", "Triangles a second");
    auto speed = static_cast<float>(state.growth_speed);
    if (ImGui::SliderFloat("##speed", &speed, 1, 1e6F, "%.0f /s", ImGuiSliderFlags_Logarithmic)) {
        state.growth_speed = static_cast<double>(speed);
    }
    label("Invaded", "Triangles so far");
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
}

void draw_view(State& state) {
    heading("View");
    constexpr std::array<gpu::Named<std::uint32_t>, 3> kSamples{{{"1", 1, "1"}, {"2", 2, "4"}, {"3", 3, "9"}}};
    Shown& shown = state.shown;
    bool changed = choose(
        "Show", kViews, shown.view,
        "How the surface is drawn. Triangle classes: T0, T1 and T2 have none, one, two edges on the ring. Ring order: "
        "where its vertices come along the ring. Offsets: how far apart they are along it. Seams: edges with other "
        "normals, texture coordinates or the like on "
        "either side");
    if (choose(
            "Colours", kPaints, state.paint,
            "Laid over the surface. Corridors: runs of triangles between two parts of the ring. Blocks: parts of the "
            "packed stream that decode on their own. Ring-expander: how the ring is found, triangle by triangle")) {
        changed = true;
        if (state.paint == Paint::growth) {
            state.growth = 0;
            state.growing = true;
        }
    }
    if (state.paint == Paint::growth && state.document) draw_growth(state);
    changed |=
        choose("Compare", kModes, shown.mode,
               "The same picture from the index list and from the stream: side by side, or red where they differ");
    changed |=
        choose("Samples", kSamples, state.samples, "Of each pixel: more make edges smooth, and take longer", px(44));
    ImGui::SameLine();
    check("outlines", state.outlines, "Silhouettes, borders and creases, asked of the LR tables");
    constexpr std::array<gpu::Named<std::uint32_t>, 4> kCaps{
        {{"30", 30, "30 a second"}, {"60", 60, "60 a second"}, {"120", 120, "120 a second"}, {"0", 0, "no limit"}}};
    choose("Pictures", kCaps, state.frame_cap, "At most so many are drawn while something moves", -1,
           (std::to_string(state.frame_cap) + " a second").c_str());
    state.choices_changed |= changed;
    label("Turntable", "Turns around the mesh, so many degrees a second");
    auto speed = static_cast<float>(state.turntable_speed);
    ImGui::Checkbox("##turn", &state.turntable);
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderFloat("##degrees", &speed, -90, 90, "%.0f\u00b0/s"))
        state.turntable_speed = static_cast<double>(speed);
}

void draw_stream(State& state) {
    heading("Stream");
    Shown& shown = state.shown;
    bool changed = choose("Format", kSources, shown.source,
                          "What is on the device and drawn. Index list: three numbers for each triangle. Lean: about "
                          "one. Packed: about two bits");
    const char* path =
        "Where the stream becomes triangles. Compute: expanded once to an index list. The others read the stream "
        "itself "
        "in every frame, in the shader that the name tells";
    const std::span paths(gpu::kPaths);
    changed |= choose("Path", state.mesh_shaders ? paths : paths.first(3), shown.path, path);  // the last is mesh
    if (shown.path == gpu::Path::compute) {
        check("decode every frame", shown.decode_again, "To see what expanding takes: it is needed only once");
    }
    state.choices_changed |= changed;
}

void draw_ring(State& state) {
    heading("Ring");
    RingSettings& ring = state.ring;
    choose(
        "Made by", kRings, ring.hybrid,
        "The paper's two ways to find a ring. Ring-expander goes depth first; hybrid keeps parts of the ring that are "
        "neighbours on the surface near each other along it");
    if (ring.hybrid) number("k", ring.k, 1, 1000000, "Of the hybrid: breadth first every k triangles. 1: always");
    number("Seeds", ring.seeds, 1, 10000,
           "How many corners to start from are tried in each component; the cheapest ring is kept");
    auto seed = static_cast<std::uint32_t>(ring.random_seed);
    if (number("Random seed", seed, 0, 1000000, "Chooses the corners that are tried, and what the optimiser does"))
        ring.random_seed = seed;
    number("Passes", ring.passes, 0, 10000,
           "Of the optimiser, which moves vertices along the ring so that fewer triangles are T0. 0: as it was found");
    check("skip warts", ring.warts,
          "A wart is a T0 triangle next to a dead end. Lean stores the two without the T0's three numbers if it skips "
          "them");
}

}  // namespace

void draw_choices(State& state) {
    draw_view(state);
    draw_stream(state);
    draw_ring(state);
    ImGui::Dummy({0, px(1)});
    if (ImGui::Button("Screenshot")) state.screenshot = true;
    explain("lacedring-N.png in the working folder. Key F12");
    ImGui::SameLine();
    if (ImGui::Button("Turntable PNG")) state.turntable_pictures = true;
    explain("A whole turn in 90 pictures, in a folder turntable-N of the working folder");
    ImGui::Dummy({0, px(1)});
    draw_files(state);
}

}  // namespace lacedring::view
