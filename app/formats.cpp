#include "app/formats.h"

#include <fmt/format.h>

#include "lrcore/baseline/strips.h"
#include "lrcore/corner_table/split.h"
#include "lrcore/lr/lr_stream.h"
#include "lrcore/lr/search.h"

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
Format lean_format(const char* name, std::uint32_t k, LeanStream stream) {
    Format format;
    format.name = name;
    format.ring = k == 0 ? "expander" : "hybrid";
    format.k = k;
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
        for (std::size_t j = 0; j < 3; ++j) {
            if (triangle.v[j] != format.indices[std::size_t{3} * slot + j]) {
                format.invalid = fmt::format("slot {} decoded on its own differs", slot);
            }
        }
    }
    format.order = std::move(stream.vertex_order);
    return format;
}

/// LR tables, as the words that a file holds, validated and decoded. `order` takes LR vertices to the mesh's.
template <class Stream>
Format lr_format(const char* name, std::uint32_t k, const std::vector<std::uint32_t>& words, const Result<Stream>& stream,
                 std::vector<std::uint32_t> order) {
    Format format;
    format.name = name;
    format.ring = k == 0 ? "expander" : "hybrid";
    format.k = k;
    format.bytes = words.size() * sizeof(std::uint32_t);
    format.references = words.size() - kLrHeaderWords;
    if (!stream) {
        format.invalid = stream.error().message;
        return format;
    }
    format.indices = decode_lr(*stream);
    format.order = std::move(order);
    format.copies = stream->copies.size() / 2;
    return format;
}

/// The standard and the bit-efficient tables, each with its ring.
Result<void> add_lr(FormatSet& set, CornerTable& table, const RingChoice& choice, std::size_t triangles) {
    const std::uint32_t mesh_vertices = table.vertex_count;
    const std::vector<VertexId> originals = split_fans(table);
    // LR vertices as the mesh's, and which of them are copies.
    const auto translate = [&](const LrMap& map, std::vector<std::uint32_t>& order) {
        std::vector<std::uint32_t> number(mesh_vertices);
        for (std::uint32_t v = 0; v < map.vertex.size(); ++v) {
            if (map.vertex[v].value < mesh_vertices) number[map.vertex[v].value] = v;
        }
        std::vector<VertexCopy> copies;
        order.clear();
        for (std::uint32_t v = 0; v < map.vertex.size(); ++v) {
            const std::uint32_t u = map.vertex[v].value;
            const std::uint32_t original = u < mesh_vertices ? u : originals[u - mesh_vertices].value;
            if (u >= mesh_vertices) copies.push_back({v, number[original]});
            order.push_back(original);
        }
        return copies;
    };
    std::vector<std::uint32_t> order;
    {
        RingOptions options = ring_options(choice, triangles);
        options.one_per_shell = true;
        LrMap map;
        const Result<LrTable> lr = build_lr(table, expand_rings(table, options), {}, &map);
        if (!lr) return lr.error();
        const std::vector<VertexCopy> copies = translate(map, order);
        const std::vector<std::uint32_t> words = serialize(*lr, copies);
        set.lr = lr->statistics;
        set.formats.push_back(lr_format("lr", options.k, words, validate_lr(words), order));
    }
    const RingOptions one_seed{.seeds = choice.seeds == 0 ? 1 : choice.seeds, .random_seed = choice.random_seed};
    const Result<CompactChoice> best = smallest_compact_lr(table, one_seed, ring_periods(choice, triangles));
    if (!best) return best.error();
    const std::vector<VertexCopy> copies = translate(best->map, order);
    const std::vector<std::uint32_t> words = serialize(best->compact, copies);
    set.formats.push_back(lr_format("lr_compact", best->k, words, validate_compact_lr(words), order));
    return {};
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
        set.formats.push_back({name, references.size() * width, references.size(), std::move(indices), {}, nullptr, 0, 0, {}});
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
    set.formats.push_back(lean_format("lean", set.ring.k, std::move(lean)));
    set.formats.push_back(lean_format("lean_no_warts", set.ring.k, encode_lean(*table, rings, {.wart_skipping = false})));
    if (const Result<void> added = add_lr(set, *table, choice, mesh.triangle_count()); !added) return added.error();
    for (const char* name : {"winged_edge", "corner_table", "squad", "packed", "packed_cache",
                             "meshopt_index_codec", "meshlets"}) {
        set.absent.emplace_back(name, "not in this version");
    }
    return set;
}

}  // namespace lr::app
