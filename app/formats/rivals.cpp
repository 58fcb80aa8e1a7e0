#include "app/formats/rivals.h"

#include <fmt/format.h>

#include <algorithm>

#include "lacedring/topology.hpp"
#include "lrlab/rivals/codecs.h"
#include "lrlab/rivals/compressors.h"
#include "lrlab/rivals/corner_table_c.h"
#include "lrlab/rivals/squad.h"
#include "lrlab/rivals/strips.h"
#include "lrlab/rivals/winged_edge.h"

namespace lacedring::app {
namespace {

/// Finds the vertex of each corner by walking each star once; UINT32_MAX if no star contains the corner.
std::vector<std::uint32_t> vertices_by_stars(const SquadView& view) {
    std::vector<std::uint32_t> out(std::size_t{4} * view.triangle_numbers(), UINT32_MAX);
    for (std::uint32_t v = 0; v < view.vertices; ++v) view.star(VertexId{v}, [&](CornerId c) { out[c.value] = v; });
    return out;
}

/// Returns the vertex of a corner in O(1), after walking all stars once. SquadView::vertex takes O(valence) per corner.
/// For vertices of up to kFew triangles it compares both; `invalid` gets a disagreement.
class SquadReader {
  public:
    SquadReader(const SquadView& view, std::string& invalid)
        : view_(view), invalid_(invalid), vertex_(vertices_by_stars(view)), triangles_(view.vertices, 0) {
        for (const std::uint32_t v : vertex_) {
            if (v != UINT32_MAX) ++triangles_[v];
        }
    }
    std::uint32_t operator()(CornerId c) const {
        constexpr std::uint32_t kFew = 64;
        const std::uint32_t v = vertex_[c.value];
        if (v == UINT32_MAX) {
            invalid_ = fmt::format("corner {} is in no star", c.value);
            return 0;
        }
        if (triangles_[v] <= kFew && view_.vertex(c).value != v) invalid_ = fmt::format("corner {}: vertex", c.value);
        return v;
    }

  private:
    const SquadView& view_;
    std::string& invalid_;
    std::vector<std::uint32_t> vertex_, triangles_;
};

/// Measures a structure with corner operators and reads it back triangle by triangle. Its size is that of its arrays:
/// these structures have no file format.
template <class View>
MeasuredFormat rival_format(const char* name, const View& view, std::vector<std::uint32_t> order,
                            const std::vector<bool>& flipped) {
    MeasuredFormat format;
    format.name = name;
    const auto vertex = [&] {
        if constexpr (std::is_same_v<View, SquadView>) {
            return SquadReader(view, format.invalid);
        } else {
            return [&](CornerId c) { return view.vertex(c).value; };
        }
    }();
    format.references = view.references();
    format.bytes = 4 * format.references;
    for (std::uint32_t t = 0; t < view.triangle_numbers(); ++t) {
        if (!view.is_canonical(TriangleId{t})) continue;
        CornerId c = view.corner(TriangleId{t});
        std::uint32_t v[3];
        for (std::uint32_t& u : v) {
            u = vertex(c);
            c = view.next(c);
        }
        if (!flipped.empty() && flipped[t]) std::swap(v[0], v[2]);  // the structures hold the oriented mesh
        format.indices.insert(format.indices.end(), v, v + 3);
    }
    format.order = std::move(order);
    return format;
}

}  // namespace

void add_strips(FormatSet& set, const Mesh& mesh, const std::vector<std::uint32_t>& triangles) {
    Result<Strips> strips = make_strips(triangles, mesh.vertex_count);
    if (!strips) {
        for (const char* name : {"strip_restart", "strip_degenerate"})
            set.absent.emplace_back(name, strips.error().message);
        return;
    }
    const auto add = [&](const char* name, const std::vector<std::uint32_t>& references, bool restart) {
        set.formats.push_back({.name = name,
                               .bytes = references.size() * sizeof(std::uint32_t),
                               .references = references.size(),
                               .indices = unstrip(references, restart)});
    };
    add("strip_restart", strips->restart, true);
    add("strip_degenerate", strips->degenerate, false);
}

void add_codecs(FormatSet& set, const Mesh& mesh, const std::vector<std::uint32_t>& triangles) {
    if (const auto best = best_cache_order(triangles, mesh.vertex_count)) {
        set.best_order = analyze_fifo32(*best, mesh.vertex_count);
    }
    if (Result<CodedIndices> coded = encode_meshopt_indices(triangles, mesh.vertex_count)) {
        MeasuredFormat codec{.name = "meshopt_index_codec", .bytes = coded->bytes.size()};
        codec.deflated = deflated_size(std::as_bytes(std::span(coded->bytes)));
        codec.indices = std::move(coded->indices);
        codec.order = std::move(coded->order);
        set.formats.push_back(std::move(codec));
    } else {
        set.absent.emplace_back("meshopt_index_codec", coded.error().message);
    }
    if (Result<Meshlets> meshlets = make_meshlets(triangles, positions_f32(mesh))) {
        set.formats.push_back({.name = "meshlets", .bytes = meshlets->bytes, .indices = std::move(meshlets->indices)});
    } else {
        set.absent.emplace_back("meshlets", meshlets.error().message);
    }
}

void add_structures(FormatSet& set, CornerTable table, std::uint32_t vertices) {
    const std::vector<VertexId> originals = split_fans(table);
    std::vector<std::uint32_t> order(table.vertex_count);
    const auto original = [&](std::uint32_t v) { return v < vertices ? v : originals[v - vertices].value; };
    for (std::uint32_t v = 0; v < order.size(); ++v) order[v] = original(v);
    std::vector<bool> flipped(table.triangle_count());
    for (std::uint32_t t = 0; t < flipped.size(); ++t) flipped[t] = table.flipped(TriangleId{t});
    const auto add = [&](MeasuredFormat format) {
        format.copies = originals.size();
        set.formats.push_back(std::move(format));
    };
    {
        const WingedEdge winged = build_winged_edge(table);
        add(rival_format("winged_edge", winged.view(), order, flipped));
        const CornerTableC corner_table = build_corner_table_c(table);
        add(rival_format("corner_table", corner_table.view(), order, flipped));
    }
    LrMap map;
    const Result<Squad> squad = build_squad(table, {}, &map);
    if (!squad) {
        set.absent.emplace_back("squad", squad.error().message);
        return;
    }
    std::vector<bool> squad_flipped(map.triangle.size());
    for (std::uint32_t t = 0; t < map.triangle.size(); ++t) {
        squad_flipped[t] = !map.triangle[t].is_null() && table.flipped(map.triangle[t]);
    }
    for (std::uint32_t v = 0; v < map.vertex.size(); ++v) order[v] = original(map.vertex[v].value);
    add(rival_format("squad", squad->view(), std::move(order), squad_flipped));
}

}  // namespace lacedring::app
