// Right: sizes and times. Bottom: the selected corner.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <vector>

#include "app/formats.h"
#include "app/view/panels.h"
#include "app/view/theme.h"

namespace lr::view {
namespace {

void row(const char* name, const std::string& value) {
    ImGui::TextDisabled("%s", name);
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(value.c_str()).x);
    ImGui::TextUnformatted(value.c_str());
}

void draw_ring_figures(const State& state) {
    heading(state.shown.source == gpu::Source::plain    ? "Index list"
            : state.shown.source == gpu::Source::packed ? "Packed stream"
                                                        : "Lean stream");
    if (!state.document) {
        ImGui::TextDisabled("no mesh");
        return;
    }
    const Document& document = *state.document;
    const bool packed = state.shown.source == gpu::Source::packed && document.packed.bytes != 0;
    const bool plain = state.shown.source == gpu::Source::plain;
    const StreamFigures& figures = plain ? document.plain : packed ? document.packed : document.lean;
    const LeanStatistics& ring = document.model->lean.statistics;
    if (figures.references > 0) row("references per triangle", fmt::format("{:.3f}", figures.references));
    row("bits per triangle", fmt::format("{:.2f}", figures.bits));
    row("bytes", grouped(figures.bytes));
    row("ACMR, FIFO of 32", fmt::format("{:.3f}", figures.acmr));
    row("T0", fmt::format("{} ({:.2f} %)", grouped(ring.t0), 100 * document.t0_share()));
    row("isolated vertices", grouped(ring.isolated));
    row("optimised",
        document.optimised && document.settings.passes > 0 ? fmt::format("{} passes", document.settings.passes) : "no");
    row("made in", fmt::format("{:.2f} s", document.seconds));
}

void plot(const char* name, const State& state, float FrameCost::*member) {
    std::vector<float> values;
    for (const FrameCost& cost : state.costs) values.push_back(cost.*member);
    const float last = values.empty() ? 0 : values.back();
    const float most = values.empty() ? 1 : *std::max_element(values.begin(), values.end());
    row(name, values.empty() ? "-" : fmt::format("{:.2f} ms, at most {:.2f}", last, most));
    ImGui::PushID(name);
    ImGui::PlotLines("##", values.data(), static_cast<int>(values.size()), 0, nullptr, 0, most * 1.1F, {-1, px(12)});
    ImGui::PopID();
}

void draw_times(const State& state) {
    heading("Time of a frame");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", state.device.c_str());
    plot("decode, GPU", state, &FrameCost::decode);
    plot("draw, GPU", state, &FrameCost::draw);
    plot("record, CPU", state, &FrameCost::cpu);
    row("device memory", bytes_text(state.device_bytes));
}

void draw_formats(const State& state) {
    heading("Bits per triangle, every format");
    if (!state.formats || !state.document) {
        ImGui::TextDisabled("%s", state.document ? "being measured" : "no mesh");
        return;
    }
    struct Bar {
        std::string name;
        double bits;
        std::size_t bytes;
        bool ours;
    };
    std::vector<Bar> bars;
    for (const app::Format& format : state.formats->formats) {
        const double bits =
            8.0 * static_cast<double>(format.bytes) / static_cast<double>(state.document->mesh->triangle_count());
        const bool ours = format.name.starts_with("l") || format.name.starts_with("packed");
        bars.push_back({format.name, bits, format.bytes, ours});
    }
    std::stable_sort(bars.begin(), bars.end(), [](const Bar& a, const Bar& b) { return a.bits < b.bits; });
    const float name_width = px(158), text_width = px(52);
    constexpr double kMost = 96;  // an index list of 32 bits: a longer bar is cut, its number is not
    for (const Bar& bar : bars) {
        if (bar.ours) {
            ImGui::TextUnformatted(bar.name.c_str());
        } else {
            ImGui::TextDisabled("%s", bar.name.c_str());
        }
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s bytes", grouped(bar.bytes).c_str());
        ImGui::SameLine(name_width);
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float room = ImGui::GetContentRegionAvail().x - text_width;
        const float height = ImGui::GetTextLineHeight();
        const float length = std::max(px(1.5F), room * static_cast<float>(std::min(1.0, bar.bits / kMost)));
        ImGui::GetWindowDrawList()->AddRectFilled(
            {at.x, at.y + px(3)}, {at.x + length, at.y + height - px(2)},
            ImGui::GetColorU32(bar.ours ? ImGuiCol_PlotHistogram : ImGuiCol_ScrollbarGrab), px(2));
        const std::string text = fmt::format("{:.2f}", bar.bits);
        ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(text.c_str()).x);
        ImGui::TextUnformatted(text.c_str());
    }
}

}  // namespace

void draw_numbers(State& state) {
    draw_ring_figures(state);
    if (state.difference) {
        heading("Plain against stream");
        row("pixels that differ", grouped(state.difference->pixels));
        row("triangles that differ", grouped(state.difference->triangles));
        row("pixels covered", grouped(state.difference->covered));
    }
    draw_times(state);
    draw_formats(state);
}

}  // namespace lr::view
