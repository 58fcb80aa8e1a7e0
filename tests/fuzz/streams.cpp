#include "tests/fuzz/streams.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>

#include "lacedring/lacedring_seams.h"
#include "lacedring/lacedring_vertices.h"
#include "lacedring/streams.hpp"
#include "lrcore/base/crc32.h"
#include "lrcore/base/signature.h"
#include "lrcore/codec/lean/lean_format.h"
#include "lrcore/codec/packed/packed_c.h"
#include "lrcore/codec/packed/packed_format.h"
#include "tests/fuzz/use.h"

namespace lacedring::fuzz {
namespace {

/// Sets the sizes by the number of words, and the triangles by the slots that are not degenerate (docs/lean-format.md).
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

/// Sets the table of groups by their heads, and clears the bits that must be 0.
void mend_packed(Words& words) {
    PackedView view;
    view.vertices = words[LR_PACKED_WORD_VERTICES] & ~LR_PACKED_DOUBLES;
    view.own = words[LR_PACKED_WORD_TRIANGLES];
    if (view.own == 0 || view.own > 8 * 4 * words.size()) return;  // more than the turn bits
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

/// Sets the header's number of VO* entries to the number of words that the other parts leave.
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

/// Sets the table of a vertex stream by its blocks; removes vertices beyond the data.
void mend_blocks(Words& words) {
    const std::uint32_t vertices = words[1], n = words[2] & 31, field = words[2] >> 18 & 31;
    const auto group_words = [](std::uint32_t width) { return 1 + (15 * width + 31) / 32; };
    const std::uint64_t groups = (vertices + std::uint64_t{16} * kVertexBlock - 1) / (16 * kVertexBlock);
    const std::uint64_t table = LACEDRING_VERTICES_HEADER_WORDS + 2 * n + std::uint64_t{2} * words[6];
    const std::uint64_t data = table + groups * group_words(field);
    if (n == 0 || n > LACEDRING_VERTICES_MAX_COMPONENTS || data + 2 > words.size()) return;
    const std::uint64_t bits = 32 * (words.size() - 2 - data);
    std::uint64_t at = 0;
    const auto take = [&](std::uint32_t count) {
        std::uint32_t value = 0;
        for (std::uint32_t k = 0; k < count; ++k, ++at) {
            if (at < bits) value |= (words[data + at / 32] >> at % 32 & 1) << k;
        }
        return value;
    };
    const auto align = [&] {
        if (at % 32 != 0) words[data + at / 32] &= (1U << at % 32) - 1;
        at = (at + 31) / 32 * 32;
    };
    const auto skip_block = [&](std::uint32_t count) {
        std::uint32_t width[LACEDRING_VERTICES_MAX_COMPONENTS];
        for (std::uint32_t c = 0; c < n; ++c) take(take(1) * 5);
        const std::uint32_t length = 4U << take(2);
        for (std::uint32_t c = 0; c < n; ++c) {
            const std::uint32_t parameters = words[LACEDRING_VERTICES_HEADER_WORDS + 2 * c + 1];
            take(std::min(parameters & 63, 32U));
            width[c] = parameters >> 6 & 31;
        }
        for (std::uint32_t i = 0; i + 1 < count; i += length) {
            const std::uint32_t here = std::min(length, count - 1 - i);
            if (n == 3 && i % 16 == 0 && take(1) != 0) take(take(1) * 8);
            std::uint32_t low_bits = 0, coded = 0;
            for (std::uint32_t c = 0; c < n; ++c) {
                std::uint32_t ones = 0;
                while (ones < 4 && take(1) != 0) ++ones;
                if (ones == 1) continue;
                width[c] = (ones == 4 ? take(5) : width[c] + (ones == 2 ? 1 : 0) - (ones == 3 ? 1 : 0)) & 31;
                low_bits += width[c];
                ++coded;
            }
            at += std::uint64_t{here} * low_bits;
            for (std::uint32_t k = 0; k < here * coded && at < bits; ++k) {
                while (take(1) == 0 && at < bits) continue;
            }
        }
    };
    Words begins;
    std::uint32_t first = 0, farthest = 0;
    for (std::uint64_t group = 0; first < vertices; first += std::min(vertices - first, kVertexBlock)) {
        const std::uint64_t end = at;
        if (begins.size() % 16 == 0) {
            align();
            group = at;
        }
        const std::uint64_t begin = at;
        skip_block(std::min(vertices - first, kVertexBlock));
        if (at > bits) {
            at = end;
            break;
        }
        begins.push_back(static_cast<std::uint32_t>(begins.size() % 16 == 0 ? group / 32 : begin - group));
        if (begins.size() % 16 != 1) farthest = std::max(farthest, begins.back());
    }
    align();
    const std::uint32_t width = std::max(field, static_cast<std::uint32_t>(std::bit_width(farthest)));
    Words out(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(table));
    out[1] = first;
    out[2] = (out[2] & ~(31U << 18)) | width << 18;
    for (std::size_t block = 0; block < begins.size(); ++block) {
        if (block % 16 == 0) {
            out.push_back(begins[block]);
            out.resize(out.size() + group_words(width) - 1);
            continue;
        }
        const std::size_t group = out.size() - group_words(width) + 1, bit = (block % 16 - 1) * width;
        for (std::size_t k = 0; k < width; ++k)
            out[group + (bit + k) / 32] |= (begins[block] >> k & 1) << (bit + k) % 32;
    }
    const auto from = words.begin() + static_cast<std::ptrdiff_t>(data);
    out.insert(out.end(), from, from + static_cast<std::ptrdiff_t>(at / 32));
    out.resize(out.size() + 2);
    words = std::move(out);
}

/// Sets the checksum and, mostly, the table of blocks and the padding to valid values (docs/vertex-format.md).
void mend_vertices(Words& words, Random& random) {
    constexpr std::size_t checksum = 3;
    if (words.size() < LACEDRING_VERTICES_HEADER_WORDS + 2) return;
    words[0] = magic::kVertices;
    if (random_below(random, 16) != 0) {
        mend_blocks(words);
        std::fill(words.end() - 2, words.end(), 0U);
    }
    const auto bytes = std::as_bytes(std::span(words));
    words[checksum] = crc32(bytes.subspan(4 * (checksum + 1)), crc32(bytes.first(4 * checksum)));
}

/// Sets the triangles by the number of words, brings vertices in range, and sets the checksum (docs/seams-format.md).
void mend_seams(Words& words) {
    constexpr std::size_t head = 2, most_vertices = 4096;
    if (words.size() < head + LACEDRING_SEAMS_HEADER_WORDS) return;
    words[0] %= most_vertices;
    const std::size_t space = words.size() - head - LACEDRING_SEAMS_HEADER_WORDS;
    words[1] = static_cast<std::uint32_t>(std::min<std::size_t>(words[1], space / 3));
    const std::size_t corners = std::size_t{3} * words[1];
    for (std::size_t c = 0; c < corners && words[0] > 0; ++c) {
        std::uint32_t& v = words[head + c];
        if (words[head + c / 3 * 3] != UINT32_MAX) v %= words[0];  // UINT32_MAX: a slot without a triangle
    }
    const std::span<std::uint32_t> section = std::span(words).subspan(head + corners);
    section[0] = magic::kSeams;
    section[1] = crc32(std::as_bytes(section.subspan(2)));
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

/// Mutates bytes or whole words.
void mutate_unmended(Words& words, std::size_t max_words, Random& random) {
    if (words.empty() || random_below(random, 2) == 0) {
        const auto from = std::as_bytes(std::span(words));
        Bytes bytes(from.begin(), from.end());
        mutate_bytes(bytes, 4 * max_words);
        words = words_of(bytes);
    } else {
        mutate_words(words, random);
        words.resize(std::min(words.size(), max_words));
    }
}

template <class Use>
bool run_words(std::span<const std::byte> bytes, Use use) {
    const std::size_t size = bytes.size() / 4;
    const auto words = std::make_unique<std::uint32_t[]>(size);
    if (size > 0) std::memcpy(words.get(), bytes.data(), 4 * size);
    return use(std::span<const std::uint32_t>(words.get(), size));
}

template <Format kind>
bool run(std::span<const std::byte> bytes) {
    return run_words(bytes, [](auto words) { return use_stream(kind, words).has_value(); });
}

bool run_vertices(std::span<const std::byte> bytes) {
    return run_words(bytes, use_vertex_stream);
}

bool run_seams(std::span<const std::byte> bytes) {
    return run_words(bytes, use_seam_section);
}

template <class Mutate>
void mutate_as_words(Bytes& bytes, std::size_t max_size, Mutate mutate_stream) {
    Words words = words_of(bytes);
    mutate_stream(words, max_size / 4);
    const auto out = std::as_bytes(std::span(words));
    bytes.assign(out.begin(), out.end());
}

template <Format kind>
void mutate(Bytes& bytes, std::size_t max_size, Random& random) {
    mutate_as_words(bytes, max_size, [&](Words& words, std::size_t max) { mutate_stream(kind, words, max, random); });
}

void mutate_vertices(Bytes& bytes, std::size_t max_size, Random& random) {
    mutate_as_words(bytes, max_size, [&](Words& words, std::size_t max) { mutate_vertex_stream(words, max, random); });
}

void mutate_section(Bytes& bytes, std::size_t max_size, Random& random) {
    mutate_as_words(bytes, max_size, [&](Words& words, std::size_t max) { mutate_seam_section(words, max, random); });
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
    mutate_unmended(words, max_words, random);
    // One in sixteen is not mended, to test the checks of the header.
    if (random_below(random, 16) != 0) mend(kind, words);
}

bool use_vertex_stream(std::span<const std::uint32_t> words) {
    const Result<VertexView> view = validate_vertices(words);
    lacedring_vertices stream;
    const bool valid = lacedring_vertices_validate(words.data(), words.size(), &stream, nullptr) == LACEDRING_STATUS_OK;
    REQUIRE(view.has_value() == valid);
    if (const Result<VertexView> opened = view_vertices(words); opened && opened->decoded_bytes() < 1 << 20) {
        std::vector<std::byte> values(opened->decoded_bytes());
        REQUIRE(decode_vertices_checked(*opened, values).has_value() == valid);
    }
    if (view) {
        use_vertices(*view);
    } else {
        check_message(view.error());
    }
    return valid;
}

void mutate_vertex_stream(Words& words, std::size_t max_words, Random& random) {
    mutate_unmended(words, max_words, random);
    if (random_below(random, 16) != 0) mend_vertices(words, random);
}

bool use_seam_section(std::span<const std::uint32_t> words) {
    if (words.size() < 2 || words[1] > (words.size() - 2) / 3) return false;
    const std::size_t corners = std::size_t{3} * words[1];
    const auto section = words.subspan(2 + corners);
    const auto triangles = std::make_unique<std::uint32_t[]>(corners);
    std::ranges::copy(words.subspan(2, corners), triangles.get());
    const std::span<const std::uint32_t> exact(triangles.get(), corners);
    const Result<SeamView> view = validate_seams(section, exact, words[0]);
    Words copies(corners), vertices;
    REQUIRE(decode_seams_checked(section, exact, words[0], copies, vertices).has_value() == view.has_value());
    if (view) {
        use_seams(*view, exact);
    } else {
        check_message(view.error());
    }
    return view.has_value();
}

void mutate_seam_section(Words& words, std::size_t max_words, Random& random) {
    const std::size_t behind = words.size() < 2 ? SIZE_MAX : 2 + std::size_t{3} * words[1];
    if (behind < words.size() && random_below(random, 4) != 0) {  // mutates the blocks only
        const auto section = words.begin() + static_cast<std::ptrdiff_t>(behind);
        Words changed(section, words.end());
        mutate_seams(changed, std::span(words).subspan(2, behind - 2), words[0], random);
        words.resize(behind);
        words.insert(words.end(), changed.begin(), changed.end());
        words.resize(std::min(words.size(), max_words));
        return;
    }
    mutate_unmended(words, max_words, random);
    if (random_below(random, 16) != 0) mend_seams(words);
}

Words words_of(std::span<const std::byte> bytes) {
    Words words(bytes.size() / 4);
    if (!words.empty()) std::memcpy(words.data(), bytes.data(), 4 * words.size());
    return words;
}

extern const Target lean_target{"lean", run<Format::lean>, mutate<Format::lean>};
extern const Target packed_target{"packed", run<Format::packed>, mutate<Format::packed>};
extern const Target lr_target{"lr", run<Format::lr>, mutate<Format::lr>};
extern const Target lr_compact_target{"lr_compact", run<Format::lr_compact>, mutate<Format::lr_compact>};
extern const Target vertices_target{"vertices", run_vertices, mutate_vertices};
extern const Target seams_target{"seams", run_seams, mutate_section};

}  // namespace lacedring::fuzz
