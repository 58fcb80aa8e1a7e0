#pragma once
// Recognizes streams and files by their first bytes, so that errors can name the kind of the input.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace lacedring {

/// First word of each stream, and of an .lr file.
namespace magic {
constexpr std::uint32_t kLean = 0x4e4c524c;       // "LRLN"
constexpr std::uint32_t kPacked = 0x3250524c;     // "LRP2"
constexpr std::uint32_t kPacked1 = 0x4b50524c;    // "LRPK", the first version
constexpr std::uint32_t kLr = 0x5443524c;         // "LRCT"
constexpr std::uint32_t kCompactLr = 0x4243524c;  // "LRCB"
constexpr std::uint32_t kVertices = 0x3156524c;   // "LRV1"
constexpr std::uint32_t kSeams = 0x3153524c;      // "LRS1"
constexpr std::uint32_t kLrFile = 0x4c46524c;     // "LRFL"
}  // namespace magic

/// Returns the kind as a phrase: "a lean stream", "a packed stream", "LR tables", "bit-efficient LR tables", "an .lr
/// file", "a GLB file", "a PLY file", ...; empty if the first 4 KiB do not identify it. Untrusted input: safe. Cost:
/// O(1).
std::string_view kind_by_signature(std::span<const std::byte> bytes);

/// Error message for words with another magic number than `wanted` (a phrase as above): "these are LR tables, not a
/// packed stream", or "wrong magic number" if the kind is unknown.
std::string wrong_magic(std::span<const std::uint32_t> words, std::string_view wanted);

}  // namespace lacedring
