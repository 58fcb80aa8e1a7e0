// The viewer's state as JSON, for the line `print` of a script.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/formats/formats.h"
#include "app/view/script/script.h"
#include "app/view/ui/panels.h"
#include "app/view/ui/settings.h"

namespace lacedring::view {

std::string state_text(Viewer& viewer) {
    const State& state = viewer.state();
    nlohmann::ordered_json out{{"file", state.facts.document ? state.facts.document->path : ""},
                               {"error", state.facts.error},
                               {"note", state.facts.note},
                               {"busy", state.facts.progress.busy},
                               {"camera", viewer.orbit().text()},
                               {"size", {viewer.extent().width, viewer.extent().height}},
                               {"title", viewer.title()},
                               {"window", {viewer.window().width, viewer.window().height}}};
    for (const Setting& setting : settings()) {
        const double value = setting.get(state.choices);
        const auto at = std::ranges::find(setting.values, value, &NamedValue::value);
        out["choices"][setting.name] =
            at == setting.values.end() ? nlohmann::ordered_json(value) : nlohmann::ordered_json(at->name);
    }
    out["fps"] = state.choices.frame_cap;
    out["samples"] = viewer.scene().drawn().samples;
    out["ring_line"] = viewer.scene().has_ring_line();
    if (state.facts.document) out["growth"] = {state.choices.growth, state.facts.growth_end()};
    out["start"] = state.choices.ring.start.is_null() ? nlohmann::ordered_json()
                                                      : nlohmann::ordered_json(state.choices.ring.start.value);
    if (state.facts.document) {
        const Document& document = *state.facts.document;
        out["triangles"] = document.mesh->triangle_count();
        out["optimized"] = document.optimized;
        out["seconds"] = document.seconds;
        out["first_seconds"] = state.facts.first_seconds;
        out["shown_seconds"] = state.facts.shown_seconds;
        out["t0"] = document.model->lean.statistics.t0;
        out["rings"] = document.rings->count();
        out["components"] = document.report.components;
        out["borders"] = document.report.border_loops;
        out["genus"] = document.report.genus;
        out["copies"] = document.surface->has_seams() ? document.mesh->vertex_count : 0;
        out["stand_in"] = document.stand_in;
        out["lean_bits"] = document.lean.bits;
        out["packed_bits"] = document.packed.bits;
    }
    if (state.facts.selection.any()) {
        const CornerId c = state.facts.selection.corner;
        out["corner"] = c.value;
        out["triangle"] = triangle(c).value;
        if (state.facts.tables) {
            // Results by the LR tables, and by the corner table.
            for (const char operation : {'n', 'p', 'o', 's', 'l', 'r'}) {
                const CornerId by_lr = lr_step(*state.facts.tables, *state.facts.document->table, c, operation);
                const CornerId by_table = step(*state.facts.document, c, operation);
                out["operators"][std::string(1, operation)] = {by_lr.value, by_table.value};
            }
        }
    }
    if (state.facts.difference) {
        out["difference"] = {{"pixels", state.facts.difference->pixels},
                             {"triangles", state.facts.difference->triangles},
                             {"covered", state.facts.difference->covered}};
    }
    out["started_ms"] = state.facts.started * 1e3;
    out["longest_frame_ms"] = state.facts.longest_frame * 1e3;  // since the last `print`
    const ShaderFacts& shaders = state.facts.shaders;
    out["shaders"] = {{"folder", shaders.folder},
                      {"compiled", shaders.compiled},
                      {"reloads", shaders.reloads},
                      {"replaced", shaders.replaced},
                      {"error", shaders.error}};
    if (!state.facts.costs.empty()) {
        out["draw_ms"] = state.facts.costs.back().draw;
        out["decode_ms"] = state.facts.costs.back().decode;
        out["cpu_ms"] = state.facts.costs.back().cpu;
        out["frame_ms"] = state.facts.frame_seconds * 1e3;
    }
    if (state.facts.formats) {
        for (const app::MeasuredFormat& format : state.facts.formats->formats)
            out["formats"][format.name] = format.bytes;
    }
    for (const PanelBox& box : panel_boxes()) {
        out["panels"].push_back({{"name", box.name},
                                 {"box", {box.x, box.y, box.width, box.height}},
                                 {"hidden", {box.hidden_right, box.hidden_below}}});
    }
    return out.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace lacedring::view
