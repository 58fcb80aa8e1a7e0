#include "app/formats.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/format_rivals.h"
#include "lacedring/lacedring.hpp"
#include "lacedring/streams.hpp"
#include "lrlab/paper/offsets.h"
#include "lrlab/rivals/compressors.h"

namespace lacedring::app {
namespace {

void set_ring(MeasuredFormat& format, std::uint32_t k, std::uint32_t passes) {
    format.ring = passes != 0 ? "optimized" : k != 0 ? "hybrid" : "expander";
    format.k = k;
    format.passes = passes;
}

/// The lean stream, decoded twice: as a whole, and slot by slot.
MeasuredFormat lean_format(const char* name, std::uint32_t k, std::uint32_t passes, EncodedLean stream) {
    MeasuredFormat format;
    format.name = name;
    set_ring(format, k, passes);
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
        const Triangle triangle = decode_lean_slot(*view, slot);
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
MeasuredFormat lr_format(const char* name, Encoded encoded) {
    MeasuredFormat format;
    format.name = name;
    set_ring(format, encoded.report.k, encoded.report.passes);
    format.bytes = encoded.bytes().size();
    format.references = encoded.words.size() - kLrHeaderWords;
    const Result<StreamView> view = validate(encoded.words);
    if (!view) {
        format.invalid = view.error().message;
        return format;
    }
    format.indices = decode(*view);
    format.order = std::move(encoded.vertex_order);
    format.copies = encoded.report.copies;
    return format;
}

/// The packed stream, decoded twice: as a whole, and some triangles of each block alone.
MeasuredFormat packed_format(const char* name, Encoded stream) {
    MeasuredFormat format;
    format.name = name;
    set_ring(format, stream.report.k, stream.report.passes);
    format.bytes = stream.bytes().size();
    format.deflated = deflated_size(stream.bytes());
    const Result<PackedView> view = validate_packed(stream.words);
    if (!view) {
        format.invalid = view.error().message;
        return format;
    }
    format.indices.resize(std::size_t{3} * view->triangles);
    decode_packed(*view, format.indices);
    for (std::uint32_t t = 0; t < view->triangles; t += 37) {
        const Triangle triangle = decode_packed_triangle(*view, t);
        if (!std::equal(triangle.v, triangle.v + 3, format.indices.begin() + std::ptrdiff_t{3} * t)) {
            format.invalid = fmt::format("triangle {} decoded on its own differs", t);
        }
    }
    format.order = std::move(stream.vertex_order);
    return format;
}

}  // namespace

std::vector<std::uint32_t> without_degenerate(const std::vector<std::uint32_t>& indices) {
    std::vector<std::uint32_t> out;
    out.reserve(indices.size());
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const std::uint32_t a = indices[i], b = indices[i + 1], c = indices[i + 2];
        if (a != b && b != c && c != a) out.insert(out.end(), {a, b, c});
    }
    return out;
}

Result<FormatSet> make_formats(const Mesh& mesh, const RingChoice& choice, bool paper, const FormatProgress& progress) {
    const auto stop = [&](double share, const char* what) { return progress && !progress(share, what); };
    Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
    if (!table) return table.error();
    FormatSet set;
    set.topology = table->topology;
    set.report = report_topology(*table);
    set.ring = ring_options(choice, mesh.triangle_count());

    const std::vector<std::uint32_t> triangles = without_degenerate(mesh.indices);
    const auto add_list = [&](const char* name, std::size_t width) {
        set.formats.push_back(
            {.name = name, .bytes = triangles.size() * width, .references = triangles.size(), .indices = triangles});
    };
    add_list("index_u32", 4);
    if (mesh.vertex_count <= 65536) {
        add_list("index_u16", 2);
    } else {
        set.absent.emplace_back("index_u16", "more than 65,536 vertices");
    }
    if (stop(0.0, "strips")) return set;
    add_strips(set, mesh, triangles);
    if (stop(0.1, "lean")) return set;
    const auto how = [&](Format format, double share, const char* what) {
        EncodeOptions options = encode_options(choice, format, mesh.triangle_count());
        if (paper) options.passes = 0;
        if (progress) options.progress = [=, &progress](std::uint32_t) { return progress(share, what); };
        return options;
    };
    const EncodeOptions for_lean = how(Format::lean, 0.1, "lean");
    OptimizeOptions optimize = optimize_options(choice, kLeanRingCost);
    if (paper) optimize.passes = 0;
    optimize.progress = for_lean.progress;
    const Rings rings = optimize_rings(*table, expand_rings(*table, set.ring), optimize);
    for (const bool warts : {true, false}) {
        const char* const name = warts ? "lean" : "lean_no_warts";
        if (Result<EncodedLean> lean = encode_lean(*table, rings, {.wart_skipping = warts})) {
            if (warts) set.lean = lean->statistics;
            set.formats.push_back(lean_format(name, set.ring.k, optimize.passes, std::move(*lean)));
        } else {
            set.absent.emplace_back(name, lean.error().message);
        }
    }
    if (stop(0.25, "lr")) return set;
    if (Result<Encoded> lr = encode(*table, how(Format::lr, 0.25, "lr"))) {
        set.lr = std::get<LrStatistics>(lr->report.statistics);
        set.formats.push_back(lr_format("lr", std::move(*lr)));
    } else {
        set.absent.emplace_back("lr", lr.error().message);
    }
    if (stop(0.4, "lr_compact")) return set;
    EncodeOptions for_compact = how(Format::lr_compact, 0.4, "lr_compact");
    for_compact.periods = ring_periods(choice, mesh.triangle_count());
    if (paper && for_compact.periods.size() > 1) std::erase(for_compact.periods, 0U);  // the hybrid, not the expander
    if (Result<Encoded> compact = encode(*table, for_compact)) {
        set.lr_compact = std::get<LrStatistics>(compact->report.statistics);
        const auto stream = view_compact_lr(compact->words);
        if (stream) set.lr_compact_long = count_long_tips(stream->view);
        set.formats.push_back(lr_format("lr_compact", std::move(*compact)));
    } else {
        set.absent.emplace_back("lr_compact", compact.error().message);
    }
    if (stop(0.55, "packed")) return set;
    EncodeOptions for_packed = how(Format::packed, 0.55, "packed");
    Result<Encoded> small = encode(*table, for_packed);
    if (!small) return small.error();
    set.packed = std::get<PackedStatistics>(small->report.statistics);
    set.formats.push_back(packed_format("packed", std::move(*small)));
    if (stop(0.7, "packed_cache")) return set;
    for_packed.profile = PackedProfile::cache;
    Result<Encoded> cache = encode(*table, for_packed);
    if (!cache) return cache.error();
    set.formats.push_back(packed_format("packed_cache", std::move(*cache)));
    if (stop(0.85, "meshoptimizer's formats")) return set;
    add_codecs(set, mesh, triangles);
    if (stop(0.93, "winged edge, corner table, SQuad")) return set;
    add_structures(set, std::move(*table), mesh.vertex_count);
    return set;
}

}  // namespace lacedring::app
