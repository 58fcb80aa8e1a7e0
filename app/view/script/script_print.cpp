// What the line `print` of a script says.
#include <nlohmann/json.hpp>

#include "app/formats/formats.h"
#include "app/view/script/script.h"
#include "app/view/ui/panels.h"

namespace lacedring::view {

std::string Script::state_text(Viewer& viewer) {
    const State& state = viewer.state();
    nlohmann::ordered_json out{{"file", state.document ? state.document->path : ""},
                               {"error", state.error},
                               {"note", state.note},
                               {"busy", state.progress.busy},
                               {"camera", viewer.orbit().text()},
                               {"size", {viewer.extent().width, viewer.extent().height}},
                               {"title", viewer.title()},
                               {"window", {viewer.window().width, viewer.window().height}}};
    out["fps"] = state.frame_cap;
    if (state.document) out["growth"] = {state.growth, state.growth_end()};
    out["start"] =
        state.ring.start.is_null() ? nlohmann::ordered_json() : nlohmann::ordered_json(state.ring.start.value);
    if (state.document) {
        const Document& document = *state.document;
        out["triangles"] = document.mesh->triangle_count();
        out["optimised"] = document.optimised;
        out["seconds"] = document.seconds;
        out["first_seconds"] = state.first_seconds;
        out["shown_seconds"] = state.shown_seconds;
        out["t0"] = document.model->lean.statistics.t0;
        out["lean_bits"] = document.lean.bits;
        out["packed_bits"] = document.packed.bits;
    }
    if (state.selection.any()) {
        const CornerId c = state.selection.corner;
        out["corner"] = c.value;
        out["triangle"] = triangle(c).value;
        if (state.tables) {
            // The tables' answers, and the corner table's.
            for (const char operation : {'n', 'p', 'o', 's', 'l', 'r'}) {
                const CornerId by_lr = lr_step(*state.tables, *state.document->table, c, operation);
                const CornerId by_table = step(*state.document, c, operation);
                out["operators"][std::string(1, operation)] = {by_lr.value, by_table.value};
            }
        }
    }
    if (state.difference) {
        out["difference"] = {{"pixels", state.difference->pixels},
                             {"triangles", state.difference->triangles},
                             {"covered", state.difference->covered}};
    }
    out["started_ms"] = state.started * 1e3;
    out["longest_frame_ms"] = state.longest_frame * 1e3;  // since the last such line
    const State::Shaders& shaders = state.shaders;
    out["shaders"] = {{"folder", shaders.folder},
                      {"compiled", shaders.compiled},
                      {"reloads", shaders.reloads},
                      {"replaced", shaders.replaced},
                      {"error", shaders.error}};
    if (!state.costs.empty()) {
        out["draw_ms"] = state.costs.back().draw;
        out["decode_ms"] = state.costs.back().decode;
        out["cpu_ms"] = state.costs.back().cpu;
        out["frame_ms"] = state.frame_seconds * 1e3;
    }
    if (state.formats) {
        for (const app::MeasuredFormat& format : state.formats->formats) out["formats"][format.name] = format.bytes;
    }
    for (const PanelBox& box : panel_boxes()) {
        out["panels"].push_back({{"name", box.name},
                                 {"box", {box.x, box.y, box.width, box.height}},
                                 {"hidden", {box.hidden_right, box.hidden_below}}});
    }
    return out.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace lacedring::view
