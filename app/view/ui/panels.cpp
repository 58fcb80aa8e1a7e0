// Places the panels; draws the bar and the notices.
#include "app/view/ui/panels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>

#include <algorithm>
#include <filesystem>

#include "app/view/ui/settings.h"
#include "app/view/window/theme.h"

namespace lacedring::view {
namespace {

constexpr float kLeft = 268, kRight = 316, kBar = 30, kLegend = 44;  // nominal pixels
constexpr float kGap = 8;
// In windows narrower than this, the side panels are drawers, opened from the bar.
constexpr float kNarrow = 900;
// A box over the picture, in front of panels, that takes no focus from them.
constexpr ImGuiWindowFlags kOver = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                                   ImGuiWindowFlags_NoFocusOnAppearing;
constexpr ImGuiWindowFlags kFixed = kOver | ImGuiWindowFlags_NoBringToFrontOnFocus;

bool narrow(double width) {
    return width < static_cast<double>(px(kNarrow));
}

void begin_at(const char* name, ImVec2 at, ImVec2 size, ImGuiWindowFlags more = 0) {
    ImGui::SetNextWindowPos(at);
    ImGui::SetNextWindowSize(size);
    ImGui::Begin(name, nullptr, kFixed | more);
}

/// Draws a button in the bar, with its right end at `right`, and moves `right` to the left of it.
bool bar_button(const char* text, float& right, bool pressed = false) {
    right -= ImGui::CalcTextSize(text).x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::SetCursorPos({right, px(4)});
    ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyle().Colors[pressed ? ImGuiCol_ButtonActive : ImGuiCol_Button]);
    const bool out = ImGui::Button(text);
    ImGui::PopStyleColor();
    right -= px(kGap);
    return out;
}

void bar_text(const std::string& text, float x, bool dim = false) {
    ImGui::SetCursorPos({x, px(4)});
    ImGui::AlignTextToFramePadding();
    if (dim) {
        ImGui::TextDisabled("%s", text.c_str());
    } else {
        ImGui::TextUnformatted(text.c_str());
    }
}

std::string counted(std::int64_t count, const char* one, const char* many) {
    return fmt::format("{} {}", grouped(static_cast<std::uint64_t>(count)), count == 1 ? one : many);
}

/// The document's counts as text, the most important first.
std::vector<std::string> counts(const Document& document) {
    if (document.stand_in != 0) return {fmt::format("a coarse stand-in for {} triangles", grouped(document.stand_in))};
    std::vector<std::string> out{counted(document.mesh->triangle_count(), "triangle", "triangles"),
                                 counted(document.table->vertex_count, "vertex", "vertices")};
    if (document.surface->has_seams()) {
        out.push_back(counted(document.mesh->vertex_count, "copy", "copies"));
    }
    if (!document.optimized) return out;
    const TopologyReport& report = document.report;
    out.push_back(counted(report.components, "component", "components"));
    out.push_back(counted(static_cast<std::int64_t>(document.rings->count()), "ring", "rings"));
    out.push_back(counted(report.border_loops, "border", "borders"));
    out.push_back(fmt::format("genus {}", report.genus));
    return out;
}

/// The file's name and as many counts as there is room for.
std::string opened(const Document& document, float room) {
    const std::string name = std::filesystem::path(document.path).filename().string();
    std::string out = name;
    for (const std::string& count : counts(document)) {
        std::string longer = out + "   " + count;
        if (ImGui::CalcTextSize(longer.c_str()).x > room) break;
        out = std::move(longer);
    }
    if (out != name) return out;
    const std::string triangles = "   " + counts(document)[0];
    const float left = room - ImGui::CalcTextSize(triangles.c_str()).x;
    return left > px(120) ? elided(name, left) + triangles : elided(name, room);
}

void draw_progress(State& state, float& right, float window) {
    const Loader::Progress& progress = state.facts.progress;
    if (!progress.background && bar_button("Cancel", right)) state.ask(action::Do::cancel);
    const float length = std::clamp(window / 6, px(60), px(200));
    right -= length;
    ImGui::SetCursorPos({right, px(9)});
    ImGui::ProgressBar(static_cast<float>(progress.share), {length, px(12)}, "");
    right -= px(kGap);
    const float text = ImGui::CalcTextSize(progress.what.c_str()).x;
    if (right - text < window / 3) return;
    right -= text;
    bar_text(progress.what, right, true);
    right -= px(kGap);
}

void draw_bar(State& state) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{px(12), px(4)});
    begin_at("bar", {0, window.y - px(kBar)}, {window.x, px(kBar)}, ImGuiWindowFlags_NoScrollbar);
    const bool told = state.facts.clock < state.facts.note_until;
    // Items from the right end first; the text on the left gets the remaining room.
    float right = window.x - px(12);
    if (narrow(window.x)) {
        const auto drawer = [&](const char* text, Drawer which) {
            const bool open = state.choices.drawer == which;
            if (bar_button(text, right, open))
                state.ask(set(which == Drawer::choices ? "choices" : "numbers", open ? "off" : "on"));
        };
        if (!told || window.x > px(420)) {
            drawer("Numbers", Drawer::numbers);
            drawer("Choices", Drawer::choices);
        }
    }
    if (state.facts.progress.busy) {
        draw_progress(state, right, window.x);
    } else if (!told && window.x > px(500)) {
        if (bar_button("? Help", right, state.choices.help)) state.ask(toggle(state.choices, "help"));
    }
    float left = px(12);
    const float room = right - left - px(kGap);
    if (told && (narrow(window.x) || !state.facts.document)) {
        bar_text(elided(state.facts.note, room), left);
    } else if (state.facts.document) {
        const Document& document = *state.facts.document;
        const std::string text = opened(document, told ? room / 2 : room);
        bar_text(text, left);
        explain(fmt::format(
                    "{}\n{}.\nCopies: vertices of the file, if several are at the same place. Borders: border loops. "
                    "Genus: number of handles",
                    document.path, fmt::join(counts(document), ", "))
                    .c_str());
        left += ImGui::CalcTextSize(text.c_str()).x + px(24);
        if (told) bar_text(elided(state.facts.note, right - left - px(kGap)), left);
    } else {
        bar_text(state.facts.progress.busy ? "" : "no mesh", left, true);
    }
    ImGui::End();
    ImGui::PopStyleVar();
}

/// Draws an error over the picture, centered between `left` and `right`, from `top` on. Returns its lower end.
float draw_error(const char* name, std::string& error, float top, float left, float right) {
    if (error.empty()) return top;
    const float room = std::max(px(160), right - left - px(32));
    const float button = px(36), padding = px(12);
    const std::string text = broken(error, room - button - 2 * padding);
    const float width = ImGui::CalcTextSize(text.c_str()).x + button + 2 * padding;
    ImGui::SetNextWindowPos({(left + right) / 2, top}, ImGuiCond_Always, {0.5F, 0});
    ImGui::SetNextWindowSizeConstraints({width, 0}, {width, ImGui::GetIO().DisplaySize.y * 0.6F});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, ImVec4{0.36F, 0.09F, 0.08F, 0.98F});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(4));
    ImGui::Begin(name, nullptr, kOver | ImGuiWindowFlags_AlwaysAutoResize);
    const float line = ImGui::GetCursorPosY();
    ImGui::TextUnformatted(text.c_str());
    ImGui::SetCursorPos({ImGui::GetWindowContentRegionMax().x - px(24), line});
    if (ImGui::SmallButton("x")) error.clear();
    const float bottom = top + ImGui::GetWindowSize().y;
    ImGui::End();
    ImGui::PopStyleVar();
    ImGui::PopStyleColor();
    return bottom + px(kGap);
}

/// Draws the note when there is no bar to show it.
void draw_note(const State& state) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({window.x / 2, window.y - px(16)}, ImGuiCond_Always, {0.5F, 1});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(4));
    ImGui::Begin("note", nullptr, kOver | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs);
    ImGui::TextUnformatted(elided(state.facts.note, window.x - px(56)).c_str());
    ImGui::End();
    ImGui::PopStyleVar();
}

/// Draws an invitation, or the progress, in the middle of an empty window.
void invite(const State& state, float left, float right, float height) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const auto centered = [&](const char* text, float size, float y, ImU32 color) {
        const float width = ImGui::CalcTextSize(text).x * size / ImGui::GetFontSize();
        list.AddText(ImGui::GetFont(), size, {(left + right - width) / 2, y}, color, text);
    };
    if (state.facts.progress.busy) {
        centered(state.facts.progress.what.c_str(), px(18), height / 2 - px(20), IM_COL32(70, 72, 78, 255));
        return;
    }
    centered("Drop a mesh here", px(22), height / 2 - px(26), IM_COL32(70, 72, 78, 255));
    centered("glTF, GLB, OBJ, PLY, OFF, STL or LR", px(15), height / 2 + px(8), IM_COL32(100, 103, 110, 255));
}

/// Draws the box of the selection; returns its upper end.
float draw_selection_box(const State& state, float left, float right, float bottom) {
    const float width = std::min(right - left - 2 * px(kGap), px(860));
    ImGui::SetNextWindowPos({left + px(kGap), bottom - px(kGap)}, ImGuiCond_Always, {0, 1});
    ImGui::SetNextWindowSizeConstraints({width, 0}, {width, std::max(px(90), bottom * 0.45F)});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(4));
    ImGui::Begin("selection", nullptr, kOver | ImGuiWindowFlags_AlwaysAutoResize);
    draw_selection(state);
    const float top = ImGui::GetWindowPos().y;
    ImGui::End();
    ImGui::PopStyleVar();
    return top;
}

}  // namespace

std::array<double, 2> free_area(double width, double height) {
    // The mesh stays in the window's middle, so the wider panel and the legend count twice.
    const double free_height = std::max(0.3 * height, height - 2.0 * static_cast<double>(px(kLegend)));
    if (narrow(width)) return {width, free_height};
    return {std::max(0.3 * width, width - 2.0 * static_cast<double>(px(std::max(kLeft, kRight)))), free_height};
}

void draw_panels(State& state, bool ring_line) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    const Choices& choices = state.choices;
    const bool slim = narrow(window.x);
    const bool left_panel = choices.panels && (!slim || choices.drawer == Drawer::choices);
    const bool right_panel = choices.panels && (!slim || choices.drawer == Drawer::numbers);
    // The part of the picture beside the panels.
    const float left = left_panel && !slim ? px(kLeft) : 0;
    const float right = right_panel && !slim ? window.x - px(kRight) : window.x;
    const float height = choices.panels ? window.y - px(kBar) : window.y;
    float top = 0, bottom = height;
    if (left_panel) {
        begin_at("choices", {0, 0}, {std::min(px(kLeft), window.x), height});
        draw_choices(state);
        ImGui::End();
    }
    if (right_panel) {
        const float width = std::min(px(kRight), window.x);
        begin_at("numbers", {window.x - width, 0}, {width, height});
        draw_numbers(state);
        ImGui::End();
    }
    if (choices.panels) draw_bar(state);
    // A drawer or the help covers the selection and the legend.
    const bool covered = choices.help || (slim && (left_panel || right_panel));
    if (choices.panels && state.facts.document && !covered) {
        if (state.facts.selection.any()) bottom = draw_selection_box(state, left, right, bottom);
        top = draw_legend(state, ring_line, left, right, bottom / 3);
    }
    state.facts.free = {double{left}, double{top}, double{right}, double{bottom}};
    if (!state.facts.document && !covered) invite(state, left, right, height);
    if (!choices.panels && state.facts.clock < state.facts.note_until) draw_note(state);
    const float below = draw_error("error", state.facts.error, top + px(16), left, right);
    draw_error("shaders", state.facts.shaders.error, below, left, right);
    if (choices.help) draw_help(left, right, height);
}

}  // namespace lacedring::view
