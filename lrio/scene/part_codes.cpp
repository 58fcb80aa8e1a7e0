#include "lrio/scene/part_codes.h"

#include <algorithm>

#include "lrcore/base/try.h"
#include "lrio/mesh/read_formats.h"
#include "lrio/scene/deflate.h"

namespace lacedring::detail {
namespace {

/// Writes a number as bytes of 7 bits, the lowest bits first; the highest bit of a byte says that more bytes follow.
void put_varint(std::vector<std::byte>& out, std::uint32_t value) {
    for (; value >= 0x80; value >>= 7) out.push_back(static_cast<std::byte>(value | 0x80));
    out.push_back(static_cast<std::byte>(value));
}

/// Removes a number from the front of `from`. False: `from` does not begin with a valid number.
bool take_varint(std::span<const std::byte>& from, std::uint32_t& value) {
    value = 0;
    for (unsigned shift = 0; shift < 35 && !from.empty(); shift += 7) {
        const auto byte = std::to_integer<std::uint32_t>(from.front());
        from = from.subspan(1);
        if (shift == 28 && byte > 0xf) return false;
        value |= (byte & 0x7f) << shift;
        if (byte < 0x80) return true;
    }
    return false;
}

/// A run begins with the code of its part:
/// 0: a part without earlier runs. A folded number follows: the part minus the previous such part, minus 1.
/// 1 to kFar: a recently used part, by its position from the end of the list.
/// Above kFar: any other part, as kFar + 1 + its number.
constexpr std::size_t kFar = 64;

std::uint32_t fold_distance(std::uint32_t distance) {
    return (distance << 1) ^ ((distance >> 31) != 0 ? UINT32_MAX : 0U);
}
std::uint32_t unfold_distance(std::uint32_t code) {
    return (code >> 1) ^ ((code & 1) != 0 ? UINT32_MAX : 0U);
}

}  // namespace

Result<std::vector<std::byte>> encode_part_codes(std::span<const std::uint32_t> parts) {
    std::vector<std::byte> runs;
    std::vector<std::uint32_t> recent;  // recently used parts, the latest last
    std::vector<bool> seen;
    std::uint32_t expected = 0;
    for (std::size_t from = 0; from < parts.size();) {
        std::size_t to = from + 1;
        while (to < parts.size() && parts[to] == parts[from]) ++to;
        const std::uint32_t part = parts[from];
        if (part >= seen.size()) seen.resize(std::size_t{part} + 1, false);
        if (!seen[part]) {
            seen[part] = true;
            put_varint(runs, 0);
            put_varint(runs, fold_distance(part - expected));
            expected = part + 1;
        } else {
            const std::size_t window = std::min(recent.size(), kFar);
            const auto begin = recent.end() - static_cast<std::ptrdiff_t>(window);
            const auto at = std::find(begin, recent.end(), part);
            if (at == recent.end()) {
                put_varint(runs, static_cast<std::uint32_t>(kFar + 1) + part);
            } else {
                put_varint(runs, static_cast<std::uint32_t>(recent.end() - at));
                recent.erase(at);
            }
        }
        recent.push_back(part);
        if (recent.size() > 2 * kFar) recent.erase(recent.begin(), recent.end() - kFar);
        put_varint(runs, static_cast<std::uint32_t>(to - from - 1));
        from = to;
    }
    return deflate_bytes(runs);
}

Result<std::vector<std::uint32_t>> decode_part_codes(std::span<const std::byte> codes, std::size_t triangles,
                                                     std::size_t parts) {
    LR_ASSIGN(const auto bytes, inflate_bytes(codes, 15 * static_cast<std::uint64_t>(triangles)));
    std::span<const std::byte> runs = bytes;
    std::vector<std::uint32_t> out;
    out.reserve(triangles);
    std::vector<std::uint32_t> recent;
    std::vector<bool> seen(parts, false);
    std::size_t found = 0;
    std::uint32_t expected = 0;
    while (!runs.empty()) {
        std::uint32_t code = 0, distance = 0, more = 0, part = 0;
        if (!take_varint(runs, code) || (code == 0 && !take_varint(runs, distance)) || !take_varint(runs, more)) {
            return malformed("parts: half a run");
        }
        if (code == 0) {
            part = expected + unfold_distance(distance);
            if (part >= parts || seen[part]) return malformed("parts: part {} is not a new one", part);
            seen[part] = true;
            ++found;
            expected = part + 1;
        } else if (code <= kFar) {
            if (code > std::min(recent.size(), kFar)) return malformed("parts: a code beyond those before");
            const auto at = recent.end() - static_cast<std::ptrdiff_t>(code);
            part = *at;
            recent.erase(at);
        } else {
            part = code - static_cast<std::uint32_t>(kFar + 1);
            const std::size_t window = std::min(recent.size(), kFar);
            if (std::find(recent.end() - static_cast<std::ptrdiff_t>(window), recent.end(), part) != recent.end()) {
                return malformed("parts: part {} is among those used lately", part);
            }
        }
        if (part >= parts || !seen[part]) return malformed("parts: part {} was not there before", part);
        recent.push_back(part);
        if (recent.size() > 2 * kFar) recent.erase(recent.begin(), recent.end() - kFar);
        if (more >= triangles - out.size()) return malformed("parts: more triangles than the stream has");
        out.insert(out.end(), std::size_t{more} + 1, part);
    }
    if (out.size() != triangles || found != parts) return malformed("parts: not one for each triangle");
    return out;
}

}  // namespace lacedring::detail
