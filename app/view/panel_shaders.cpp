// The notice that shaders do not compile: there until they do, or until it is closed.
#include <imgui.h>

#include <algorithm>

#include "app/view/panels.h"
#include "app/view/theme.h"

namespace lr::view {

void draw_shader_error(State& state) {
    std::string& error = state.shaders.error;
    if (error.empty()) return;
    constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                        ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                        ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing;
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    const float button = px(36), padding = px(12);
    const float room = static_cast<float>(free_area(state, window.x, window.y)[0]) - px(32);
    const float width = std::min(ImGui::CalcTextSize(error.c_str()).x + button + 2 * padding, std::max(px(240), room));
    // Under the notice of other errors.
    ImGui::SetNextWindowPos({window.x / 2, state.error.empty() ? px(16) : px(96)}, ImGuiCond_Always, {0.5F, 0});
    ImGui::SetNextWindowSizeConstraints({width, 0}, {width, window.y * 0.6F});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, ImVec4{0.36F, 0.09F, 0.08F, 0.97F});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(4));
    ImGui::Begin("shaders", nullptr, kFlags | ImGuiWindowFlags_AlwaysAutoResize);
    const float top = ImGui::GetCursorPosY();
    ImGui::PushTextWrapPos(width - button);
    ImGui::TextUnformatted(error.c_str());
    ImGui::PopTextWrapPos();
    ImGui::SetCursorPos({width - button + px(8), top});
    if (ImGui::SmallButton("x")) error.clear();
    ImGui::End();
    ImGui::PopStyleVar();
    ImGui::PopStyleColor();
}

}  // namespace lr::view
