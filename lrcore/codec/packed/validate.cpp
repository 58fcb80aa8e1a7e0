// Headers, checksums, and what decoders rely on. Everything here may meet hostile words.

#include <algorithm>

#include "lrcore/base/crc32.h"
#include "lrcore/base/message.h"
#include "lrcore/base/signature.h"
#include "lrcore/codec/packed/record.h"

namespace lacedring {
namespace {

static_assert(LR_PACKED_MAGIC == magic::kPacked);

Error malformed(std::string message) {
    return {ErrorCode::malformed, "packed stream: " + std::move(message)};
}

std::uint32_t directory_length(const PackedView& view, std::uint32_t block) {
    const std::size_t group = view.directory_word() + std::size_t{block / LR_PACKED_GROUP} * LR_PACKED_GROUP_WORDS;
    return view.words[group + 1 + block % LR_PACKED_GROUP / 4] >> (8 * (block % 4)) & 0xff;
}

/// Are the turns of a plain block zero, and what fills up the records of a parted one?
bool unused_bits_clear(const PackedView& view, std::uint32_t block, std::uint32_t length, std::uint32_t triangles) {
    if (length == LR_PACKED_PLAIN) {
        const std::uint32_t* turns =
            view.words.data() + LR_PACKED_HEADER_WORDS + std::size_t{block} * LR_PACKED_BLOCK_WORDS;
        const std::uint32_t bits = 3 * triangles * view.vertex_bits;
        const std::uint8_t* record = find_record(view, block * LR_PACKED_BLOCK).record;
        return std::all_of(turns, turns + (triangles + 31) / 32, [](std::uint32_t word) { return word == 0; }) &&
               (bits % 8 == 0 || record[bits / 8] >> (bits % 8) == 0xff >> (bits % 8));
    }
    if (length <= LR_PACKED_MAX_RECORD) return true;
    const PackedRecord record = find_record(view, block * LR_PACKED_BLOCK);
    const std::uint8_t* lengths = record.record - LR_PACKED_PARTS;
    std::uint32_t used = LR_PACKED_PARTS;
    for (std::uint32_t i = 0; i < LR_PACKED_PARTS; ++i) {
        if (i * LR_PACKED_PART >= triangles && lengths[i] != 0) return false;
        used += lengths[i];
    }
    const std::uint32_t bytes = block_bytes(length, triangles, view.vertex_bits);
    return used <= bytes && bytes - used < 8 &&
           std::all_of(lengths + used, lengths + bytes, [](std::uint8_t byte) { return byte == 0; });
}

struct Layout {
    std::size_t turn_words, directory_words;
};

Layout layout(std::uint32_t triangles) {
    const std::size_t blocks = (std::size_t{triangles} + LR_PACKED_BLOCK - 1) / LR_PACKED_BLOCK;
    const std::size_t groups = blocks / LR_PACKED_GROUP, rest = blocks % LR_PACKED_GROUP;
    return {(std::size_t{triangles} + 31) / 32, groups * LR_PACKED_GROUP_WORDS + (rest == 0 ? 0 : 1 + (rest + 3) / 4)};
}

}  // namespace

std::uint32_t PackedView::blocks() const {
    return triangles / LR_PACKED_BLOCK + (triangles % LR_PACKED_BLOCK == 0 ? 0 : 1);
}
std::size_t PackedView::directory_word() const {
    return LR_PACKED_HEADER_WORDS + layout(triangles).turn_words;
}
std::size_t PackedView::records_word() const {
    return directory_word() + layout(triangles).directory_words;
}

std::uint32_t packed_checksum(std::span<const std::uint32_t> words) {
    const std::uint32_t header = crc32(std::as_bytes(words.first(LR_PACKED_WORD_CHECKSUM)));
    return crc32(std::as_bytes(words.subspan(LR_PACKED_HEADER_WORDS)), header);
}

Result<PackedView> view_packed(std::span<const std::uint32_t> words) {
    if (words.size() < LR_PACKED_HEADER_WORDS) return malformed("shorter than its header");
    if (words[LR_PACKED_WORD_MAGIC] != LR_PACKED_MAGIC) return malformed(wrong_magic(words, "a packed stream"));
    if (words[LR_PACKED_WORD_VERSION] != LR_PACKED_VERSION) {
        return malformed(detail::message("version ", words[LR_PACKED_WORD_VERSION], " is not ", LR_PACKED_VERSION));
    }
    PackedView view;
    view.words = words;
    view.vertices = words[LR_PACKED_WORD_VERTICES];
    view.triangles = words[LR_PACKED_WORD_TRIANGLES];
    view.record_bytes = words[LR_PACKED_WORD_RECORD_BYTES];
    view.vertex_bits = words[LR_PACKED_WORD_WIDTHS] & 0xff;
    view.gap_bits = words[LR_PACKED_WORD_WIDTHS] >> 8;
    if (view.triangles > UINT32_MAX / 3) return malformed("too many triangles");
    if (view.vertex_bits < 1 || view.vertex_bits > 31 || view.gap_bits < LR_PACKED_MIN_GAP_BITS || view.gap_bits > 7 ||
        words[LR_PACKED_WORD_RESERVED] != 0) {
        return malformed("widths");
    }
    const std::size_t record_words = (std::size_t{view.record_bytes} + 3) / 4 + LR_PACKED_TAIL_WORDS;
    if (words.size() != view.records_word() + record_words) {
        return malformed(
            detail::message(words.size(), " words, where the header says ", view.records_word() + record_words));
    }
    return view;
}

Result<PackedView> validate_packed(std::span<const std::uint32_t> words) {
    const Result<PackedView> view = view_packed(words);
    if (!view) return view;
    if (words[LR_PACKED_WORD_CHECKSUM] != packed_checksum(words)) return malformed("checksum does not match");
    std::uint64_t offset = 0;
    const std::uint32_t header_bits = 2 * view->vertex_bits + 1;
    for (std::uint32_t block = 0; block < view->blocks(); ++block) {
        const auto bad = [&](const char* what) { return malformed(detail::message("block ", block, ": ", what)); };
        if (block % LR_PACKED_GROUP == 0) {
            const std::size_t group =
                view->directory_word() + std::size_t{block / LR_PACKED_GROUP} * LR_PACKED_GROUP_WORDS;
            if (words[group] != offset) return bad("its group begins elsewhere");
        }
        const std::uint32_t first = block * LR_PACKED_BLOCK, count = std::min(view->triangles - first, LR_PACKED_BLOCK);
        const std::uint32_t length = directory_length(*view, block);
        const std::uint64_t begin = offset;
        offset += block_bytes(length, count, view->vertex_bits);
        if (offset > view->record_bytes) return bad("record lies outside the stream");
        if (length > LR_PACKED_MAX_RECORD && !(length == LR_PACKED_PLAIN) && offset < begin + LR_PACKED_PARTS)
            return bad("record's length");
        if (!unused_bits_clear(*view, block, length, count)) return bad("bits that mean nothing");
        for (std::uint32_t t = first; t < first + count;) {
            const PackedRecord record = find_record(*view, t);
            if (!record.plain) {
                const auto* records = reinterpret_cast<const std::uint8_t*>(words.data() + view->records_word());
                if (record.length > LR_PACKED_MAX_RECORD || 8 * record.length < header_bits ||
                    record.record + record.length > records + offset) {
                    return bad("record's length");
                }
            }
            std::uint32_t indices[3 * LR_PACKED_BLOCK];
            if (!expand_record(*view, record, record.triangles, indices)) return bad("impossible event");
            for (std::uint32_t i = 0; i < 3 * record.triangles; i += 3) {
                const std::uint32_t a = indices[i], b = indices[i + 1], c = indices[i + 2];
                if (a >= view->vertices || b >= view->vertices || c >= view->vertices || a == b || b == c || c == a) {
                    return bad("a vertex out of range, or twice in a triangle");
                }
            }
            t += record.triangles;
        }
    }
    if (offset != view->record_bytes) return malformed("bytes behind the last record");
    if (const std::uint32_t rest = view->blocks() % 4;
        rest != 0 && words[view->records_word() - 1] >> (8 * rest) != 0) {
        return malformed("lengths of blocks that there are not");
    }
    const std::size_t turn_words = layout(view->triangles).turn_words;
    if (view->triangles % 32 != 0 && words[LR_PACKED_HEADER_WORDS + turn_words - 1] >> (view->triangles % 32) != 0) {
        return malformed("turns of triangles that there are not");
    }
    const auto* records = reinterpret_cast<const std::uint8_t*>(words.data() + view->records_word());
    const auto* end = reinterpret_cast<const std::uint8_t*>(words.data() + words.size());
    if (std::any_of(records + view->record_bytes, end, [](std::uint8_t byte) { return byte != 0; })) {
        return malformed("bytes behind the last record");
    }
    return view;
}

}  // namespace lacedring
