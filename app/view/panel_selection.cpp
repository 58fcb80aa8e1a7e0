// Bottom: the selected corner, what the operators say of it, and what streams hold of its triangle.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "app/view/panels.h"
#include "app/view/theme.h"
#include "lrcore/lean/lean_stream.h"

namespace lr::view {
namespace {

ImVec4 colour(std::uint32_t rgba) {
    return ImGui::ColorConvertU32ToFloat4(rgba | 0xff000000U);
}

std::string corner_text(const Document& document, CornerId c) {
    if (c.is_null()) return "border";
    return fmt::format("{} (triangle {}, vertex {})", c.value, triangle(c).value, document.table->vertex(c).value);
}

/// "L[12] = 34": the slots of the lean stream that hold a triangle.
std::string lean_text(const gpu::Model& model, std::uint32_t t) {
    const Result<LeanView> view = view_lean(model.lean.words);
    if (!view) return "";
    const auto at = std::find(model.lean.slot_triangle.begin(), model.lean.slot_triangle.end(), t);
    if (at == model.lean.slot_triangle.end()) return "in no slot";
    const auto slot = static_cast<std::uint32_t>(at - model.lean.slot_triangle.begin());
    const LeanTriangle found = decode_lean_slot(*view, slot);
    const std::string vertices = fmt::format("({}, {}, {})", found.v[0], found.v[1], found.v[2]);
    if (slot >= view->ring_slots()) {
        return fmt::format("slot {}: verbatim, a T0: {}", slot, vertices);
    }
    const std::uint32_t word = view->payload[slot];
    if (slot < 2 * view->rings2) {
        return fmt::format("slot {}: {}[{}], word {:08x}: {}", slot, slot % 2 == 0 ? 'L' : 'R', slot / 2, word,
                           vertices);
    }
    return fmt::format("slot {}: one side of ring vertex {}, word {:08x}: {}", slot, slot - view->rings2, word,
                       vertices);
}

std::string packed_text(const gpu::Model& model, std::uint32_t t) {
    const Result<PackedView> view = view_packed(model.packed.words);
    if (!view) return "not made";
    const auto at = std::find(model.packed.triangle_order.begin(), model.packed.triangle_order.end(), t);
    if (at == model.packed.triangle_order.end()) return "";
    const auto i = static_cast<std::uint32_t>(at - model.packed.triangle_order.begin());
    const PackedTriangle found = decode_packed_triangle(*view, i);
    return fmt::format("triangle {} of block {}: ({}, {}, {})", i % 256, i / 256, found.v[0], found.v[1], found.v[2]);
}

void line(const char* name, std::uint32_t rgba, const std::string& text) {
    ImGui::TextColored(colour(rgba), "%s", name);
    ImGui::SameLine(px(86));
    ImGui::TextUnformatted(text.c_str());
}

}  // namespace

void draw_selection(const State& state) {
    const Document& document = *state.document;
    const CornerTable& table = *document.table;
    const CornerId c = state.selection.corner;
    line("corner", kSelectedColour, corner_text(document, c));
    line("opposite", kOppositeColour, corner_text(document, table.opposite(c)));
    line("left", kLeftColour, corner_text(document, table.left(c)));
    line("right", kRightColour, corner_text(document, table.right(c)));
    line("swing", kFanColour,
         fmt::format("{}; {} triangles around the vertex", corner_text(document, table.swing(c)),
                     around(table, c).size()));
    const std::uint32_t grey = 0xffa09a98U;
    line("lr", grey, state.tables ? lr_text(*state.tables, table, c) : "being made");
    line("lean", grey, lean_text(*document.model, triangle(c).value));
    line("packed", grey, packed_text(*document.model, triangle(c).value));
}

}  // namespace lr::view
