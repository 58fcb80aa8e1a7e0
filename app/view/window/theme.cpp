#include "app/view/window/theme.h"

#include <imgui.h>

#include <array>
#include <filesystem>

namespace lacedring::view {
namespace {

float g_scale = 1;
ImFont* g_small = nullptr;

/// Ranges of characters for file names and messages: Latin, Greek, Cyrillic, punctuation.
constexpr ImWchar kLetters[] = {0x20, 0x24f, 0x370, 0x52f, 0x1e00, 0x1eff, 0x2010, 0x2027, 0};

ImFont* add_font(float size) {
    constexpr std::array<const char*, 4> kFonts{
        "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf",
        "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf", "/usr/share/fonts/TTF/DejaVuSans.ttf"};
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    ImFontConfig config;
    config.OversampleH = 2;
    // Take the first font that the machine has, else ImGui's own bitmap font.
    for (const char* path : kFonts) {
        std::error_code error;
        if (!std::filesystem::is_regular_file(path, error)) continue;
        if (ImFont* font = fonts.AddFontFromFileTTF(path, size, &config, kLetters)) return font;
    }
    config.SizePixels = size * 13 / 15;
    return fonts.AddFontDefault(&config);
}

}  // namespace

float px(float nominal) {
    return nominal * g_scale;
}

ImFont* small_font() {
    return g_small;
}

void apply_theme(float scale) {
    g_scale = scale;
    add_font(15 * scale);
    g_small = add_font(13 * scale);
    ImGuiStyle& style = ImGui::GetStyle();
    ImGui::StyleColorsDark(&style);
    style.WindowPadding = {12, 10};
    style.FramePadding = {7, 3};
    style.ItemSpacing = {8, 5};
    style.ItemInnerSpacing = {6, 4};
    style.ScrollbarSize = 11;
    // The bar is lower than ImGui's default minimum.
    style.WindowMinSize = {16, 16};
    style.GrabMinSize = 10;
    style.WindowRounding = 0;
    style.FrameRounding = 3;
    style.GrabRounding = 3;
    style.PopupRounding = 4;
    style.ScrollbarRounding = 4;
    style.WindowBorderSize = 0;
    style.PopupBorderSize = 1;
    style.ScaleAllSizes(scale);
    // A border makes fields and empty boxes visible.
    style.FrameBorderSize = scale;
    const ImVec4 ground{0.105F, 0.11F, 0.12F, 1}, field{0.18F, 0.185F, 0.20F, 1}, over{0.24F, 0.25F, 0.27F, 1},
        accent{0.87F, 0.42F, 0.13F, 1}, bright{0.95F, 0.50F, 0.20F, 1}, dim{0.42F, 0.23F, 0.12F, 1};
    ImVec4* c = style.Colors;
    c[ImGuiCol_Text] = {0.89F, 0.89F, 0.88F, 1};
    c[ImGuiCol_TextDisabled] = {0.64F, 0.65F, 0.67F, 1};
    c[ImGuiCol_WindowBg] = ground;
    c[ImGuiCol_ChildBg] = {0, 0, 0, 0};
    c[ImGuiCol_PopupBg] = {0.13F, 0.135F, 0.147F, 0.99F};
    c[ImGuiCol_Border] = {0.28F, 0.29F, 0.31F, 1};
    c[ImGuiCol_FrameBg] = field;
    c[ImGuiCol_FrameBgHovered] = over;
    c[ImGuiCol_FrameBgActive] = over;
    c[ImGuiCol_Button] = field;
    c[ImGuiCol_ButtonHovered] = over;
    c[ImGuiCol_ButtonActive] = dim;
    c[ImGuiCol_Header] = dim;
    c[ImGuiCol_HeaderHovered] = over;
    c[ImGuiCol_HeaderActive] = dim;
    c[ImGuiCol_CheckMark] = accent;
    c[ImGuiCol_SliderGrab] = {0.60F, 0.30F, 0.11F, 1};  // text lies over it

    c[ImGuiCol_SliderGrabActive] = bright;
    c[ImGuiCol_PlotHistogram] = accent;
    c[ImGuiCol_PlotLines] = accent;
    c[ImGuiCol_Separator] = {0.22F, 0.225F, 0.24F, 1};
    c[ImGuiCol_ScrollbarBg] = {0, 0, 0, 0};
    c[ImGuiCol_ScrollbarGrab] = over;
    c[ImGuiCol_TextSelectedBg] = dim;
    c[ImGuiCol_NavHighlight] = accent;
    c[ImGuiCol_Tab] = field;
    c[ImGuiCol_TabHovered] = over;
    c[ImGuiCol_TabActive] = c[ImGuiCol_TabUnfocusedActive] = dim;
    c[ImGuiCol_TabUnfocused] = field;
    c[ImGuiCol_ModalWindowDimBg] = {0, 0, 0, 0.45F};
}

}  // namespace lacedring::view
