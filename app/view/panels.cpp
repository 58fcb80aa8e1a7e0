#include "app/view/panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <filesystem>

#include "app/view/theme.h"

namespace lr::view {
namespace {

constexpr float kLeft = 268, kRight = 300, kBar = 30;  // nominal pixels
constexpr float kNarrow = 900;                         // below it only the left panel is shown
constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                                    ImGuiWindowFlags_NoNav;

void begin_at(const char* name, ImVec2 at, ImVec2 size, ImGuiWindowFlags more = 0) {
    ImGui::SetNextWindowPos(at);
    ImGui::SetNextWindowSize(size);
    ImGui::Begin(name, nullptr, kFixed | more);
}

bool narrow() {
    return ImGui::GetIO().DisplaySize.x < px(kNarrow);
}

void draw_bar(State& state) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{px(12), px(4)});
    begin_at("bar", {0, window.y - px(kBar)}, {window.x, px(kBar)}, ImGuiWindowFlags_NoScrollbar);
    ImGui::AlignTextToFramePadding();
    Loader::Progress progress = state.progress;
    if (const auto& job = state.turntable_job) {
        progress = {true, false, fmt::format("picture {} of {}", job->done + 1, job->pictures),
                    static_cast<double>(job->done) / job->pictures};
    }
    if (state.document) {
        const Document& document = *state.document;
        ImGui::Text("%s   %s triangles   %s vertices", std::filesystem::path(document.path).filename().c_str(),
                    grouped(document.mesh->triangle_count()).c_str(), grouped(document.mesh->vertex_count).c_str());
    } else {
        ImGui::TextDisabled("no mesh");
    }
    const bool told = state.clock < state.note_until;
    if (told) {
        ImGui::SameLine(0, px(24));
        ImGui::TextUnformatted(state.note.c_str());
    }
    if (progress.busy) {
        const float bar = px(200), cancel = progress.background ? 0 : px(64);
        const float text = ImGui::CalcTextSize(progress.what.c_str()).x;
        ImGui::SameLine(std::max(ImGui::GetCursorPosX(), window.x - bar - cancel - text - px(40)));
        ImGui::TextDisabled("%s", progress.what.c_str());
        ImGui::SameLine();
        ImGui::SetCursorPosY(ImGui::GetCursorPosY() + px(4));
        ImGui::ProgressBar(static_cast<float>(progress.share), {bar, px(12)}, "");
        if (!progress.background) {
            ImGui::SameLine();
            ImGui::SetCursorPosY(px(4));
            if (ImGui::Button("Cancel")) state.cancel = true;
        }
    } else if (!told) {
        const char* hint = "?  help";
        ImGui::SameLine(window.x - ImGui::CalcTextSize(hint).x - px(16));
        ImGui::TextDisabled("%s", hint);
    }
    ImGui::End();
    ImGui::PopStyleVar();
}

/// Over the picture, in its middle.
void draw_notices(State& state) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    const float room = static_cast<float>(free_area(state, window.x, window.y)[0]) - px(32);
    const bool shifted = state.panels && narrow();
    const float middle = shifted ? (window.x + px(kLeft)) / 2 : window.x / 2;
    if (!state.error.empty()) {
        const float width =
            std::clamp(ImGui::CalcTextSize(state.error.c_str()).x + px(70), px(240), std::max(px(240), room));
        ImGui::SetNextWindowPos({middle, px(16)}, ImGuiCond_Always, {0.5F, 0});
        ImGui::SetNextWindowSize({width, 0});
        ImGui::PushStyleColor(ImGuiCol_WindowBg, ImVec4{0.36F, 0.09F, 0.08F, 0.97F});
        ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(4));
        ImGui::Begin("error", nullptr, kFixed | ImGuiWindowFlags_AlwaysAutoResize);
        ImGui::PushTextWrapPos(width - px(44));
        ImGui::TextUnformatted(state.error.c_str());
        ImGui::PopTextWrapPos();
        ImGui::SameLine(width - px(36));
        if (ImGui::SmallButton("x")) state.error.clear();
        ImGui::End();
        ImGui::PopStyleVar();
        ImGui::PopStyleColor();
    }
    if (!state.document && !state.progress.busy) {
        const char* text = "Drop a mesh here";
        ImGui::GetBackgroundDrawList()->AddText(ImGui::GetFont(), px(22),
                                                {middle - ImGui::CalcTextSize(text).x * 0.75F, window.y / 2 - px(20)},
                                                IM_COL32(70, 72, 78, 255), text);
    }
}

}  // namespace

std::array<double, 2> free_area(const State& state, double width, double height) {
    if (!state.panels) return {width, height};
    const bool slim = width < static_cast<double>(px(kNarrow));
    // The mesh stays in the window's middle, so the wider panel counts twice.
    const double sides = 2.0 * static_cast<double>(px(slim ? kLeft : std::max(kLeft, kRight)));
    return {std::max(0.3 * width, width - sides), std::max(0.3 * height, height - 2.0 * static_cast<double>(px(kBar)))};
}

void draw_panels(State& state, const Orbit&) {
    if (state.panels) {
        const ImVec2 window = ImGui::GetIO().DisplaySize;
        const float height = window.y - px(kBar);
        begin_at("choices", {0, 0}, {px(kLeft), height});
        draw_choices(state);
        ImGui::End();
        if (!narrow()) {
            begin_at("numbers", {window.x - px(kRight), 0}, {px(kRight), height});
            draw_numbers(state);
            ImGui::End();
        }
        if (state.document && state.selection.any() && !state.help) {  // help lies over it
            const float left = px(kLeft) + px(8), right = (narrow() ? 0 : px(kRight)) + px(8);
            ImGui::SetNextWindowPos({left, height - px(8)}, ImGuiCond_Always, {0, 1});
            ImGui::SetNextWindowSize({window.x - left - right, 0});
            ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(4));
            ImGui::Begin("selection", nullptr, kFixed | ImGuiWindowFlags_AlwaysAutoResize);
            draw_selection(state);
            ImGui::End();
            ImGui::PopStyleVar();
        }
        draw_bar(state);
    }
    draw_notices(state);
    if (state.help) draw_help();
}

void draw_help() {
    struct Line {
        const char *keys, *what;
    };
    constexpr Line kLines[] = {{"left drag", "turn"},
                               {"middle drag, shift + left", "pan"},
                               {"wheel", "zoom to the cursor"},
                               {"right drag, control + left", "zoom"},
                               {"Home, Enter, F", "frame all"},
                               {".", "frame the selection"},
                               {"1 3 7 9", "front, right, top, three-quarter; control: opposite"},
                               {"T, shift + T", "turntable; a whole turn as PNG files"},
                               {"V, shift + V", "next view, previous view"},
                               {"X, D", "split: plain | stream; difference"},
                               {"click", "select a corner"},
                               {"N P O S L R", "next, previous, opposite, swing, left, right"},
                               {"G", "watch the ring-expander grow"},
                               {"Tab", "panels"},
                               {"F12", "screenshot"},
                               {"F5", "compile the shaders again"},
                               {"control + C", "copy the camera, as render takes it"},
                               {"Escape", "cancel, clear"},
                               {"? or H", "this help"},
                               {"control + Q", "quit"}};
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({window.x / 2, window.y / 2}, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowFocus();
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(6));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{px(22), px(18)});
    ImGui::Begin("help", nullptr,
                 (kFixed & ~ImGuiWindowFlags_NoBringToFrontOnFocus) | ImGuiWindowFlags_AlwaysAutoResize);
    if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
        for (const Line& line : kLines) {
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            ImGui::TextColored(ImGui::GetStyle().Colors[ImGuiCol_CheckMark], "%s", line.keys);
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(line.what);
        }
        ImGui::EndTable();
    }
    ImGui::End();
    ImGui::PopStyleVar(2);
}

std::string grouped(std::uint64_t number) {
    const std::string digits = std::to_string(number);
    std::string out;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (i != 0 && (digits.size() - i) % 3 == 0) out += ',';
        out += digits[i];
    }
    return out;
}

std::string bytes_text(std::uint64_t bytes) {
    const double kib = static_cast<double>(bytes) / 1024;
    if (kib < 1024) return fmt::format("{:.1f} KiB", kib);
    return fmt::format("{:.1f} MiB", kib / 1024);
}

void heading(const char* text) {
    if (ImGui::GetCursorPosY() > px(20)) ImGui::Dummy({0, px(1)});
    ImGui::TextColored(ImGui::GetStyle().Colors[ImGuiCol_CheckMark], "%s", text);
    ImGui::Separator();
}

}  // namespace lr::view
