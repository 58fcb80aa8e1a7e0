// Encodes an index list: calls the steps in order, with the settings for the format.

#include <algorithm>
#include <iterator>

#include "lacedring/lacedring.hpp"
#include "lrcore/base/message.h"
#include "lrcore/base/signature.h"
#include "lrcore/base/try.h"

namespace lacedring {
namespace {

constexpr std::uint32_t kPasses[] = {0, 3, 6, 10, 14, 18, 24, 48, 96, 192};

Error invalid(std::string message) {
    return {ErrorCode::invalid_argument, std::move(message)};
}

RingOptions ring_options(const EncodeOptions& options, std::size_t triangles) {
    RingOptions out;
    out.random_seed = options.random_seed;
    out.threads = options.threads;
    out.k = options.periods.empty() ? 0 : options.periods[0];
    if (options.seeds) {
        out.seeds = *options.seeds;
        // lr_compact would multiply seeds by periods.
    } else if (options.effort > 0 && options.format != Format::lr_compact) {
        // For packed streams of large meshes, time is better spent on optimizer passes than on seeds.
        const bool fewer = options.format == Format::packed && options.effort <= 6;
        out.seeds = recommended_seeds(fewer ? 6 * triangles : triangles);
    }
    return out;
}

OptimizeOptions optimize_options(const EncodeOptions& options, const RingCost& cost) {
    OptimizeOptions out;
    out.cost = cost;
    out.passes = options.passes.value_or(passes_at(options.effort, options.format));
    out.random_seed = options.random_seed;
    out.threads = options.threads;
    out.progress = options.progress;
    return out;
}

std::vector<std::uint32_t> periods(const EncodeOptions& options, std::size_t triangles) {
    if (!options.periods.empty()) return options.periods;
    if (options.effort < 3) return {64};
    return recommended_periods(options.effort > 6 ? 0 : triangles);
}

Result<Encoded> lean(const CornerTable& table, const RingOptions& ring, const EncodeOptions& options) {
    const OptimizeOptions optimize = optimize_options(options, kLeanRingCost);
    const Rings rings = optimize_rings(table, expand_rings(table, ring), optimize);
    LR_ASSIGN(EncodedLean stream, encode_lean(table, rings, {.wart_skipping = options.wart_skipping}));
    Encoded out = as_encoded(std::move(stream));
    out.report.k = ring.k;
    out.report.passes = optimize.passes;
    return out;
}

Result<Encoded> packed(const CornerTable& table, const RingOptions& ring, const EncodeOptions& options) {
    LR_ASSIGN(PackedChoice choice,
              encode_smallest_packed(table, ring, optimize_options(options, kPackedRingCost), options.profile));
    Encoded out = as_encoded(std::move(choice.stream));
    out.report.k = ring.k;
    out.report.passes = choice.passes;
    return out;
}

Result<Encoded> tables(CornerTable table, const RingOptions& ring, const EncodeOptions& options) {
    const OptimizeOptions optimize = optimize_options(options, kLrRingCost);
    const std::vector<std::uint32_t> tried = periods(options, table.triangle_count());
    Result<EncodedLr> lr = options.format == Format::lr
                               ? encode_lr(std::move(table), ring, optimize, options.wart_skipping)
                               : encode_compact_lr(std::move(table), ring, tried);
    if (!lr) return lr.error();
    Encoded out = as_encoded(std::move(*lr));
    if (options.format == Format::lr) out.report.passes = optimize.passes;
    return out;
}

/// `table` is a CornerTable const& or &&: encoding LR tables splits its fans, so it copies the table or moves from it.
template <class Table>
Result<Encoded> encode_table(Table&& table, const EncodeOptions& options) {
    if (options.effort >= std::size(kPasses)) {
        return invalid(detail::message("effort ", options.effort, " is above ", std::size(kPasses) - 1));
    }
    if (options.format != Format::lr_compact && options.periods.size() > 1) {
        return invalid("only lr_compact takes several periods");
    }
    const Topology topology = table.topology;
    const RingOptions ring = ring_options(options, table.triangle_count());
    Result<Encoded> out = options.format == Format::lean     ? lean(table, ring, options)
                          : options.format == Format::packed ? packed(table, ring, options)
                                                             : tables(std::forward<Table>(table), ring, options);
    if (!out) return out;
    out->report.topology = topology;
    return out;
}

/// Moves a step's result into an Encoded. `order` becomes its triangle_order.
template <class Stream>
Encoded take(Stream& stream, Format format, std::vector<std::uint32_t>& order) {
    Encoded out;
    out.format = format;
    out.words = std::move(stream.words);
    out.vertex_order = std::move(stream.vertex_order);
    out.triangle_order = std::move(order);
    out.report.triangles = static_cast<std::uint32_t>(out.triangle_order.size());
    out.report.statistics = stream.statistics;
    return out;
}

}  // namespace

std::uint32_t passes_at(std::uint32_t effort, Format format) {
    const std::uint32_t passes = kPasses[std::min<std::size_t>(effort, std::size(kPasses) - 1)];
    return format == Format::packed ? (passes + 1) / 2 : passes;
}

Encoded as_encoded(EncodedLean stream) {
    std::erase(stream.slot_triangle, UINT32_MAX);
    return take(stream, Format::lean, stream.slot_triangle);
}
Encoded as_encoded(EncodedPacked stream) {
    return take(stream, Format::packed, stream.triangle_order);
}
Encoded as_encoded(EncodedLr stream) {
    const Format format = stream.words[0] == magic::kLr ? Format::lr : Format::lr_compact;
    Encoded out = take(stream, format, stream.triangle_order);
    out.report.copies = stream.copies;
    out.report.k = stream.k;
    return out;
}

Result<Encoded> encode(const CornerTable& table, const EncodeOptions& options) {
    return encode_table(table, options);
}
Result<Encoded> encode(CornerTable&& table, const EncodeOptions& options) {
    return encode_table(std::move(table), options);
}

Result<Encoded> encode(std::span<const std::uint32_t> indices, std::uint32_t vertex_count,
                       const EncodeOptions& options) {
    LR_ASSIGN(CornerTable table, build_corner_table(indices, vertex_count));
    return encode(std::move(table), options);
}

}  // namespace lacedring
