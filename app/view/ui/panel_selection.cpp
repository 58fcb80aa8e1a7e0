// The box of the selection: the selected corner, the results of the operators, and its triangle in the streams.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <string>

#include "app/view/ui/panels.h"
#include "app/view/window/theme.h"
#include "lacedring/streams.hpp"

namespace lacedring::view {
namespace {

ImVec4 color(std::uint32_t rgba) {
    return ImGui::ColorConvertU32ToFloat4(rgba | 0xff000000U);
}

/// The slot of the lean stream that holds a triangle, its word and its vertices, as text.
std::string lean_text(const Document& document, std::uint32_t t) {
    const gpu::Model& model = *document.model;
    const LeanView& view = document.views.lean;
    const auto at = std::find(model.lean.slot_triangle.begin(), model.lean.slot_triangle.end(), t);
    if (at == model.lean.slot_triangle.end()) return "in no slot";
    const auto slot = static_cast<std::uint32_t>(at - model.lean.slot_triangle.begin());
    const Triangle found = decode_lean_slot(view, slot);
    const std::string vertices = fmt::format("({}, {}, {})", found.v[0], found.v[1], found.v[2]);
    if (slot >= view.ring_slots()) {
        return fmt::format("slot {}: verbatim, a T0: {}", slot, vertices);
    }
    const std::uint32_t word = view.payload[slot];
    if (slot < 2 * view.rings2) {
        return fmt::format("slot {}: {}[{}], word {:08x}: {}", slot, slot % 2 == 0 ? 'L' : 'R', slot / 2, word,
                           vertices);
    }
    return fmt::format("slot {}: one side of ring vertex {}, word {:08x}: {}", slot, slot - view.rings2, word,
                       vertices);
}

std::string packed_text(const Document& document, std::uint32_t t) {
    const gpu::Model& model = *document.model;
    if (model.packed.words.empty()) return "not made";
    const auto at = std::find(model.packed.triangle_order.begin(), model.packed.triangle_order.end(), t);
    if (at == model.packed.triangle_order.end()) return "";
    const auto i = static_cast<std::uint32_t>(at - model.packed.triangle_order.begin());
    const Triangle found = decode_packed_triangle(document.views.packed, i);
    return fmt::format("triangle {} of block {}: ({}, {}, {})", i % 256, i / 256, found.v[0], found.v[1], found.v[2]);
}

void cell(const std::string& text) {
    ImGui::TableNextColumn();
    const float room = ImGui::GetContentRegionAvail().x, width = ImGui::CalcTextSize(text.c_str()).x;
    if (width < room) ImGui::SetCursorPosX(ImGui::GetCursorPosX() + room - width);
    ImGui::TextUnformatted(text.c_str());
}

/// Draws a line of the table: the letter that marks the corner on the surface, the operator's name, and the numbers of
/// corner, triangle and vertex.
void line(const Document& document, const char* letter, const char* name, std::uint32_t rgba, CornerId c,
          const char* explained) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextColored(color(rgba), "%s", letter);
    ImGui::TableNextColumn();
    ImGui::TextColored(color(rgba), "%s", name);
    explain(explained);
    if (c.is_null()) {
        cell("border");
        return;
    }
    cell(std::to_string(c.value));
    cell(std::to_string(triangle(c).value));
    cell(std::to_string(document.table->vertex(c).value));
}

void draw_operators(const Document& document, CornerId c) {
    const CornerTable& table = *document.table;
    const std::uint32_t gray = 0xffb4b0aeU;
    if (!ImGui::BeginTable("operators", 5, ImGuiTableFlags_SizingFixedFit)) return;
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TableNextColumn();
    for (const char* name : {"corner", "triangle", "vertex"}) {
        ImGui::TableNextColumn();
        ImGui::TextDisabled("  %s", name);
    }
    line(document, "c", "selected", kSelectedColor, c, "The corner nearest to where you clicked");
    line(document, "n", "next", gray, next(c), "The next corner of the triangle, counterclockwise. Key N");
    line(document, "p", "previous", gray, previous(c), "The previous corner of the triangle, clockwise. Key P");
    line(document, "o", "opposite", kOppositeColor, table.opposite(c),
         "The corner of the neighbor across the edge that faces the selected corner. Key O");
    line(document, "l", "left", kLeftColor, table.left(c), "The next corner's opposite. Key L");
    line(document, "r", "right", kRightColor, table.right(c), "The previous corner's opposite. Key R");
    line(document, "s", "swing", kFanColor, table.swing(c),
         "The corner of the next triangle around the same vertex. All triangles around it are violet. Key S");
    ImGui::EndTable();
}

void draw_streams(const State& state, CornerId c) {
    const Document& document = *state.facts.document;
    const auto part = [](const char* name, const std::string& text, const char* explained) {
        ImGui::TextDisabled("%s", name);
        explain(explained);
        ImGui::PushFont(small_font());
        ImGui::PushTextWrapPos(0);
        ImGui::TextUnformatted(text.c_str());
        ImGui::PopTextWrapPos();
        ImGui::PopFont();
    };
    const std::size_t fan = around(*document.table, c).size();
    ImGui::TextDisabled("%zu triangle%s around the vertex", fan, fan == 1 ? "" : "s");
    if (document.surface->has_seams()) {
        part("vertex copy", fmt::format("{} of {}", document.copy_at(c), document.mesh->vertex_count),
             "The file's vertex at this corner, with its normal, texture coordinates and so on. Across a seam, corners "
             "of the same vertex have another copy");
    }
    part("LR tables hold", state.facts.tables ? lr_text(*state.facts.tables, *document.table, c) : "being made",
         "In the tables' own numbers. L[v] and R[v] are the triangles left and right of ring edge v, VO the T0 "
         "triangles");
    part("lean holds", lean_text(document, triangle(c).value),
         "Vertices in ring order. Slot 2v is the triangle left of ring edge v, slot 2v + 1 the one right of it");
    part("packed holds", packed_text(document, triangle(c).value),
         "Vertices in ring order. A block is 256 triangles that decode on their own");
}

}  // namespace

void draw_selection(const State& state) {
    const CornerId c = state.facts.selection.corner;
    // Beside each other if there is room.
    const float width = ImGui::GetContentRegionAvail().x;
    if (width < px(560)) {
        draw_operators(*state.facts.document, c);
        draw_streams(state, c);
        return;
    }
    ImGui::BeginGroup();
    draw_operators(*state.facts.document, c);
    ImGui::EndGroup();
    ImGui::SameLine(px(310));
    ImGui::BeginGroup();
    draw_streams(state, c);
    ImGui::EndGroup();
}

}  // namespace lacedring::view
