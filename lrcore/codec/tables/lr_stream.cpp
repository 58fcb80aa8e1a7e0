#include "lrcore/codec/tables/lr_stream.h"

#include "lrcore/base/message.h"
#include "lrcore/base/signature.h"
#include "lrcore/codec/tables/operators.h"
#include "lrcore/codec/tables/stream_header.h"

namespace lr {
namespace {

template <class Table>
std::vector<std::uint32_t> serialize_tables(const Table& table, std::uint32_t magic_number, std::uint32_t unit,
                                            std::span<const VertexCopy> copies) {
    const auto size = [](const auto& v) { return static_cast<std::uint32_t>(v.size()); };
    std::vector<std::uint32_t> words = {magic_number,
                                        kLrVersion,
                                        table.vertices,
                                        table.ring_vertices,
                                        static_cast<std::uint32_t>(table.vo.size() / 6),
                                        size(table.star),
                                        size(table.c),
                                        static_cast<std::uint32_t>(copies.size()),
                                        unit,
                                        0};
    words.reserve(words.size() + table.lr.size() + table.vo.size() + table.star.size() + table.c.size() +
                  2 * copies.size());
    for (const auto* part : {&table.lr, &table.vo, &table.star, &table.c}) {
        words.insert(words.end(), part->begin(), part->end());
    }
    for (const VertexCopy& c : copies) words.insert(words.end(), {c.copy, c.original});
    words[kW_crc] = lr_checksum(words);
    return words;
}

template <class View>
Result<LrStream<View>> view_tables(std::span<const std::uint32_t> words, std::uint32_t magic_number,
                                   std::uint32_t per_vertex, std::string_view wanted) {
    if (words.size() < kLrHeaderWords) return malformed_lr("shorter than their header");
    if (words[kW_magic] != magic_number) return malformed_lr(wrong_magic(words, wanted));
    if (words[kW_version] != kLrVersion)
        return malformed_lr(detail::message("version ", words[kW_version], " is not ", kLrVersion));
    const std::uint64_t sizes[] = {std::uint64_t{words[kW_ring]} * per_vertex, std::uint64_t{words[kW_t0]} * 6,
                                   words[kW_star], words[kW_isolated], std::uint64_t{words[kW_copies]} * 2};
    std::uint64_t total = kLrHeaderWords;
    for (const std::uint64_t size : sizes) total += size;
    if (total != words.size())
        return malformed_lr(detail::message(words.size(), " words, where the header says ", total));
    if (words[kW_vertices] >= word::kTip || std::uint64_t{words[kW_ring]} + words[kW_isolated] > words[kW_vertices]) {
        return malformed_lr(detail::message(words[kW_vertices], " vertices"));
    }
    if (std::uint64_t{8} * words[kW_ring] + std::uint64_t{4} * words[kW_t0] > UINT32_MAX)
        return malformed_lr("too large");
    LrStream<View> out;
    out.view.vertices = words[kW_vertices];
    out.view.ring_vertices = words[kW_ring];
    std::span<const std::uint32_t>* parts[] = {&out.view.lr, &out.view.vo, &out.view.star, &out.view.c, &out.copies};
    std::size_t at = kLrHeaderWords;
    for (std::size_t i = 0; i < 5; ++i) {
        *parts[i] = words.subspan(at, sizes[i]);
        at += sizes[i];
    }
    return out;
}

template <class View>
std::vector<std::uint32_t> decode_tables(const LrStream<View>& stream, auto&& flipped) {
    const LrOperators<View> ops(stream.view);
    // Copies and originals are used vertices. Unused vertices get no entry: the header alone counts them.
    std::vector<std::uint32_t> original(stream.copies.empty() ? 0 : stream.view.used_vertices());
    for (std::uint32_t v = 0; v < original.size(); ++v) original[v] = v;
    for (std::size_t i = 0; i < stream.copies.size(); i += 2) original[stream.copies[i]] = stream.copies[i + 1];
    std::vector<std::uint32_t> indices;
    for (std::uint32_t t = 0; t < stream.view.triangle_numbers(); ++t) {
        if (!ops.is_canonical({t})) continue;
        std::uint32_t v[3];
        for (std::uint32_t k = 0; k < 3; ++k) {
            v[k] = ops.vertex({4 * t + k}).value;
            if (!original.empty()) v[k] = original[v[k]];
        }
        if (flipped(t)) std::swap(v[0], v[2]);
        indices.insert(indices.end(), v, v + 3);
    }
    return indices;
}

}  // namespace

std::vector<std::uint32_t> serialize(const LrTable& table, std::span<const VertexCopy> copies) {
    return serialize_tables(table, magic::kLr, 0, copies);
}
std::vector<std::uint32_t> serialize(const CompactLrTable& table, std::span<const VertexCopy> copies) {
    return serialize_tables(table, magic::kCompactLr, table.unit, copies);
}

Result<LrStream<LrView>> view_lr(std::span<const std::uint32_t> words) {
    return view_tables<LrView>(words, magic::kLr, 2, "standard LR tables");
}
Result<LrStream<CompactLrView>> view_compact_lr(std::span<const std::uint32_t> words) {
    Result<LrStream<CompactLrView>> stream =
        view_tables<CompactLrView>(words, magic::kCompactLr, 1, "bit-efficient LR tables");
    if (stream) stream->view.unit = words[kW_unit];
    return stream;
}

std::vector<std::uint32_t> decode_lr(const LrStream<LrView>& stream) {
    const LrView& view = stream.view;
    return decode_tables(stream, [&](std::uint32_t t) {
        return t < 2 * view.ring_vertices
                   ? (view.lr[t] & word::kFlip) != 0
                   : (view.vo[std::size_t{6} * (t - 2 * view.ring_vertices)] & word::kT0Flip) != 0;
    });
}
std::vector<std::uint32_t> decode_lr(const LrStream<CompactLrView>& stream) {
    const CompactLrView& view = stream.view;
    return decode_tables(stream, [&](std::uint32_t t) {
        if (t >= 2 * view.ring_vertices)
            return (view.vo[std::size_t{6} * (t - 2 * view.ring_vertices)] & word::kT0Flip) != 0;
        const std::uint32_t w = view.lr[t / 2];
        return CompactLrView::is_long(w) && (view.star[view.record(w) + t % 2] & word::kFlip) != 0;
    });
}

}  // namespace lr
