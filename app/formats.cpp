#include "app/formats.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/format_rivals.h"
#include "lacedring/lacedring.hpp"
#include "lacedring/streams.hpp"
#include "lrlab/paper/offsets.h"
#include "lrlab/rivals/codecs.h"

namespace lacedring::app {
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
template <class Stream>
MeasuredFormat lr_format(const char* name, std::uint32_t passes, EncodedLr encoded, const Result<Stream>& stream) {
    MeasuredFormat format;
    format.name = name;
    set_ring(format, encoded.k, passes);
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

/// The packed stream, decoded twice: as a whole, and some triangles of each block alone.
MeasuredFormat packed_format(const char* name, std::uint32_t k, std::uint32_t passes, EncodedPacked stream) {
    MeasuredFormat format;
    format.name = name;
    set_ring(format, k, passes);
    format.bytes = 4 * stream.words.size();
    format.deflated = deflated_size(std::as_bytes(std::span(stream.words)));
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

/// The optimiser for a format that costs so much. With a progress of its own it says so, pass by pass.
OptimizeOptions optimizer(const RingChoice& choice, const RingCost& cost, bool paper, const FormatProgress& progress,
                          double share, const char* what) {
    OptimizeOptions optimize = optimize_options(choice, cost);
    if (paper) optimize.passes = 0;
    if (progress) optimize.progress = [=](std::uint32_t) { return progress(share, what); };
    return optimize;
}

Result<void> add_packed(FormatSet& set, const CornerTable& table, const RingChoice& choice, bool paper,
                        const FormatProgress& progress) {
    const OptimizeOptions optimize = optimizer(choice, kPackedRingCost, paper, progress, 0.55, "packed");
    Result<PackedChoice> small = encode_smallest_packed(table, set.ring, optimize, PackedProfile::small);
    if (!small) return small.error();
    set.packed = small->stream.statistics;
    set.formats.push_back(packed_format("packed", set.ring.k, small->passes, std::move(small->stream)));
    if (progress && !progress(0.7, "packed_cache")) return {};
    Result<PackedChoice> cache = encode_smallest_packed(table, set.ring, optimize, PackedProfile::cache);
    if (!cache) return cache.error();
    set.formats.push_back(packed_format("packed_cache", set.ring.k, cache->passes, std::move(cache->stream)));
    return {};
}

}  // namespace

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
    const OptimizeOptions optimize = optimizer(choice, kLeanRingCost, paper, progress, 0.1, "lean");
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
    const OptimizeOptions optimize_lr = optimizer(choice, kLrRingCost, paper, progress, 0.25, "lr");
    if (Result<EncodedLr> lr = encode_lr(*table, set.ring, optimize_lr)) {
        set.lr = lr->statistics;
        const auto stream = validate_lr(lr->words);
        set.formats.push_back(lr_format("lr", optimize_lr.passes, std::move(*lr), stream));
    } else {
        set.absent.emplace_back("lr", lr.error().message);
    }
    if (stop(0.4, "lr_compact")) return set;
    std::vector<std::uint32_t> periods = ring_periods(choice, mesh.triangle_count());
    if (paper && periods.size() > 1) std::erase(periods, 0U);  // the hybrid, not the expander
    if (Result<EncodedLr> compact = encode_compact_lr(*table, compact_ring_options(choice), periods)) {
        set.lr_compact = compact->statistics;
        const auto stream = validate_compact_lr(compact->words);
        if (stream) set.lr_compact_long = count_long_tips(stream->view);
        set.formats.push_back(lr_format("lr_compact", 0, std::move(*compact), stream));
    } else {
        set.absent.emplace_back("lr_compact", compact.error().message);
    }
    if (stop(0.55, "packed")) return set;
    if (const Result<void> added = add_packed(set, *table, choice, paper, progress); !added) return added.error();
    if (stop(0.85, "meshoptimizer's formats")) return set;
    add_codecs(set, mesh, triangles);
    if (stop(0.93, "winged edge, corner table, SQuad")) return set;
    add_structures(set, std::move(*table), mesh.vertex_count);
    return set;
}

}  // namespace lacedring::app
