#include "app/formats/formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "app/formats/rivals.h"
#include "lacedring/lacedring.hpp"
#include "lacedring/streams.hpp"
#include "lrlab/paper/offsets.h"
#include "lrlab/rivals/compressors.h"
#include "lrlab/rivals/whole_mesh.h"

namespace lacedring::app {
namespace {

void set_ring(MeasuredFormat& format, std::uint32_t k, std::uint32_t passes) {
    format.ring = passes != 0 ? "optimized" : k != 0 ? "hybrid" : "expander";
    format.k = k;
    format.passes = passes;
}

/// A mesh, its surface, and, if the mesh has seams, its oriented triangles.
struct Subject {
    const Mesh& mesh;
    const Surface& surface;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Sets `format.indices`, `order` and `seam_bytes`; `invalid` if the seam section does not decode to the mesh's
/// corners. `view` is the view of encoded.words.
void add_indices(MeasuredFormat& format, const Subject& subject, Encoded encoded, const StreamView& view) {
    format.indices = decode(view);
    if (subject.surface.has_seams()) {
        const Result<EncodedSeams> seams = encode_seams(encoded, subject.mesh.indices, subject.surface.vertex_of);
        const std::vector<std::uint32_t> slots = slot_triangles(view);
        const Result<SeamView> valid =
            seams ? validate_seams(seams->words, slots, view.vertices()) : Result<SeamView>(seams.error());
        if (!valid) {
            format.invalid = valid.error().message;
            return;
        }
        std::vector<std::uint32_t> copies(slots.size());
        decode_seams(*valid, slots, copies);
        std::erase(copies, UINT32_MAX);
        if (oriented_triangles(copies, seams->copy_order) != subject.triangles) {
            format.invalid = "the seam section decodes to other corners";
        }
        format.seam_bytes = 4 * seams->words.size();
    }
    format.order = std::move(encoded.vertex_order);
}

/// Measures a lean stream and decodes it twice: as a whole, and slot by slot.
MeasuredFormat lean_format(const char* name, std::uint32_t k, std::uint32_t passes, const Subject& subject,
                           EncodedLean stream) {
    MeasuredFormat format;
    format.name = name;
    set_ring(format, k, passes);
    const Encoded encoded = as_encoded(std::move(stream));
    const Result<StreamView> any = validate(encoded.words);
    if (!any) {
        format.invalid = any.error().message;
        return format;
    }
    const LeanView& view = *any->get<LeanView>();
    format.bytes = view.bytes();
    format.references = view.references();
    std::vector<std::uint32_t> indices(std::size_t{3} * view.slots());
    decode_lean(view, indices);
    for (std::uint32_t slot = 0; slot < view.slots(); ++slot) {
        const Triangle triangle = decode_lean_slot(view, slot);
        if (!std::equal(triangle.v, triangle.v + 3, indices.begin() + std::ptrdiff_t{3} * slot)) {
            format.invalid = fmt::format("slot {} decoded on its own differs", slot);
        }
    }
    add_indices(format, subject, encoded, *any);
    return format;
}

/// Measures LR tables, full or bit-efficient, and decodes them.
MeasuredFormat lr_format(const char* name, const Subject& subject, Encoded encoded) {
    MeasuredFormat format;
    format.name = name;
    set_ring(format, encoded.report.k, encoded.report.passes);
    format.bytes = encoded.bytes().size();
    format.references = encoded.words.size() - kLrHeaderWords;
    format.copies = encoded.report.copies;
    const Result<StreamView> view = validate(encoded.words);
    if (!view) {
        format.invalid = view.error().message;
        return format;
    }
    add_indices(format, subject, std::move(encoded), *view);
    return format;
}

/// Measures a packed stream and decodes it twice: as a whole, and some triangles of each block on their own.
MeasuredFormat packed_format(const char* name, const Subject& subject, Encoded encoded) {
    MeasuredFormat format;
    format.name = name;
    set_ring(format, encoded.report.k, encoded.report.passes);
    format.bytes = encoded.bytes().size();
    format.deflated = deflated_size(encoded.bytes());
    const Result<StreamView> any = validate(encoded.words);
    if (!any) {
        format.invalid = any.error().message;
        return format;
    }
    const PackedView& view = *any->get<PackedView>();
    std::vector<std::uint32_t> indices(std::size_t{3} * view.triangles);
    decode_packed(view, indices);
    for (std::uint32_t t = 0; t < view.triangles; t += 37) {
        const Triangle triangle = decode_packed_triangle(view, t);
        if (!std::equal(triangle.v, triangle.v + 3, indices.begin() + std::ptrdiff_t{3} * t)) {
            format.invalid = fmt::format("triangle {} decoded on its own differs", t);
        }
    }
    add_indices(format, subject, encoded, *any);
    return format;
}

/// Adds bit-efficient LR tables, made with the period that makes them smallest.
void add_compact(FormatSet& set, const CornerTable& table, const Subject& subject, EncodeOptions options,
                 std::vector<std::uint32_t> periods, bool paper) {
    options.periods = std::move(periods);
    if (paper && options.periods.size() > 1) std::erase(options.periods, 0U);  // 0 is the expander, not the hybrid
    Result<Encoded> compact = encode(table, options);
    if (!compact) {
        set.absent.emplace_back("lr_compact", compact.error().message);
        return;
    }
    set.lr_compact = std::get<LrStatistics>(compact->report.statistics);
    const auto stream = view_compact_lr(compact->words);
    if (stream) set.lr_compact_long = count_long_tips(stream->view);
    set.formats.push_back(lr_format("lr_compact", subject, std::move(*compact)));
}

/// Checks that `format.order` has every vertex once, plus format.copies copies of some. Returns what is wrong, or "".
std::string check_order(const MeasuredFormat& format, std::uint32_t vertices) {
    std::vector<bool> seen(vertices, false);
    std::size_t again = 0;
    for (const std::uint32_t v : format.order) {
        if (v >= vertices) return fmt::format("vertex {} of {}", v, vertices);
        again += seen[v] ? 1 : 0;
        seen[v] = true;
    }
    if (again != format.copies) return fmt::format("{} vertices twice instead of {}", again, format.copies);
    return format.order.size() == vertices + format.copies ? "" : "some vertices are lost";
}

}  // namespace

std::vector<FormatCheck> check_formats(const FormatSet& set, const Mesh& mesh, const Surface& surface) {
    const auto expected = oriented_triangles(surface_mesh(mesh, surface).indices, {});
    std::vector<FormatCheck> checks;
    for (const MeasuredFormat& format : set.formats) {
        std::string why = format.invalid;
        if (why.empty() && !format.order.empty()) why = check_order(format, set.vertices);
        if (why.empty()) {
            const auto got = oriented_triangles(format.indices, format.order);
            if (got.size() != expected.size()) {
                why = fmt::format("{} triangles instead of {}", got.size(), expected.size());
            } else if (got != expected) {
                why = "other triangles, or another orientation";
            }
        }
        checks.push_back({format.name, std::move(why)});
    }
    return checks;
}

std::vector<std::uint32_t> without_degenerate(std::span<const std::uint32_t> indices) {
    std::vector<std::uint32_t> out;
    out.reserve(indices.size());
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const std::uint32_t a = indices[i], b = indices[i + 1], c = indices[i + 2];
        if (a != b && b != c && c != a) out.insert(out.end(), {a, b, c});
    }
    return out;
}

Result<FormatSet> make_formats(const Mesh& mesh, const Surface& surface, const RingChoice& choice, bool paper,
                               const FormatProgress& progress, bool quick) {
    const auto stop = [&](double share, const char* what) { return progress && !progress(share, what); };
    const Mesh shape = surface_mesh(mesh, surface);
    Subject subject{mesh, surface, {}};
    if (surface.has_seams()) subject.triangles = oriented_triangles(mesh.indices, {});
    Result<CornerTable> table = build_corner_table(shape.indices, shape.vertex_count);
    if (!table) return table.error();
    FormatSet set;
    set.vertices = shape.vertex_count;
    set.seam_edges = static_cast<std::uint32_t>(seam_edges(*table, mesh).size());
    set.topology = table->topology;
    set.report = report_topology(*table);
    set.ring = ring_options(choice, mesh.triangle_count());

    const std::vector<std::uint32_t> triangles = without_degenerate(shape.indices);
    const auto add_list = [&](const char* name, std::size_t width) {
        set.formats.push_back(
            {.name = name, .bytes = triangles.size() * width, .references = triangles.size(), .indices = triangles});
    };
    add_list("index_u32", 4);
    if (shape.vertex_count <= 65536) {
        add_list("index_u16", 2);
    } else {
        set.absent.emplace_back("index_u16", "more than 65,536 vertices");
    }
    if (stop(0.0, "strips")) return set;
    add_strips(set, shape, triangles);
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
        if (quick && !warts) continue;
        const char* const name = warts ? "lean" : "lean_no_warts";
        if (Result<EncodedLean> lean = encode_lean(*table, rings, {.wart_skipping = warts})) {
            if (warts) set.lean = lean->statistics;
            set.formats.push_back(lean_format(name, set.ring.k, optimize.passes, subject, std::move(*lean)));
        } else {
            set.absent.emplace_back(name, lean.error().message);
        }
    }
    if (stop(0.25, "lr")) return set;
    if (Result<Encoded> lr = encode(*table, how(Format::lr, 0.25, "lr"))) {
        set.lr = std::get<LrStatistics>(lr->report.statistics);
        set.formats.push_back(lr_format("lr", subject, std::move(*lr)));
    } else {
        set.absent.emplace_back("lr", lr.error().message);
    }
    if (!quick) {
        if (stop(0.4, "lr_compact")) return set;
        add_compact(set, *table, subject, how(Format::lr_compact, 0.4, "lr_compact"),
                    ring_periods(choice, mesh.triangle_count()), paper);
    }
    if (stop(0.55, "packed")) return set;
    EncodeOptions for_packed = how(Format::packed, 0.55, "packed");
    Result<Encoded> small = encode(*table, for_packed);
    if (!small) return small.error();
    set.packed = std::get<PackedStatistics>(small->report.statistics);
    set.formats.push_back(packed_format("packed", subject, std::move(*small)));
    if (quick || stop(0.7, "packed_cache")) return set;
    for_packed.profile = PackedProfile::cache;
    Result<Encoded> cache = encode(*table, for_packed);
    if (!cache) return cache.error();
    set.formats.push_back(packed_format("packed_cache", subject, std::move(*cache)));
    if (stop(0.85, "meshoptimizer's formats")) return set;
    add_codecs(set, shape, triangles);
    if (stop(0.93, "winged edge, corner table, SQuad")) return set;
    add_structures(set, std::move(*table), set.vertices);
    return set;
}

}  // namespace lacedring::app
