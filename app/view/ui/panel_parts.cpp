// Parts of the panels: numbers, cut and broken text, headings, tooltips.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>

#include "app/view/ui/panels.h"
#include "app/view/window/theme.h"

namespace lacedring::view {
namespace {

float width_of(std::string_view text) {
    return ImGui::CalcTextSize(text.data(), text.data() + text.size()).x;
}

/// Returns whether a UTF-8 character begins at byte i.
bool begins(std::string_view text, std::size_t i) {
    return i >= text.size() || (static_cast<unsigned char>(text[i]) & 0xc0U) != 0x80U;
}

}  // namespace

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

std::string elided(std::string_view text, float room) {
    if (width_of(text) <= room) return std::string(text);
    std::string out;
    // Keep as many bytes of both ends as fit: the ends of a file name say more than its middle.
    std::size_t low = 0, high = text.size();
    while (low < high) {
        const std::size_t kept = (low + high + 1) / 2;
        std::size_t head = kept / 2, tail = text.size() - (kept - kept / 2);
        while (head > 0 && !begins(text, head)) --head;
        while (!begins(text, tail)) ++tail;
        std::string cut = std::string(text.substr(0, head)) + "..." + std::string(text.substr(tail));
        if (width_of(cut) <= room) {
            out = std::move(cut);
            low = kept;
        } else {
            high = kept - 1;
        }
    }
    return out;
}

std::string broken(std::string_view text, float room) {
    std::string out;
    std::size_t line = 0;  // start of the current line in `out`
    while (!text.empty()) {
        std::size_t end = text.find_first_of("/ ");
        end = end == std::string_view::npos ? text.size() : end + 1;
        if (out.size() > line && width_of(out.substr(line) + std::string(text.substr(0, end))) > room) {
            out += '\n';
            line = out.size();
        }
        // Cut a word that is longer than a line.
        while (end > 1 && width_of(text.substr(0, end)) > room) --end;
        while (!begins(text, end)) ++end;
        out += text.substr(0, end);
        text.remove_prefix(end);
    }
    return out;
}

void explain(const char* text) {
    if (!ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(px(320));
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

void heading(const char* text, const char* explained) {
    if (ImGui::GetCursorPosY() > px(20)) ImGui::Dummy({0, px(1)});
    ImGui::TextColored(ImGui::GetStyle().Colors[ImGuiCol_CheckMark], "%s", text);
    if (explained != nullptr) explain(explained);
    ImGui::Separator();
}

std::vector<PanelBox> panel_boxes() {
    std::vector<PanelBox> out;
    for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
        if (!window->Active || window->Hidden || (window->Flags & ImGuiWindowFlags_Tooltip) != 0) continue;
        if (std::string_view(window->Name) == "Debug##Default") continue;
        const float right = window->ContentSize.x + window->WindowPadding.x + window->ScrollbarSizes.x;
        const float seen = window->SizeFull.x - window->WindowPadding.x;
        out.push_back({window->Name, window->Pos.x, window->Pos.y, window->SizeFull.x, window->SizeFull.y,
                       std::max(0.0F, right - seen), window->ScrollMax.y});
    }
    return out;
}

}  // namespace lacedring::view
