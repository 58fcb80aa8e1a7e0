// The help on keys and mouse, over the picture. docs/viewer.md has the same list; controls.cpp implements it.
#include <imgui.h>

#include <algorithm>

#include "app/view/ui/panels.h"
#include "app/view/window/theme.h"

namespace lacedring::view {
namespace {

struct Line {
    const char* keys;  ///< null: a heading
    const char* what;
};
constexpr Line kLines[] = {{nullptr, "Camera"},
                           {"left drag", "turn"},
                           {"middle drag, shift + left drag", "pan"},
                           {"wheel", "zoom to the cursor"},
                           {"right drag, control + left drag", "zoom"},
                           {"Home, Enter, F", "frame all"},
                           {".", "frame the selection"},
                           {"1 3 7 9", "front, right, top, three-quarter; control: other side"},
                           {"T, shift + T", "turntable; a whole turn as PNG files"},
                           {nullptr, "Picture"},
                           {"V, shift + V", "next view, previous view"},
                           {"E", "the ring's line on and off"},
                           {"X", "split screen: index list, stream"},
                           {"D", "difference of the two"},
                           {"G", "watch the ring-expander grow"},
                           {nullptr, "Selection"},
                           {"click", "select the corner nearest to the cursor"},
                           {"N P O S L R", "next, previous, opposite, swing, left, right corner"},
                           {"B", "begin the ring at the selected corner"},
                           {nullptr, "Window"},
                           {"Tab", "panels on and off"},
                           {"F12", "screenshot"},
                           {"F5", "compile the shaders again"},
                           {"control + C", "copy the camera, as options of render"},
                           {"Escape", "cancel, then clear"},
                           {"? H F1", "this help"},
                           {"control + Q", "quit"}};

}  // namespace

void draw_help(float left, float right, float bottom) {
    const float across = right - left;
    float keys = 0, what = 0;
    for (const Line& line : kLines) {
        if (line.keys != nullptr) keys = std::max(keys, ImGui::CalcTextSize(line.keys).x);
        what = std::max(what, ImGui::CalcTextSize(line.what).x);
    }
    const float padding = std::min(px(22), across / 20), gap = px(16);
    // In a narrow window both columns shrink and their lines wrap.
    const float room = across - px(16) - 2 * padding - gap - ImGui::GetStyle().ScrollbarSize;
    keys = std::min(keys, room * 0.4F);
    what = std::min(what, room - keys);
    ImGui::SetNextWindowPos({(left + right) / 2, bottom / 2}, ImGuiCond_Always, {0.5F, 0.5F});
    const float width = keys + gap + what + 2 * padding + ImGui::GetStyle().ScrollbarSize;
    ImGui::SetNextWindowSizeConstraints({width, 0}, {width, bottom - px(12)});
    ImGui::SetNextWindowFocus();
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(6));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{padding, px(14)});
    ImGui::Begin("help", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_AlwaysAutoResize);
    for (const Line& line : kLines) {
        if (line.keys == nullptr) {
            heading(line.what);
            continue;
        }
        const float top = ImGui::GetCursorPosY();
        ImGui::PushTextWrapPos(padding + keys + 1);
        ImGui::TextUnformatted(line.keys);
        ImGui::PopTextWrapPos();
        const float below = ImGui::GetCursorPosY();
        ImGui::SetCursorPos({padding + keys + gap, top});
        ImGui::PushTextWrapPos(padding + keys + gap + what + 1);
        ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyle().Colors[ImGuiCol_TextDisabled]);
        ImGui::TextUnformatted(line.what);
        ImGui::PopStyleColor();
        ImGui::PopTextWrapPos();
        ImGui::SetCursorPosY(std::max(ImGui::GetCursorPosY(), below));
    }
    ImGui::End();
    ImGui::PopStyleVar(2);
}

}  // namespace lacedring::view
