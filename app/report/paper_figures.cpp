// Implements figures_by_period and figures_by_seeds of paper_tables.h.

#include <algorithm>

#include "app/report/paper_tables.h"
#include "lacedring/lacedring.hpp"
#include "lacedring/streams.hpp"
#include "lacedring/topology.hpp"
#include "lrlab/rivals/strips.h"

namespace lacedring::app {
namespace {

double encoded_triangles(const CornerTable& table) {
    return std::max(1.0, static_cast<double>(table.triangle_count() - table.topology.degenerate));
}

}  // namespace

Result<std::vector<PeriodFigures>> figures_by_period(const Mesh& mesh, RingOptions ring,
                                                     std::span<const std::uint32_t> periods) {
    const Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
    if (!table) return table.error();
    CornerTable split = *table;
    split_fans(split);
    const double triangles = encoded_triangles(*table);
    std::vector<PeriodFigures> out;
    for (const std::uint32_t k : periods) {
        PeriodFigures& figures = out.emplace_back();
        figures.k = ring.k = k;
        figures.triangles = triangles;
        ring.one_per_shell = true;
        const Result<LrTable> lr = build_lr(split, expand_rings(split, ring));
        if (!lr) return lr.error();
        figures.offsets = count_offsets(lr->view());
        figures.lr_references = static_cast<double>(lr->view().references()) / triangles;
        const Result<CompactLrTable> compact = build_compact_lr(lr->view());
        if (!compact) return compact.error();
        figures.compact_bits = 8 * static_cast<double>(compact->view().bytes()) / triangles;

        ring.one_per_shell = false;
        const Result<EncodedLean> lean = encode_lean(*table, expand_rings(*table, ring));
        if (!lean) return lean.error();
        const Result<LeanView> view = view_lean(lean->words);
        if (!view) return view.error();
        figures.lean_references = static_cast<double>(view->references()) / triangles;
        std::vector<std::uint32_t> indices(std::size_t{3} * view->slots());
        decode_lean(*view, indices);
        figures.acmr16 = analyze_fifo(indices, mesh.vertex_count, 16).acmr;
        figures.acmr32 = analyze_fifo(indices, mesh.vertex_count, 32).acmr;
        const std::span ring_part(indices.data(), std::size_t{3} * view->ring_slots());
        figures.acmr32_ring = analyze_fifo(ring_part, mesh.vertex_count, 32).acmr;
    }
    return out;
}

Result<SeedRow> figures_by_seeds(const std::string& path, const Mesh& mesh, RingOptions ring) {
    Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
    if (!table) return table.error();
    split_fans(*table);
    ring.one_per_shell = true;
    SeedRow out{path, 0, mesh.triangle_count(), {}};
    for (const std::uint32_t seeds : kSeedCounts) {
        ring.seeds = seeds;
        const Result<LrTable> lr = build_lr(*table, expand_rings(*table, ring));
        if (!lr) return lr.error();
        out.vertices = lr->view().used_vertices();
        out.figures.push_back({seeds, lr->statistics.isolated, lr->statistics.t0,
                               static_cast<double>(lr->view().references()) / encoded_triangles(*table)});
    }
    return out;
}

}  // namespace lacedring::app
