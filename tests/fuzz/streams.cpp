#include "tests/fuzz/streams.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

#include "lacedring/streams.hpp"
#include "lrcore/base/crc32.h"
#include "lrcore/codec/lean/lean_format.h"
#include "lrcore/codec/packed/packed_c.h"
#include "lrcore/codec/packed/packed_format.h"
#include "tests/fuzz/use.h"

namespace lacedring::fuzz {
namespace {

/// Sizes from the number of words, and triangles from the slots that are not degenerate (docs/lean-format.md).
void mend_lean(Words& words) {
    const std::uint64_t rings2 = words[LR_LEAN_WORD_RINGS2], rings1 = words[LR_LEAN_WORD_RINGS1];
    const std::uint64_t payload = words.size() - LR_LEAN_HEADER_WORDS, ring_slots = 2 * rings2 + rings1;
    if (ring_slots > payload) return;
    const auto verbatim = static_cast<std::uint32_t>((payload - ring_slots) / 3);
    words.resize(LR_LEAN_HEADER_WORDS + ring_slots + std::size_t{3} * verbatim);
    words[LR_LEAN_WORD_VERBATIM] = verbatim;
    std::uint32_t triangles = verbatim;
    for (std::uint32_t v = 0; v < rings2 + rings1; ++v) {
        const bool two = v < rings2;
        const std::uint32_t* slots = words.data() + LR_LEAN_HEADER_WORDS + (two ? 2 * v : rings2 + v);
        std::uint32_t next = v + 1;
        for (std::uint32_t side = 0; side < (two ? 2U : 1U); ++side) {
            if ((slots[side] & LR_LEAN_CLOSE_FLAG) != 0) next = slots[side] & LR_LEAN_TIP_MASK;
        }
        for (std::uint32_t side = 0; side < (two ? 2U : 1U); ++side) {
            const bool degenerate = (slots[side] & LR_LEAN_CLOSE_FLAG) != 0 || slots[side] == (side == 0 ? v : next);
            if (!degenerate) ++triangles;
        }
    }
    words[LR_LEAN_WORD_TRIANGLES] = triangles;
}

/// The table of groups from their heads; zeros where they have to be.
void mend_packed(Words& words) {
    PackedView view;
    view.vertices = words[LR_PACKED_WORD_VERTICES] & ~LR_PACKED_DOUBLES;
    view.own = words[LR_PACKED_WORD_TRIANGLES];
    if (view.own == 0 || view.own > 8 * 4 * words.size()) return;  // a turn bit each
    if (view.doubles_word() + LR_PACKED_DOUBLES_WORDS > words.size()) return;
    if ((words[LR_PACKED_WORD_VERTICES] & LR_PACKED_DOUBLES) != 0) view.runs = words[view.doubles_word() + 1];
    if (view.groups_word() > words.size()) return;
    if (const std::uint32_t last = view.own % 32; last != 0) {
        words[LR_PACKED_HEADER_WORDS + view.own / 32] &= (1U << last) - 1;
    }
    const std::uint64_t width = packed_vertex_bits(view.vertices), bits = 32 * (words.size() - view.groups_word());
    const auto field = [&](std::uint64_t at, std::uint32_t count) {
        std::uint32_t value = 0;
        for (std::uint32_t k = 0; k < count && at + k < bits; ++k) {
            value |= (words[view.groups_word() + (at + k) / 32] >> ((at + k) % 32) & 1) << k;
        }
        return value;
    };
    const std::uint32_t all = (view.own - 1) / LR_PACKED_BLOCK + 1;
    std::uint64_t word = 0;
    for (std::uint32_t block = 0; block < all; block += LR_PACKED_GROUP) {
        if (block > 0) words[view.table_word() + block / LR_PACKED_GROUP - 1] = static_cast<std::uint32_t>(word);
        const std::uint64_t begin = 32 * word, blocks = std::min(all - block, LR_PACKED_GROUP);
        constexpr std::uint32_t kEntryAt = LR_PACKED_STEP_FIELD + LR_PACKED_OFFSET_FIELD;
        const std::uint32_t step = field(begin, LR_PACKED_STEP_FIELD),
                            offset_bits = field(begin + LR_PACKED_STEP_FIELD, LR_PACKED_OFFSET_FIELD),
                            entry_bits = field(begin + kEntryAt, LR_PACKED_ENTRY_FIELD);
        const bool kinds = field(begin + LR_PACKED_HEAD_BITS - 1, 1) != 0;
        std::uint64_t entries = 1;
        for (std::uint64_t k = 1; k < blocks; ++k) entries += field(begin + LR_PACKED_HEAD_BITS + k - 1, 1);
        const std::uint64_t ends = begin + LR_PACKED_HEAD_BITS + blocks - 1 + entries * (2 * width + 1) +
                                   (kinds ? LR_PACKED_KIND_BITS * blocks : 0);
        const std::uint64_t head = ends + blocks * offset_bits + (blocks - 1) * entry_bits;
        const std::uint64_t size = blocks * step + field(ends + (blocks - 1) * offset_bits, offset_bits);
        word = ((head + 7) / 8 + size - std::min<std::uint64_t>(size, (1ULL << offset_bits) / 2) + 3) / 4;
        if (32 * word > bits) return;
    }
}

/// The entries of VO* from the number of words: nothing else says how many they are.
void mend_lr(Words& words, std::uint64_t words_per_vertex) {
    constexpr std::size_t ring = 3, t0 = 4, star = 5, isolated = 6, copies = 7;
    const std::uint64_t others = kLrHeaderWords + words[ring] * words_per_vertex + std::uint64_t{6} * words[t0] +
                                 words[isolated] + std::uint64_t{2} * words[copies];
    if (others <= words.size()) words[star] = static_cast<std::uint32_t>(words.size() - others);
}

void mend(Format kind, Words& words) {
    constexpr std::size_t lr_checksum = 9;
    switch (kind) {
        case Format::lean:
            if (words.size() < LR_LEAN_HEADER_WORDS) return;
            words[LR_LEAN_WORD_MAGIC] = LR_LEAN_MAGIC;
            words[LR_LEAN_WORD_VERSION] = LR_LEAN_VERSION;
            mend_lean(words);
            words[LR_LEAN_WORD_CHECKSUM] = lean_checksum(words);
            return;
        case Format::packed:
            if (words.size() < LR_PACKED_HEADER_WORDS) return;
            words[LR_PACKED_WORD_MAGIC] = LR_PACKED_MAGIC;
            mend_packed(words);
            words[LR_PACKED_WORD_CHECKSUM] = packed_checksum(words);
            return;
        default: {
            if (words.size() < kLrHeaderWords) return;
            mend_lr(words, kind == Format::lr ? 2 : 1);
            const auto bytes = std::as_bytes(std::span(words));
            words[lr_checksum] = crc32(bytes.subspan(4 * kLrHeaderWords), crc32(bytes.first(4 * lr_checksum)));
        }
    }
}

void mutate_words(Words& words, Random& random) {
    const auto any = [&] { return random_below(random, words.size()); };
    const auto place = [&](std::size_t i) { return words.begin() + static_cast<std::ptrdiff_t>(i); };
    std::uint32_t& word = words[any()];
    switch (random_below(random, 8)) {
        case 0:
            word ^= 1U << random_below(random, 32);
            break;
        case 1:
            word ^= 1U << (28 + random_below(random, 4));  // flags
            break;
        case 2:
            word += random_below(random, 5) - 2;
            break;
        case 3:
            word = (word & 0xe0000000U) | random_below(random, words.size());
            break;
        case 4:
            word = words[any()];
            break;
        case 5:
            std::swap(word, words[any()]);
            break;
        case 6: {
            const Words piece(place(any()), words.end());
            const std::size_t size = std::min<std::size_t>(piece.size(), 1 + random_below(random, 6));
            words.insert(place(any()), piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(size));
            break;
        }
        default: {
            const std::size_t begin = any(), size = 1 + random_below(random, 6);
            words.erase(place(begin), place(std::min(begin + size, words.size())));
        }
    }
}

template <Format kind>
bool run(std::span<const std::byte> bytes) {
    const std::size_t size = bytes.size() / 4;
    const auto words = std::make_unique<std::uint32_t[]>(size);
    if (size > 0) std::memcpy(words.get(), bytes.data(), 4 * size);
    return use_stream(kind, {words.get(), size}).has_value();
}

template <Format kind>
void mutate(Bytes& bytes, std::size_t max_size, Random& random) {
    Words words(bytes.size() / 4);
    if (!words.empty()) std::memcpy(words.data(), bytes.data(), 4 * words.size());
    mutate_stream(kind, words, max_size / 4, random);
    const auto out = std::as_bytes(std::span(words));
    bytes.assign(out.begin(), out.end());
}

template <class Stream, class Use>
std::optional<Words> used(const Result<Stream>& stream, Use use) {
    if (stream) return use(*stream);
    check_message(stream.error());
    return std::nullopt;
}

}  // namespace

std::optional<Words> use_stream(Format kind, std::span<const std::uint32_t> words) {
    switch (kind) {
        case Format::lean:
            return used(validate_lean(words), use_lean);
        case Format::packed:
            return used(validate_packed(words), use_packed);
        case Format::lr:
            return used(validate_lr(words), [](const auto& stream) { return use_lr(stream); });
        case Format::lr_compact:
            return used(validate_compact_lr(words), [](const auto& stream) { return use_lr(stream); });
    }
    return std::nullopt;
}

void mutate_stream(Format kind, Words& words, std::size_t max_words, Random& random) {
    if (words.empty() || random_below(random, 2) == 0) {
        Bytes bytes(4 * words.size());
        if (!words.empty()) std::memcpy(bytes.data(), words.data(), bytes.size());
        mutate_bytes(bytes, 4 * max_words);
        words.resize(bytes.size() / 4);
        if (!words.empty()) std::memcpy(words.data(), bytes.data(), 4 * words.size());
    } else {
        mutate_words(words, random);
        words.resize(std::min(words.size(), max_words));
    }
    if (random_below(random, 16) != 0) mend(kind, words);  // else the checks of the header are tested
}

extern const Target lean_target{"lean", run<Format::lean>, mutate<Format::lean>};
extern const Target packed_target{"packed", run<Format::packed>, mutate<Format::packed>};
extern const Target lr_target{"lr", run<Format::lr>, mutate<Format::lr>};
extern const Target lr_compact_target{"lr_compact", run<Format::lr_compact>, mutate<Format::lr_compact>};

}  // namespace lacedring::fuzz
