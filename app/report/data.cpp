#include "app/report/data.h"

#include <fmt/format.h>

#include <algorithm>

#include "lrlab/rivals/strips.h"

namespace lacedring::app {
namespace {

std::string ring_text(const MeasuredFormat& format) {
    if (format.ring == nullptr) return {};
    std::string out = format.k == 0 ? "expander" : fmt::format("hybrid, k = {}", format.k);
    if (format.passes != 0) out += fmt::format(", {} pass{}", format.passes, format.passes == 1 ? "" : "es");
    return out;
}

}  // namespace

const FormatFigures* MeshReport::find(std::string_view name) const {
    const auto found = std::ranges::find(formats, name, &FormatFigures::name);
    return found == formats.end() ? nullptr : &*found;
}

Result<MeshReport> measure_mesh(const std::string& path, const LoadedMesh& loaded, const RingChoice& choice,
                                std::string& invalid) {
    const Mesh& mesh = loaded.mesh;
    const Mesh surface = surface_mesh(mesh, loaded.surface);
    MeshReport out;
    out.path = path;
    out.triangles = mesh.triangle_count();
    out.vertices = surface.vertex_count;
    out.copies = mesh.vertex_count;
    {
        Result<FormatSet> set = make_formats(mesh, loaded.surface, choice);
        if (!set) return set.error();
        const double triangles = set->triangles();
        const auto base = static_cast<double>(set->formats.front().bytes);
        for (const MeasuredFormat& format : set->formats) {
            if (invalid.empty() && !format.invalid.empty()) invalid = format.name + ": " + format.invalid;
            FormatFigures& figures = out.formats.emplace_back();
            const auto bytes = static_cast<double>(format.bytes);
            figures.name = format.name;
            figures.bytes = format.bytes;
            figures.deflated = format.deflated;
            figures.bits = 8 * bytes / triangles;
            figures.references = static_cast<double>(format.references) / triangles;
            figures.share = 100 * bytes / base;
            figures.cache = analyze_fifo32(format.indices, format.vertex_count(set->vertices));
            figures.ring = ring_text(format);
        }
        out.report = set->report;
        out.topology = set->topology;
        out.lean = set->lean;
        out.best_order = set->best_order;
        out.absent = std::move(set->absent);
    }
    if (!invalid.empty()) return out;
    if (auto periods = figures_by_period(surface, compact_ring_options(choice), kFigure8Periods)) {
        out.periods = std::move(*periods);
    } else {
        out.no_periods = periods.error().message;
    }
    return out;
}

}  // namespace lacedring::app
