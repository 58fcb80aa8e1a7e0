// The legend of colors over the picture.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "app/view/scene/selection.h"
#include "app/view/ui/panels.h"
#include "app/view/window/theme.h"

namespace lacedring::view {
namespace {

/// A swatch, a line or a ramp of colors, and its meaning.
struct Entry {
    enum Kind { swatch, line, ramp, text } kind = swatch;
    std::vector<ImU32> colors;
    std::string what;
};

/// Converts a linear color of the shaders to sRGB, as it looks in bright light.
ImU32 linear(float r, float g, float b) {
    const auto srgb = [](float x) { return x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1 / 2.4F) - 0.055F; };
    return ImGui::GetColorU32(ImVec4{srgb(r), srgb(g), srgb(b), 1});
}

/// The ring is drawn in black; on the dark legend, draw() puts it on a pale ground.
const ImU32 kLine = IM_COL32(12, 12, 14, 255), kGray = IM_COL32(176, 176, 176, 255);

void add_view(const State& state, bool ring_line, std::vector<Entry>& out) {
    const ImU32 t0 = linear(0.13F, 0.42F, 0.10F), none = linear(0.30F, 0.30F, 0.30F);  // as in surface.frag
    switch (state.choices.shown.view) {
        case gpu::View::triangle_class:
            out.push_back({Entry::line, {kLine}, "the ring"});
            out.push_back({Entry::swatch, {linear(0.82F, 0.70F, 0.44F)}, "T1 on its left"});
            out.push_back({Entry::swatch, {linear(0.84F, 0.31F, 0.055F)}, "T1 on its right"});
            out.push_back({Entry::swatch, {linear(0.06F, 0.20F, 0.58F)}, "T2, a dead end"});
            out.push_back({Entry::swatch, {t0}, "T0, a bifurcation"});
            out.push_back({Entry::swatch, {linear(0.58F, 0.03F, 0.03F)}, "T0 of a wart"});
            out.push_back({Entry::swatch, {none}, "T2 of a wart"});
            break;
        case gpu::View::ring:
            out.push_back({Entry::line, {kLine}, "the ring"});
            out.push_back({Entry::ramp,
                           {linear(0.045F, 0.085F, 0.50F), linear(0.03F, 0.34F, 0.72F), linear(0.62F, 0.78F, 0.72F),
                            linear(0.92F, 0.46F, 0.12F), linear(0.52F, 0.02F, 0.03F)},
                           "first to last vertex on it"});
            out.push_back({Entry::swatch, {linear(0.42F, 0.42F, 0.42F)}, "isolated: not on it"});
            break;
        case gpu::View::offsets:
            out.push_back({Entry::line, {kLine}, "the ring"});
            out.push_back({Entry::ramp,
                           {linear(0.96F, 0.84F, 0.36F), linear(0.86F, 0.30F, 0.07F), linear(0.42F, 0.03F, 0.16F),
                            linear(0.10F, 0.02F, 0.28F)},
                           "offset of the tip: 1 to 16 bits"});
            out.push_back({Entry::swatch, {t0}, "T0: no edge on it"});
            out.push_back({Entry::swatch, {none}, "tip is isolated"});
            break;
        case gpu::View::wire:
            out.push_back({Entry::line, {kLine}, "edges of triangles"});
            break;
        case gpu::View::seams:
            out.push_back({Entry::line, {linear(0.80F, 0.06F, 0.03F)}, "seams"});
            break;
        default:
            break;
    }
    if (ring_line) out.push_back({Entry::line, {kLine}, "the ring"});
    // The ring's line is not drawn on edges hardly longer than a pixel.
    if (!ring_line && state.choices.layers().sides == Paint::ring)
        out.push_back({Entry::text, {}, "the ring: zoom in"});
}

void add_paint(const State& state, std::vector<Entry>& out) {
    const ImU32 some[] = {IM_COL32(214, 96, 60, 255), IM_COL32(66, 140, 196, 255), IM_COL32(96, 164, 108, 255)};
    const std::vector<ImU32> many(std::begin(some), std::end(some));
    if (state.choices.paint == Paint::corridors) {
        out.push_back({Entry::swatch, many, "corridors: strips of T1"});
        out.push_back({Entry::swatch, {kGray}, "in none: T0, T2"});
    } else if (state.choices.paint == Paint::blocks) {
        out.push_back({Entry::swatch, many, "blocks of packed: 256 triangles"});
    } else if (state.choices.paint == Paint::growth) {
        const auto swatch = [&](unsigned r, unsigned g, unsigned b, const char* what) {
            out.push_back({Entry::swatch, {IM_COL32(r, g, b, 255)}, what});
        };
        const auto line = [&](unsigned r, unsigned g, unsigned b, const char* what) {
            out.push_back({Entry::line, {IM_COL32(r, g, b, 255)}, what});
        };
        swatch(LR_GROWTH_INVADED_COLOR, "invaded: left of the ring");
        swatch(LR_GROWTH_NEWEST_COLOR, "invaded just now");
        swatch(LR_GROWTH_RIGHT_COLOR, "never invaded: right of it");
        swatch(LR_GROWTH_NOT_YET_COLOR, "not yet reached");
        line(LR_GROWTH_LINE_COLOR, "the ring, where it will stay");
        line(LR_GROWTH_FRONT_COLOR, "front: may still be crossed");
        const double end = state.facts.growth_end();
        out.push_back(
            {Entry::text,
             {},
             fmt::format("{} of {} invaded", grouped(static_cast<std::uint64_t>(std::min(state.choices.growth, end))),
                         grouped(static_cast<std::uint64_t>(end)))});
    }
}

void add_difference(const State& state, std::vector<Entry>& out) {
    if (state.choices.shown.mode == Mode::single) return;
    if (state.choices.shown.mode == Mode::difference) {
        out.push_back({Entry::swatch, {IM_COL32(217, 15, 15, 255)}, "index list and stream differ"});
        out.push_back({Entry::swatch, {IM_COL32(236, 236, 236, 255)}, "they are the same"});
    }
    if (!state.facts.difference) return;
    out.push_back({Entry::text,
                   {},
                   fmt::format("{} of {} pixels differ", grouped(state.facts.difference->pixels),
                               grouped(state.facts.difference->covered))});
    out.push_back({Entry::text,
                   {},
                   state.facts.difference->triangles == 0
                       ? "all show the same triangle"
                       : fmt::format("{} show another triangle", grouped(state.facts.difference->triangles))});
}

std::vector<Entry> entries(const State& state, bool ring_line) {
    std::vector<Entry> out;
    if (state.choices.shown.mode != Mode::difference) {
        if (state.choices.paint == Paint::none) {
            add_view(state, ring_line, out);
        } else {
            add_paint(state, out);
        }
        if (state.choices.has_outlines()) out.push_back({Entry::line, {kLine}, "silhouettes, borders, creases"});
    }
    add_difference(state, out);
    return out;
}

// Nominal pixels before the text; between entries.
constexpr float kMark = 42, kBetween = 18;

float width_of(const Entry& entry) {
    return ImGui::CalcTextSize(entry.what.c_str()).x + (entry.kind == Entry::text ? 0 : px(kMark));
}

void draw(const Entry& entry, ImVec2 at) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float height = ImGui::GetTextLineHeight(), width = px(kMark) - px(8);
    const float top = at.y + px(2), bottom = at.y + height - px(1), middle = (top + bottom) / 2;
    const auto count = static_cast<float>(entry.colors.size());
    if (entry.kind == Entry::line) {
        list.AddRectFilled({at.x, top}, {at.x + width, bottom}, IM_COL32(222, 222, 218, 255), px(2));
        list.AddLine({at.x + px(1), middle}, {at.x + width - px(1), middle}, entry.colors[0], px(2));
    } else if (entry.kind == Entry::swatch) {
        for (std::size_t i = 0; i < entry.colors.size(); ++i) {
            const float from = at.x + width * static_cast<float>(i) / count;
            list.AddRectFilled({from, top}, {from + width / count, bottom}, entry.colors[i], count > 1 ? 0 : px(2));
        }
    } else if (entry.kind == Entry::ramp) {
        for (std::size_t i = 0; i + 1 < entry.colors.size(); ++i) {
            const float step = width / (count - 1), from = at.x + step * static_cast<float>(i);
            list.AddRectFilledMultiColor({from, top}, {from + step, bottom}, entry.colors[i], entry.colors[i + 1],
                                         entry.colors[i + 1], entry.colors[i]);
        }
    }
    ImGui::SetCursorScreenPos({at.x + (entry.kind == Entry::text ? 0 : px(kMark)), at.y});
    ImGui::TextUnformatted(entry.what.c_str());
}

}  // namespace

float draw_legend(const State& state, bool ring_line, float left, float right, float room) {
    const std::vector<Entry> all = entries(state, ring_line);
    if (all.empty()) return 0;
    ImGui::PushFont(small_font());
    // Place the entries from left to right, in as many lines as needed.
    const float line = ImGui::GetTextLineHeight() + px(3), padding = px(8);
    std::vector<ImVec2> places;
    ImVec2 at{left + padding, px(4)};
    for (const Entry& entry : all) {
        if (at.x > left + padding && at.x + width_of(entry) > right - padding) at = {left + padding, at.y + line};
        places.push_back(at);
        at.x += width_of(entry) + px(kBetween);
    }
    const float bottom = at.y + line + px(2);
    const bool fits = bottom <= room;
    if (fits) {
        ImGui::SetNextWindowPos({left, 0});
        ImGui::SetNextWindowSize({right - left, bottom});
        ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2{1, 1});
        ImGui::PushStyleColor(ImGuiCol_WindowBg, ImVec4{0.105F, 0.11F, 0.12F, 0.93F});
        ImGui::Begin("legend", nullptr,
                     ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoSavedSettings |
                         ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing |
                         ImGuiWindowFlags_NoBringToFrontOnFocus);
        for (std::size_t i = 0; i < all.size(); ++i) draw(all[i], places[i]);
        ImGui::End();
        ImGui::PopStyleColor();
        ImGui::PopStyleVar();
    }
    ImGui::PopFont();
    return fits ? bottom : 0;
}

}  // namespace lacedring::view
