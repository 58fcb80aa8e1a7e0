#include "lrcore/base/message.h"
#include "lrcore/base/signature.h"
#include "lrcore/codec/tables/stream_header.h"
#include "lrcore/codec/tables/tables_decode.h"

namespace lacedring {
namespace {

template <class View>
Result<LrStreamView<View>> view_tables(std::span<const std::uint32_t> words, std::uint32_t magic_number,
                                       std::uint32_t per_vertex, std::string_view wanted) {
    if (words.size() < kLrHeaderWords) return malformed_lr("shorter than their header");
    if (words[kW_magic] != magic_number) return malformed_lr(wrong_magic(words, wanted));
    if (words[kW_version] != kLrVersion)
        return malformed_lr(detail::message("version ", words[kW_version], " is not ", kLrVersion));
    const std::uint64_t sizes[] = {std::uint64_t{words[kW_ring]} * per_vertex, std::uint64_t{words[kW_t0]} * 6,
                                   words[kW_star], words[kW_isolated], std::uint64_t{words[kW_copies]} * 2};
    std::uint64_t total = kLrHeaderWords;
    for (const std::uint64_t size : sizes) total += size;
    if (total != words.size()) return malformed_lr(detail::message(words.size(), " words; the header says ", total));
    if (words[kW_vertices] >= word::kTip || std::uint64_t{words[kW_ring]} + words[kW_isolated] > words[kW_vertices]) {
        return malformed_lr(detail::message(words[kW_vertices], " vertices"));
    }
    if (std::uint64_t{8} * words[kW_ring] + std::uint64_t{4} * words[kW_t0] > UINT32_MAX)
        return malformed_lr("too large");
    LrStreamView<View> out;
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
std::vector<std::uint32_t> decode_to_vector(const LrStreamView<View>& stream) {
    std::vector<std::uint32_t> indices(std::size_t{3} * detail::count_triangles(stream));
    detail::decode_tables(stream, indices.data());
    return indices;
}

}  // namespace

Result<LrStreamView<LrView>> view_lr(std::span<const std::uint32_t> words) {
    Result<LrStreamView<LrView>> stream = view_tables<LrView>(words, magic::kLr, 2, "standard LR tables");
    if (stream && words[kW_unit] != 0) return malformed_lr("a unit of VO* in standard tables");
    return stream;
}
Result<LrStreamView<CompactLrView>> view_compact_lr(std::span<const std::uint32_t> words) {
    Result<LrStreamView<CompactLrView>> stream =
        view_tables<CompactLrView>(words, magic::kCompactLr, 1, "bit-efficient LR tables");
    if (stream) stream->view.unit = words[kW_unit];
    return stream;
}

std::vector<std::uint32_t> decode_lr(const LrStreamView<LrView>& stream) {
    return decode_to_vector(stream);
}
std::vector<std::uint32_t> decode_lr(const LrStreamView<CompactLrView>& stream) {
    return decode_to_vector(stream);
}

}  // namespace lacedring
