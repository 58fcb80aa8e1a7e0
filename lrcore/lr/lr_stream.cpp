#include "lrcore/lr/lr_stream.h"

#include <fmt/format.h>

#include "lrcore/base/bits.h"
#include "lrcore/base/crc32.h"
#include "lrcore/lr/operators.h"

namespace lr {
namespace {

constexpr std::uint32_t kMagic = 0x5443524c, kCompactMagic = 0x4243524c;  // "LRCT", "LRCB"
constexpr std::uint32_t kVersion = 1;
enum HeaderWord { kW_magic, kW_version, kW_vertices, kW_ring, kW_t0, kW_star, kW_isolated, kW_copies, kW_unit, kW_crc };

std::uint32_t checksum(std::span<const std::uint32_t> words) {
    return crc32(std::as_bytes(words.subspan(kLrHeaderWords)), crc32(std::as_bytes(words.first(kW_crc))));
}

template <class Table>
std::vector<std::uint32_t> serialize_tables(const Table& table, std::uint32_t magic, std::uint32_t unit,
                                            std::span<const VertexCopy> copies) {
    const auto size = [](const auto& v) { return static_cast<std::uint32_t>(v.size()); };
    std::vector<std::uint32_t> words = {magic,
                                        kVersion,
                                        table.vertices,
                                        table.ring_vertices,
                                        size(table.vo) / 6,
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
    words[kW_crc] = checksum(words);
    return words;
}

Error malformed(std::string message) {
    return {ErrorCode::malformed, "LR tables: " + std::move(message)};
}

template <class View>
Result<LrStream<View>> view_tables(std::span<const std::uint32_t> words, std::uint32_t magic,
                                   std::uint32_t per_vertex) {
    if (words.size() < kLrHeaderWords) return malformed("shorter than their header");
    if (words[kW_magic] != magic) return malformed("wrong magic number");
    if (words[kW_version] != kVersion)
        return malformed(fmt::format("version {} is not {}", words[kW_version], kVersion));
    const std::uint64_t sizes[] = {std::uint64_t{words[kW_ring]} * per_vertex, std::uint64_t{words[kW_t0]} * 6,
                                   words[kW_star], words[kW_isolated], std::uint64_t{words[kW_copies]} * 2};
    std::uint64_t total = kLrHeaderWords;
    for (const std::uint64_t size : sizes) total += size;
    if (total != words.size()) return malformed(fmt::format("{} words, where the header says {}", words.size(), total));
    if (words[kW_vertices] >= word::kTip || std::uint64_t{words[kW_ring]} + words[kW_isolated] > words[kW_vertices]) {
        return malformed(fmt::format("{} vertices", words[kW_vertices]));
    }
    if (std::uint64_t{8} * words[kW_ring] + std::uint64_t{4} * words[kW_t0] > UINT32_MAX) return malformed("too large");
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

/// What validation asks of a representation beyond the operators: that its own indices stay in bounds.
std::string check_slots(const LrView& view) {
    for (std::uint32_t slot = 0; slot < view.lr.size(); ++slot) {
        const std::uint32_t w = view.lr[slot], kind = w & word::kKind, tip = w & word::kTip;
        const bool irregular = (kind & (word::kSpecial | word::kIrregular)) == word::kIrregular;
        if (irregular ? view.star.size() < 3 || tip > view.star.size() - 3
                      : kind != word::kBorder && tip >= view.used_vertices()) {
            return fmt::format("ring vertex {}: word {:#010x}", slot / 2, w);
        }
        if (irregular && view.star[tip] >= view.used_vertices())
            return fmt::format("ring vertex {}: VO* tip", slot / 2);
        if (kind == word::kClosing && slot % 2 == 1) return fmt::format("ring vertex {} closes on its right", slot / 2);
    }
    return {};
}

std::string check_slots(const CompactLrView& view) {
    if (view.unit < 2 || view.unit > 4096 || view.unit % 2 != 0) return "unit of VO*";
    for (std::uint32_t v = 0; v < view.ring_vertices; ++v) {
        const std::uint32_t w = view.lr[v];
        if (!CompactLrView::is_long(w)) continue;  // offsets are below m_r / 2 in effect: tip() wraps them
        const std::size_t at = view.record(w);
        const bool left = (w & compact::kLongLeftIrregular) != 0, right = (w & compact::kLongRightIrregular) != 0;
        const std::size_t size = 2 + (left ? 2U : 0U) + (right ? 2U : 0U);
        if (at > view.star.size() || size > view.star.size() - at) return fmt::format("ring vertex {}: record", v);
        for (std::uint32_t side = 0; side < 2; ++side) {
            const std::uint32_t entry = view.star[at + side], kind = entry & word::kKind;
            const bool irregular = (kind & (word::kSpecial | word::kIrregular)) == word::kIrregular;
            const bool wart = (kind & (word::kSpecial | word::kWart)) == word::kWart;
            if (kind != word::kBorder && (entry & word::kTip) >= view.used_vertices()) {
                return fmt::format("ring vertex {}: long tip", v);
            }
            if (irregular != (side == 0 ? left : right) ||
                wart != ((w & (side == 0 ? compact::kLongLeftWart : compact::kLongRightWart)) != 0) ||
                (kind == word::kClosing && side == 1)) {
                return fmt::format("ring vertex {}: long flags", v);
            }
        }
    }
    for (std::uint32_t v = 0; v < view.ring_vertices; ++v) {
        if (CompactLrView::is_long(view.lr[v])) continue;
        for (std::uint32_t side = 0; side < 2; ++side) {
            if (view.tip(v, side) >= view.ring_vertices) return fmt::format("ring vertex {}: offset", v);
        }
    }
    return {};
}

/// Kinds that the masks allow but nothing writes.
template <class View>
std::string check_rings(const View& view) {
    const LrOperators<View> ops(view);
    std::uint32_t first = 0;
    for (std::uint32_t v = 0; v < view.ring_vertices; ++v) {
        for (std::uint32_t side = 0; side < 2; ++side) {
            const std::uint32_t kind = view.kind(v, side);
            if ((kind & word::kSpecial) != 0 && kind != word::kRedundant && kind != word::kBorder &&
                kind != word::kClosing) {
                return fmt::format("ring vertex {}: kind {:#x}", v, kind);
            }
        }
        if (!view.closes(v)) continue;
        if (v - first < 2 || view.first(v) != first)
            return fmt::format("the ring from vertex {} does not close", first);
        // Its first vertex finds its last by the tip of a triangle of its own.
        if ((view.kind(first, 0) & word::kSpecial) != 0 || view.tip(first, 0) != v) {
            return fmt::format("the ring from vertex {} does not find its end", first);
        }
        first = v + 1;
    }
    if (first != view.ring_vertices) return fmt::format("the ring from vertex {} does not close", first);
    // The first copy of a T2, real or lent to a T0w, is followed by the second.
    for (std::uint32_t v = 0; v < view.ring_vertices; ++v) {
        for (std::uint32_t side = 0; side < 2; ++side) {
            const std::uint32_t kind = view.kind(v, side);
            const bool wart = (kind & (word::kSpecial | word::kWart)) == word::kWart;
            if (!wart && kind != word::kRedundant && kind != word::kClosing) continue;
            const std::uint32_t n = ops.ring_next(v), nn = ops.ring_next(n);
            const bool second = (view.kind(n, side) & word::kSpecial) == 0;
            const bool third = !wart && ops.ring_next(nn) == v && (view.kind(nn, side) & word::kSpecial) == 0 &&
                               (view.kind(n, side) == word::kRedundant || view.kind(n, side) == word::kClosing);
            if (!second && !third) return fmt::format("ring vertex {}: a T2 without its second copy", v);
            if (second && (view.kind(n, side) & word::kWart) != 0)
                return fmt::format("ring vertex {}: a wart in a wart", v);
            if (second && view.tip(n, side) != v) return fmt::format("ring vertex {}: a T2 that does not come back", v);
        }
    }
    return {};
}

/// Every corner of every triangle: its opposite is one, and is undone.
template <class View>
std::string check_operators(const View& view) {
    const LrOperators<View> ops(view);
    const std::uint32_t numbers = view.triangle_numbers();
    const auto exists = [&](CornerId c) {
        return c.value / 4 < numbers && c.value % 4 < 3 && ops.is_canonical(ops.triangle(c));
    };
    for (const std::uint32_t o : view.c) {
        if (!exists({o})) return "an isolated vertex's corner is none";
    }
    for (std::uint32_t i = 0; i < view.vo.size() / 2; ++i) {
        if (view.t0_vertex(i) >= view.used_vertices()) return fmt::format("T0 {}: vertex", i / 3);
    }
    for (std::uint32_t t = 0; t < numbers; ++t) {
        if (!ops.is_canonical({t})) continue;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const CornerId c{4 * t + k}, o = ops.opposite(c);
            if (ops.vertex(c) == ops.vertex(ops.next(c))) return fmt::format("triangle {} is degenerate", t);
            if (o.is_null()) continue;
            if (!exists(o) || o == c || ops.opposite(o) != c ||
                ops.vertex(ops.next(c)) != ops.vertex(ops.previous(o)) ||
                ops.vertex(ops.previous(c)) != ops.vertex(ops.next(o))) {
                return fmt::format("corner {}: opposite {}", c.value, o.value);
            }
        }
    }
    for (std::uint32_t v = view.ring_vertices; v < view.used_vertices(); ++v) {
        if (ops.vertex(ops.corner(VertexId{v})).value != v) return fmt::format("vertex {}: corner", v);
    }
    return {};
}

std::string check_copies(std::uint32_t vertices, std::span<const std::uint32_t> copies) {
    BitVector copied(copies.empty() ? 0 : vertices);
    for (std::size_t i = 0; i < copies.size(); i += 2) {
        if (copies[i] >= vertices || copied.test(copies[i])) return fmt::format("copied vertex {}", copies[i]);
        copied.set(copies[i]);
    }
    for (std::size_t i = 1; i < copies.size(); i += 2) {
        if (copies[i] >= vertices || copied.test(copies[i])) return fmt::format("a copy of vertex {}", copies[i]);
    }
    return {};
}

template <class View>
Result<LrStream<View>> validate_tables(std::span<const std::uint32_t> words, const Result<LrStream<View>>& stream) {
    if (!stream) return stream;
    if (words[kW_crc] != checksum(words)) return malformed("checksum does not match");
    std::string why = check_slots(stream->view);
    if (why.empty()) why = check_rings(stream->view);
    if (why.empty()) why = check_operators(stream->view);
    if (why.empty()) why = check_copies(stream->view.used_vertices(), stream->copies);
    if (!why.empty()) return malformed(std::move(why));
    return stream;
}

template <class View>
std::vector<std::uint32_t> decode_tables(const LrStream<View>& stream, auto&& flipped) {
    const LrOperators<View> ops(stream.view);
    std::vector<std::uint32_t> original(stream.copies.empty() ? 0 : stream.view.vertices);
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
    return serialize_tables(table, kMagic, 0, copies);
}
std::vector<std::uint32_t> serialize(const CompactLrTable& table, std::span<const VertexCopy> copies) {
    return serialize_tables(table, kCompactMagic, table.unit, copies);
}

Result<LrStream<LrView>> view_lr(std::span<const std::uint32_t> words) {
    return view_tables<LrView>(words, kMagic, 2);
}
Result<LrStream<CompactLrView>> view_compact_lr(std::span<const std::uint32_t> words) {
    Result<LrStream<CompactLrView>> stream = view_tables<CompactLrView>(words, kCompactMagic, 1);
    if (stream) stream->view.unit = words[kW_unit];
    return stream;
}

Result<LrStream<LrView>> validate_lr(std::span<const std::uint32_t> words) {
    return validate_tables(words, view_lr(words));
}
Result<LrStream<CompactLrView>> validate_compact_lr(std::span<const std::uint32_t> words) {
    return validate_tables(words, view_compact_lr(words));
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
