#include "lrio/scene/float_coding.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "lrcore/base/try.h"
#include "lrio/mesh/read_formats.h"
#include "lrio/scene/deflate.h"

namespace lacedring::detail {
namespace {

constexpr std::uint32_t kQuaternions = 0x80, kMostWidth = 16;

/// Maps the bits of a float to an integer with the same order as the floats.
std::uint32_t rank_of(std::uint32_t bits) {
    return bits ^ ((bits >> 31) != 0 ? UINT32_MAX : 0x80000000U);
}
std::uint32_t bits_of(std::uint32_t rank) {
    return rank ^ ((rank >> 31) != 0 ? 0x80000000U : UINT32_MAX);
}

/// Predicts a float's rank by the line through the two previous floats of its column. Computes in doubles, where the
/// product is exact, so that compilers that fuse it with the subtraction get the same result.
std::uint32_t expected_rank(std::uint32_t last, std::uint32_t before) {
    const auto a = static_cast<double>(std::bit_cast<float>(bits_of(last)));
    const auto b = static_cast<double>(std::bit_cast<float>(bits_of(before)));
    const auto line = static_cast<float>(2 * a - b);
    return std::isfinite(line) ? rank_of(std::bit_cast<std::uint32_t>(line)) : last;
}

/// Predicts the rank of component `which` of a unit quaternion from the three others.
std::uint32_t rest_rank(const std::uint32_t* row, std::uint32_t which, bool negative) {
    double rest = 1;
    for (std::uint32_t c = 0; c < 4; ++c) {
        if (c == which) continue;
        const auto value = static_cast<double>(std::bit_cast<float>(bits_of(row[c])));
        rest -= value * value;
    }
    const auto root = static_cast<float>(rest > 0 && std::isfinite(rest) ? std::sqrt(rest) : 0.0);
    return rank_of(std::bit_cast<std::uint32_t>(negative ? -root : root));
}

/// The index of the component with the largest magnitude, plus 4 if the component is negative.
std::uint32_t largest_of(const std::uint32_t* row) {
    std::uint32_t which = 3;
    float most = -1;
    for (std::uint32_t c = 4; c-- > 0;) {
        const float size = std::fabs(std::bit_cast<float>(bits_of(row[c])));
        if (size > most) {
            most = size;
            which = c;
        }
    }
    return which + ((bits_of(row[which]) >> 31) != 0 ? 4U : 0U);
}

std::uint32_t fold(std::uint32_t difference) {
    return (difference << 1) ^ ((difference >> 31) != 0 ? UINT32_MAX : 0U);
}
std::uint32_t unfold(std::uint32_t code) {
    return (code >> 1) ^ ((code & 1) != 0 ? UINT32_MAX : 0U);
}

void put_word(std::vector<std::byte>& out, std::uint32_t word) {
    const auto bytes = std::as_bytes(std::span(&word, 1));
    out.insert(out.end(), bytes.begin(), bytes.end());
}

std::uint32_t word_of(std::span<const std::byte> bytes) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data(), sizeof word);
    return word;
}

/// Predicts the rank of component c of row i; `ranks` has all previous rows.
std::uint32_t expect(const std::vector<std::uint32_t>& ranks, std::size_t i, std::size_t width, std::size_t c) {
    const std::size_t at = i * width + c;
    if (i == 0) return 0x80000000U;
    if (i == 1) return ranks[at - width];
    return expected_rank(ranks[at - width], ranks[at - 2 * width]);
}

}  // namespace

Result<std::vector<std::byte>> encode_floats(std::span<const std::byte> bytes, std::uint32_t width, bool quaternions) {
    const std::size_t count = bytes.size() / 4, rows = count / width;
    std::vector<std::uint32_t> ranks(count);
    if (count > 0) std::memcpy(ranks.data(), bytes.data(), 4 * count);
    for (std::uint32_t& rank : ranks) rank = rank_of(rank);
    // The bit lengths of all codes, column by column; for quaternions, preceded by largest_of() of each row.
    std::vector<std::byte> lengths((quaternions ? rows : 0) + count);
    const std::size_t base = quaternions ? rows : 0;
    std::vector<std::byte> tail;
    std::uint64_t bits = 0;
    unsigned used = 0;
    for (std::size_t i = 0; i < rows; ++i) {
        const std::uint32_t largest = quaternions ? largest_of(&ranks[i * width]) : 0;
        if (quaternions) lengths[i] = static_cast<std::byte>(largest);
        for (std::uint32_t c = 0; c < width; ++c) {
            const bool is_rest = quaternions && c == largest % 4;
            const std::uint32_t expected =
                is_rest ? rest_rank(&ranks[i * width], c, largest >= 4) : expect(ranks, i, width, c);
            const std::uint32_t code = fold(ranks[i * width + c] - expected);
            const auto length = static_cast<unsigned>(std::bit_width(code));
            lengths[base + c * rows + i] = static_cast<std::byte>(length);
            if (length < 2) continue;
            bits |= static_cast<std::uint64_t>(code & ((1U << (length - 1)) - 1))
                    << used;  // without the highest bit: it is always 1
            for (used += length - 1; used >= 8; used -= 8, bits >>= 8) tail.push_back(static_cast<std::byte>(bits));
        }
    }
    if (used > 0) tail.push_back(static_cast<std::byte>(bits));
    LR_ASSIGN(const auto packed, deflate_bytes(lengths));
    std::vector<std::byte> out;
    put_word(out, width | (quaternions ? kQuaternions : 0));
    put_word(out, static_cast<std::uint32_t>(packed.size()));
    out.insert(out.end(), packed.begin(), packed.end());
    out.insert(out.end(), tail.begin(), tail.end());
    return out;
}

Result<std::vector<std::byte>> decode_floats(std::span<const std::byte> coded, std::uint64_t size) {
    if (coded.size() < 8) return malformed("floats: {} bytes are too few", coded.size());
    const std::uint32_t head = word_of(coded), width = head & 0x7f, packed = word_of(coded.subspan(4));
    const bool quaternions = (head & kQuaternions) != 0;
    coded = coded.subspan(8);
    if (head > 0xff || width == 0 || width > kMostWidth || (quaternions && width != 4) || size % (4 * width) != 0 ||
        packed > coded.size()) {
        return malformed("floats: damaged header");
    }
    const std::uint64_t count = size / 4, rows = count / width, base = quaternions ? rows : 0;
    const auto lengths = inflate_bytes(coded.first(packed), base + count);
    if (!lengths) return lengths.error();
    if (lengths->size() != base + count) return malformed("floats: {} lengths for {} floats", lengths->size(), count);
    coded = coded.subspan(packed);
    std::vector<std::uint32_t> ranks(static_cast<std::size_t>(count));
    std::uint64_t bits = 0;
    unsigned held = 0;
    std::size_t at = 0;
    for (std::size_t i = 0; i < rows; ++i) {
        std::uint32_t* row = ranks.data() + i * width;
        const auto largest = quaternions ? std::to_integer<std::uint32_t>((*lengths)[i]) : 8;
        if (quaternions && largest >= 8) return malformed("floats: no component {}", largest);
        // The largest component of a quaternion is computed from the other three, so it comes last.
        std::array<std::uint32_t, kMostWidth> codes{};
        for (std::uint32_t c = 0; c < width; ++c) {
            const auto length = std::to_integer<unsigned>((*lengths)[base + c * rows + i]);
            if (length > 32) return malformed("floats: a code of {} bits", length);
            if (length < 2) {
                codes[c] = length;
                continue;
            }
            for (; held < length - 1; held += 8) {
                if (at == coded.size()) return malformed("floats: too few bits");
                bits |= static_cast<std::uint64_t>(coded[at++]) << held;
            }
            codes[c] = static_cast<std::uint32_t>(bits & ((1ULL << (length - 1)) - 1)) | 1U << (length - 1);
            bits >>= length - 1;
            held -= length - 1;
        }
        for (std::uint32_t c = 0; c < width; ++c) {
            if (!quaternions || c != largest % 4) row[c] = expect(ranks, i, width, c) + unfold(codes[c]);
        }
        if (quaternions) row[largest % 4] = rest_rank(row, largest % 4, largest >= 4) + unfold(codes[largest % 4]);
    }
    if (at != coded.size() || bits != 0) return malformed("floats: bits after the last code");
    std::vector<std::byte> out(static_cast<std::size_t>(size));
    for (std::uint32_t& rank : ranks) rank = bits_of(rank);
    if (!ranks.empty()) std::memcpy(out.data(), ranks.data(), out.size());
    return out;
}

}  // namespace lacedring::detail
