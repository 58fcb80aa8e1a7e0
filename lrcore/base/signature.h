#pragma once
// What bytes say that they are by how they begin, so that an error can name what was given in the place of something
// else.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace lr {

/// The first word of each run of words, and of an .lr file.
namespace magic {
constexpr std::uint32_t kLean = 0x4e4c524c;       // "LRLN"
constexpr std::uint32_t kPacked = 0x4b50524c;     // "LRPK"
constexpr std::uint32_t kLr = 0x5443524c;         // "LRCT"
constexpr std::uint32_t kCompactLr = 0x4243524c;  // "LRCB"
constexpr std::uint32_t kLrFile = 0x4c46524c;     // "LRFL"
}  // namespace magic

/// "a lean stream", "a packed stream", "LR tables", "bit-efficient LR tables", "an .lr file", "a GLB file", "a PLY
/// file",
/// ...; empty where the first 4 KiB tell nothing. Untrusted input: safe. Cost: O(1).
std::string_view kind_by_signature(std::span<const std::byte> bytes);

/// The message about words whose magic number is not that of `wanted`, a phrase as above: "these are LR tables, not a
/// packed stream", or "wrong magic number" where nothing is known.
std::string wrong_magic(std::span<const std::uint32_t> words, std::string_view wanted);

}  // namespace lr
