#include "app/formats.h"

#include <fmt/format.h>

#include "lrcore/baseline/strips.h"
#include "lrcore/lr/lr_encode.h"

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

/// LR tables, as the words that a file holds, validated and decoded.
template <class Stream>
Format lr_format(const char* name, EncodedLr encoded, const Result<Stream>& stream) {
    Format format;
    format.name = name;
    format.ring = encoded.k == 0 ? "expander" : "hybrid";
    format.k = encoded.k;
    format.bytes = encoded.words.size() * sizeof(std::uint32_t);
    format.references = encoded.words.size() - kLrHeaderWords;
    if (!stream) {
        format.invalid = stream.error().message;
        return format;
    }
    format.indices = decode_lr(*stream);
    format.order = std::move(encoded.vertex_order);
    format.copies = encoded.copies;
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
    {
        Result<EncodedLr> lr = encode_lr(*table, set.ring);
        if (!lr) return lr.error();
        set.lr = lr->statistics;
        const auto stream = validate_lr(lr->words);
        set.formats.push_back(lr_format("lr", std::move(*lr), stream));
    }
    {
        Result<EncodedLr> compact = encode_compact_lr(std::move(*table), compact_ring_options(choice),
                                                      ring_periods(choice, mesh.triangle_count()));
        if (!compact) return compact.error();
        const auto stream = validate_compact_lr(compact->words);
        set.formats.push_back(lr_format("lr_compact", std::move(*compact), stream));
    }
    for (const char* name : {"winged_edge", "corner_table", "squad", "packed", "packed_cache",
                             "meshopt_index_codec", "meshlets"}) {
        set.absent.emplace_back(name, "not in this version");
    }
    return set;
}

}  // namespace lr::app
