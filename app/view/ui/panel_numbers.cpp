// The right panel: sizes, times and memory.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <string>
#include <vector>

#include "app/bench/measure.h"
#include "app/formats/formats.h"
#include "app/formats/notes.h"
#include "app/view/ui/panels.h"
#include "app/view/window/theme.h"
#include "lacedring/lacedring.hpp"

namespace lacedring::view {
namespace {

// Panels of at least this height, in nominal pixels, have tall plots.
constexpr float kTall = 780;

/// Writes at the right edge of the panel.
void at_right(const std::string& text) {
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(text.c_str()).x);
    ImGui::TextUnformatted(text.c_str());
}

void row(const char* name, const std::string& value, const char* explained) {
    ImGui::TextDisabled("%s", name);
    explain(explained);
    at_right(value);
}

void draw_stream_figures(const State& state) {
    const bool plain = state.choices.shown.source == gpu::Source::plain;
    const bool packed = state.choices.shown.source == gpu::Source::packed && state.facts.document &&
                        state.facts.document->packed.bytes != 0;
    heading(plain    ? "Index list"
            : packed ? "Packed stream"
                     : "Lean stream",
            "The connectivity on the screen, with the ring chosen on the left");
    if (!state.facts.document) {
        ImGui::TextDisabled("no mesh");
        return;
    }
    const Document& document = *state.facts.document;
    if (document.stand_in != 0) {
        ImGui::TextDisabled("being made");
        return;
    }
    const StreamFigures& figures = plain ? document.plain : packed ? document.packed : document.lean;
    row("bits per triangle", fmt::format("{:.2f}", figures.bits),
        "Bits of connectivity, headers included, per triangle of the file");
    if (figures.references > 0) {
        row("references per triangle", fmt::format("{:.3f}", figures.references),
            "Stored vertex numbers per triangle of the file. An index list has three");
    }
    row("bytes", grouped(figures.bytes), "Connectivity only: positions and other attributes are not counted");
    if (const EncodedSeams* seams = gpu::seams_of(*document.model, state.choices.shown.source)) {
        row("seams, bits per triangle", fmt::format("{:.2f}", document.bits_per_triangle(4 * seams->words.size())),
            "In addition to the connectivity of the surface: which copy of its vertex each corner has. The view Seams "
            "shows them");
    }
    row("ACMR, FIFO of 32", fmt::format("{:.3f}", figures.acmr),
        "Average cache miss ratio: vertices transformed per triangle, in the stream's order, with a cache of the last "
        "32 vertices. 0.5 is the least, 3 the most");
    if (!plain && !packed) {
        const LeanStatistics& ring = document.model->lean.statistics;
        row("T0 triangles", fmt::format("{} ({:.2f} %)", grouped(ring.t0), 100 * document.t0_share()),
            "Triangles without an edge on the ring: the ring bifurcates there. They are stored in full");
        row("isolated vertices", grouped(ring.isolated), "Vertices that the ring does not pass through");
    }
    if (!plain) {
        row("made in", fmt::format("{:.2f} s", document.seconds),
            "Time from the request until these streams were made: reading, rings, passes of the optimizer");
        row("optimizer",
            !document.optimized              ? "not yet"
            : document.settings.passes == 0  ? "off"
            : document.settings.passes == 1u ? "1 pass"
                                             : fmt::format("{} passes", document.settings.passes),
            "Passes of the optimizer over the ring, which lower the number of T0 triangles");
    }
}

/// Draws bars of the last frames, the newest on the right.
void plot(ImVec2 at, ImVec2 size, const State& state, float FrameCost::*member, float most) {
    constexpr int kFrames = 120;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, ImGui::GetColorU32(ImGuiCol_FrameBg), px(2));
    const float step = size.x / kFrames;
    float right = at.x + size.x;
    for (auto cost = state.facts.costs.rbegin(); cost != state.facts.costs.rend() && right > at.x + step / 2; ++cost) {
        const float height = most > 0 ? (*cost).*member / most * (size.y - px(2)) : 0;
        list.AddRectFilled({right - step, at.y + size.y - std::max(px(1), height)}, {right, at.y + size.y},
                           ImGui::GetColorU32(ImGuiCol_PlotHistogram));
        right -= step;
    }
}

void time_row(const char* name, const State& state, float FrameCost::*member, const char* explained, bool tall) {
    float most = 0, sum = 0;
    for (const FrameCost& cost : state.facts.costs) {
        most = std::max(most, cost.*member);
        sum += cost.*member;
    }
    const float ms = state.facts.costs.empty() ? 0 : state.facts.costs.back().*member;
    const std::string last = state.facts.costs.empty() ? "-"
                             : ms < 1000               ? fmt::format("{:.2f} ms", ms)
                                                       : fmt::format("{:.2f} s", ms / 1000);
    ImGui::TextDisabled("%s", name);
    const auto frames = static_cast<float>(std::max<std::size_t>(1, state.facts.costs.size()));
    explain(fmt::format("{}.\nThe last {} newly drawn frames: {:.2f} ms on average, at most {:.2f}", explained,
                        state.facts.costs.size(), sum / frames, most)
                .c_str());
    if (tall) {
        at_right(last);
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const ImVec2 size{ImGui::GetContentRegionAvail().x, px(34)};
        plot(at, size, state, member, most);
        ImGui::Dummy({size.x, size.y});
        return;
    }
    const float left = px(104), right = ImGui::GetWindowContentRegionMax().x - px(84);
    ImGui::SameLine(left);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    plot({at.x, at.y - px(1)}, {right - left, ImGui::GetTextLineHeight() + px(2)}, state, member, most);
    ImGui::Dummy({right - left, ImGui::GetTextLineHeight()});
    at_right(last);
}

void draw_times(const State& state) {
    heading("Time of a frame", state.facts.device.c_str());
    const bool tall = ImGui::GetWindowHeight() > px(kTall);
    time_row("decode, GPU", state, &FrameCost::decode,
             "Expanding the stream on the device: once, or in every frame if chosen on the left", tall);
    time_row("draw, GPU", state, &FrameCost::draw, "Drawing the mesh on the device", tall);
    time_row("CPU", state, &FrameCost::cpu,
             "The program's own time to record a frame's commands, without waiting for the device", tall);
    row("device memory", bytes_text(state.facts.device_bytes),
        fmt::format("Vulkan memory in use for meshes, streams and pictures; {} are allocated",
                    bytes_text(state.facts.device_held))
            .c_str());
    const std::size_t host = app::resident_bytes();
    row("host memory", host == 0 ? "-" : bytes_text(host), "Main memory that the whole program takes");
}

struct Bar {
    const app::MeasuredFormat* format;
    std::size_t bytes;
    double bits;
};

/// Draws a format's figures, and below them a bar of its bits.
void draw_format(const Bar& bar, float bits_at, float bytes_at) {
    const app::FormatNote note = app::note_on(bar.format->name);
    const bool baseline = note.origin == app::Origin::baseline;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, height = ImGui::GetTextLineHeight();
    // Bits of a 32-bit index list; longer bars are cut.
    constexpr double kMost = 96;
    const float length = std::max(px(1.5F), width * static_cast<float>(std::min(1.0, bar.bits / kMost)));
    const auto put = [&](const std::string& text, float right, ImGuiCol color) {
        ImGui::SameLine(right - ImGui::CalcTextSize(text.c_str()).x);
        ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyle().Colors[color]);
        ImGui::TextUnformatted(text.c_str());
        ImGui::PopStyleColor();
    };
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyle().Colors[baseline ? ImGuiCol_TextDisabled : ImGuiCol_Text]);
    ImGui::TextUnformatted(bar.format->name.c_str());
    ImGui::PopStyleColor();
    const std::string recommended =
        bar.bytes == bar.format->bytes
            ? ""
            : fmt::format(". With the ring on the screen; the recommended ring takes {} bytes",
                          grouped(bar.format->bytes));
    explain(fmt::format("{}: {}{}", bar.format->name, note.what, recommended).c_str());
    put(grouped(bar.bytes), bytes_at, ImGuiCol_TextDisabled);
    put(fmt::format("{:.2f}", bar.bits), bits_at, ImGuiCol_Text);
    const float y = at.y + height;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled({at.x, y}, {at.x + width, y + px(3)}, ImGui::GetColorU32(ImGuiCol_FrameBg));
    list.AddRectFilled({at.x, y}, {at.x + length, y + px(3)},
                       baseline ? IM_COL32(128, 131, 138, 255) : ImGui::GetColorU32(ImGuiCol_PlotHistogram));
}

void draw_formats(const State& state) {
    const float bits_at = ImGui::GetWindowContentRegionMax().x, bytes_at = bits_at - px(62);
    ImGui::Dummy({0, px(1)});
    ImGui::TextColored(ImGui::GetStyle().Colors[ImGuiCol_CheckMark], "Every format");
    explain(
        "Bytes of connectivity, and bits per triangle of the file. Lean and packed: with the ring on the screen. "
        "Others: with the ring recommended for the format, as in `lacedring stats`. Orange: LR, lean and packed. Gray: "
        "baselines. Bars end at 96 bits");
    if (state.facts.formats && state.facts.document) {
        ImGui::PushFont(small_font());
        for (const auto& [text, right] : {std::pair{"bytes", bytes_at}, std::pair{"bits/tri.", bits_at}}) {
            ImGui::SameLine(right - ImGui::CalcTextSize(text).x);
            ImGui::TextDisabled("%s", text);
        }
        ImGui::PopFont();
    }
    ImGui::Separator();
    if (!state.facts.formats || !state.facts.document) {
        ImGui::TextDisabled("%s", state.facts.document ? "being measured" : "no mesh");
        return;
    }
    // For lean and packed, show the size with the ring on the screen, as everywhere on the panel.
    const Document& document = *state.facts.document;
    std::vector<Bar> bars;
    for (const app::MeasuredFormat& format : state.facts.formats->formats) {
        std::size_t bytes = format.bytes;
        if (format.name == "lean") bytes = document.lean.bytes;
        if (format.name == "packed" && document.packed.bytes != 0) bytes = document.packed.bytes;
        bars.push_back({&format, bytes, document.bits_per_triangle(bytes)});
    }
    std::stable_sort(bars.begin(), bars.end(), [](const Bar& a, const Bar& b) { return a.bits < b.bits; });
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{px(8), px(6)});
    for (const Bar& bar : bars) draw_format(bar, bits_at, bytes_at);
    ImGui::PopStyleVar();
}

}  // namespace

void draw_numbers(State& state) {
    draw_stream_figures(state);
    draw_times(state);
    draw_formats(state);
}

}  // namespace lacedring::view
