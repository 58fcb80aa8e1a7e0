#include "app/view/ui/overlays.h"

#include <imgui.h>

#include <array>
#include <cmath>

#include "app/view/window/theme.h"

namespace lacedring::view {
namespace {

ImVec2 at(const std::array<double, 2>& p) {
    return {static_cast<float>(p[0]), static_cast<float>(p[1])};
}

void letter(ImVec2 place, const char* text, std::uint32_t color) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const float radius = px(9);
    list.AddCircleFilled(place, radius, IM_COL32(20, 21, 24, 235));
    list.AddCircle(place, radius, color | 0xff000000U, 0, px(1.5F));
    const ImVec2 size = ImGui::CalcTextSize(text);
    list.AddText({place.x - size.x / 2, place.y - size.y / 2}, IM_COL32_WHITE, text);
}

void mark_selection(const State& state, const Orbit& orbit, double width, double height) {
    const Document& document = *state.facts.document;
    const auto place = [&](CornerId c, double toward) {
        // A corner is drawn inside its triangle, near its vertex.
        Vector p{};
        const double weight[3] = {toward, (1 - toward) / 2, (1 - toward) / 2};
        const CornerId corners[3] = {c, next(c), previous(c)};
        for (std::size_t j = 0; j < 3; ++j) {
            p = p + place_of(document, corners[j]) * weight[j];
        }
        return orbit.project(p, height, width);
    };
    const CornerTable& table = *document.table;
    const CornerId c = state.facts.selection.corner;
    const std::array<std::tuple<CornerId, const char*, std::uint32_t>, 7> marks{
        {{table.swing(c), "s", kFanColor},
         {table.right(c), "r", kRightColor},
         {table.left(c), "l", kLeftColor},
         {table.opposite(c), "o", kOppositeColor},
         {previous(c), "p", rgba(150, 150, 150)},
         {next(c), "n", rgba(150, 150, 150)},
         {c, "c", kSelectedColor}}};
    // Draw letters only if the triangles are large enough.
    const auto a = place(c, 1), b = place(next(c), 1);
    const bool room = a && b && std::hypot((*a)[0] - (*b)[0], (*a)[1] - (*b)[1]) > static_cast<double>(px(46));
    // The last mark is the most important. A mark that would overlap a more important one becomes a dot.
    std::vector<ImVec2> places(marks.size());
    for (std::size_t i = marks.size(); i-- > 0;) {
        const auto& [corner, text, color] = marks[i];
        if (corner.is_null() || (!room && corner != c)) continue;
        if (const auto p = place(corner, room ? 0.72 : 1.0)) {
            places[i] = at(*p);
            const bool free =
                std::none_of(places.begin() + static_cast<std::ptrdiff_t>(i) + 1, places.end(),
                             [&](ImVec2 q) { return std::hypot(q.x - places[i].x, q.y - places[i].y) < px(19); });
            if (room && free) {
                letter(at(*p), text, color);
            } else {
                ImGui::GetBackgroundDrawList()->AddCircleFilled(at(*p), px(4), color | 0xff000000U);
                ImGui::GetBackgroundDrawList()->AddCircle(at(*p), px(4), IM_COL32(20, 21, 24, 235), 0, px(1));
            }
        }
    }
}

void tag(const char* text, float x, float y, float side) {
    const ImVec2 size = ImGui::CalcTextSize(text);
    const float left = side < 0 ? x - size.x - px(22) : x + px(10);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddRectFilled({left, y}, {left + size.x + px(12), y + size.y + px(6)}, IM_COL32(20, 21, 24, 210), px(3));
    list.AddText({left + px(6), y + px(3)}, IM_COL32(225, 225, 225, 255), text);
}

}  // namespace

void draw_marks(const State& state, const Orbit& orbit, std::uint32_t width, std::uint32_t height) {
    if (!state.choices.panels) return;
    if (state.facts.document && state.facts.selection.any()) mark_selection(state, orbit, width, height);
    if (state.choices.shown.mode != Mode::split) return;
    const auto x = static_cast<float>(state.choices.divider * width);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddLine({x, 0}, {x, static_cast<float>(height)}, IM_COL32(20, 21, 24, 255), px(1.5F));
    const float middle = static_cast<float>(height) / 2;
    list.AddCircleFilled({x, middle}, px(11), IM_COL32(20, 21, 24, 235));
    list.AddTriangleFilled({x - px(7), middle}, {x - px(2), middle - px(4)}, {x - px(2), middle + px(4)},
                           IM_COL32(222, 107, 33, 255));
    list.AddTriangleFilled({x + px(7), middle}, {x + px(2), middle - px(4)}, {x + px(2), middle + px(4)},
                           IM_COL32(222, 107, 33, 255));
    const float top = static_cast<float>(state.facts.free.top) + px(14);
    tag("index list", x, top, -1);
    tag(state.choices.shown.source == gpu::Source::packed  ? "packed"
        : state.choices.shown.source == gpu::Source::plain ? "index list"
                                                           : "lean",
        x, top, 1);
}

}  // namespace lacedring::view
