#include "app/formats.h"

#include <fmt/format.h>

#include "lrcore/baseline/strips.h"

namespace lr::app {
namespace {

std::vector<std::uint32_t> without_degenerate(const std::vector<std::uint32_t>& indices) {
    std::vector<std::uint32_t> out;
    out.reserve(indices.size());
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const std::uint32_t a = indices[i], b = indices[i + 1], c = indices[i + 2];
        if (a != b && b != c && c != a) out.insert(out.end(), {a, b, c});
    }
    return out;
}

/// The lean stream, decoded twice: as a whole, and slot by slot.
Format lean_format(std::string name, LeanStream stream) {
    Format format;
    format.name = std::move(name);
    format.has_ring = true;
    const Result<LeanView> view = validate_lean(stream.words);
    if (!view) {
        format.invalid = view.error().message;
        return format;
    }
    format.bytes = view->bytes();
    format.references = view->references();
    format.indices.resize(std::size_t{3} * view->slots());
    decode_lean(*view, format.indices);
    for (std::uint32_t slot = 0; slot < view->slots(); ++slot) {
        const LeanTriangle triangle = decode_lean_slot(*view, slot);
        for (std::size_t k = 0; k < 3; ++k) {
            if (triangle.v[k] != format.indices[std::size_t{3} * slot + k]) {
                format.invalid = fmt::format("slot {} decoded on its own differs", slot);
            }
        }
    }
    format.order = std::move(stream.vertex_order);
    return format;
}

}  // namespace

Result<FormatSet> make_formats(const Mesh& mesh, const RingChoice& choice) {
    Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
    if (!table) return table.error();
    FormatSet set;
    set.topology = table->topology;
    set.report = report_topology(*table);
    set.ring = ring_options(choice, mesh.triangle_count());

    const std::vector<std::uint32_t> triangles = without_degenerate(mesh.indices);
    const auto add_list = [&](const char* name, std::size_t width, const std::vector<std::uint32_t>& references,
                              std::vector<std::uint32_t> indices) {
        set.formats.push_back({name, references.size() * width, references.size(), std::move(indices), {}, false, {}});
    };
    add_list("index_u32", 4, triangles, triangles);
    if (mesh.vertex_count <= 65536) {
        add_list("index_u16", 2, triangles, triangles);
    } else {
        set.absent.emplace_back("index_u16", "more than 65,536 vertices");
    }
    {
        const Strips strips = make_strips(triangles, mesh.vertex_count);
        add_list("strip_restart", 4, strips.restart, unstrip(strips.restart, true));
        add_list("strip_degenerate", 4, strips.degenerate, unstrip(strips.degenerate, false));
    }
    const Rings rings = expand_rings(*table, set.ring);
    LeanStream lean = encode_lean(*table, rings);
    set.lean = lean.statistics;
    set.formats.push_back(lean_format("lean", std::move(lean)));
    set.formats.push_back(lean_format("lean_no_warts", encode_lean(*table, rings, {.wart_skipping = false})));
    for (const char* name : {"winged_edge", "corner_table", "squad", "lr", "lr_compact", "packed", "packed_cache",
                             "meshopt_index_codec", "meshlets"}) {
        set.absent.emplace_back(name, "not in this version");
    }
    return set;
}

}  // namespace lr::app
