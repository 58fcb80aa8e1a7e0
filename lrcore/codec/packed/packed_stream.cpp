// The C++ interface of packed streams, on the decoder and checks in lacedring_decode.h (C).

#include <bit>

#include "lacedring/lacedring_decode.h"
#include "lacedring/streams.hpp"
#include "lrcore/base/crc32.h"
#include "lrcore/base/message.h"
#include "lrcore/base/signature.h"
#include "lrcore/codec/packed/packed_c.h"
#include "lrcore/codec/packed/packed_format.h"

namespace lacedring {
namespace {

static_assert(std::endian::native == std::endian::little, "streams are little-endian words");
static_assert(LR_PACKED_MAGIC == magic::kPacked);
static_assert(LR_PACKED_HEADER_WORDS == LACEDRING_PACKED_HEADER_WORDS && LR_PACKED_BLOCK == LACEDRING_PACKED_BLOCK);

/// Describes the fault in English.
std::string packed_fault(lacedring_status status, std::uint64_t where, std::span<const std::uint32_t> words) {
    using detail::message;
    switch (status) {
        case LACEDRING_STATUS_SHORT:
            return "shorter than its header";
        case LACEDRING_STATUS_MAGIC:
            return wrong_magic(words, "a packed stream");
        case LACEDRING_STATUS_VERSION:
            return message("version ", where, " is not 2");
        case LACEDRING_STATUS_VERTICES:
            return message(words[LR_PACKED_WORD_VERTICES] & ~LR_PACKED_DOUBLES, " vertices");
        case LACEDRING_STATUS_SLOTS:
            return "more triangles than 32-bit indices can number";
        case LACEDRING_STATUS_SIZE:
            return message(words.size(), " words do not match its number of triangles");
        case LACEDRING_STATUS_CHECKSUM:
            return "checksum does not match";
        case LACEDRING_STATUS_GROUP:
            return message("block ", where, ": the head of its group is invalid");
        case LACEDRING_STATUS_BLOCK:
            return message("block ", where, " is invalid");
        case LACEDRING_STATUS_TURNS:
            return "turn bits after the last triangle";
        case LACEDRING_STATUS_DOUBLES:
            return message("run ", where, " of doubles is invalid");
        default:
            return "unknown";
    }
}

Error bad_packed(lacedring_status status, std::uint64_t where, std::span<const std::uint32_t> words) {
    return {ErrorCode::malformed, "packed stream: " + packed_fault(status, where, words)};
}

constexpr std::uint32_t rounded_up(std::uint32_t value, std::uint32_t unit) {
    return value / unit + (value % unit == 0 ? 0 : 1);
}

}  // namespace

std::uint32_t PackedView::blocks() const {
    return rounded_up(triangles, LR_PACKED_BLOCK);
}
std::size_t PackedView::table_word() const {
    return LR_PACKED_HEADER_WORDS + std::size_t{rounded_up(own, 32)};
}
std::size_t PackedView::doubles_word() const {
    const std::uint32_t groups = rounded_up(own, LR_PACKED_BLOCK * LR_PACKED_GROUP);
    return table_word() + (groups == 0 ? 0 : groups - 1);
}
std::size_t PackedView::groups_word() const {
    return doubles_word() + (runs == 0 ? 0 : LR_PACKED_DOUBLES_WORDS + LR_PACKED_RUN_WORDS * std::size_t{runs});
}

lacedring_packed detail::as_c(const PackedView& view) {
    const std::uint32_t* words = view.words.data();
    return {view.vertices,
            view.triangles,
            view.own,
            view.vertex_bits,
            view.runs,
            words + view.doubles_word() + LR_PACKED_DOUBLES_WORDS,
            words + LR_PACKED_HEADER_WORDS,
            words + view.table_word(),
            reinterpret_cast<const std::uint8_t*>(words + view.groups_word()),
            4 * (view.words.size() - view.groups_word())};
}

std::uint32_t packed_vertex_bits(std::uint32_t vertices) {
    return vertices <= 2 ? 1 : static_cast<std::uint32_t>(std::bit_width(vertices - 1));
}

std::uint32_t packed_checksum(std::span<const std::uint32_t> words) {
    const std::uint32_t header = crc32(std::as_bytes(words.first(LR_PACKED_WORD_CHECKSUM)));
    return crc32(std::as_bytes(words.subspan(LR_PACKED_HEADER_WORDS)), header);
}

Result<PackedView> view_packed(std::span<const std::uint32_t> words) {
    lacedring_packed packed;
    std::uint64_t where = 0;
    const lacedring_status status = lacedring_packed_open(words.data(), words.size(), &packed, &where);
    if (status != LACEDRING_STATUS_OK) return bad_packed(status, where, words);
    return PackedView{words, packed.vertices, packed.triangles, packed.own, packed.vertex_bits, packed.runs};
}

Result<PackedView> validate_packed(std::span<const std::uint32_t> words) {
    Result<PackedView> view = view_packed(words);
    if (!view) return view;
    // Computed here because crc32 is several times faster than the C file's version with a small table.
    if (words[LR_PACKED_WORD_CHECKSUM] != packed_checksum(words))
        return bad_packed(LACEDRING_STATUS_CHECKSUM, 0, words);
    const lacedring_packed packed = detail::as_c(*view);
    std::uint64_t where = 0;
    const lacedring_status status = lacedring_packed_check(&packed, &where);
    if (status != LACEDRING_STATUS_OK) return bad_packed(status, where, words);
    return view;
}

}  // namespace lacedring
