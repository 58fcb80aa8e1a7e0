#include "lrcore/base/signature.h"

#include <algorithm>
#include <cstring>

namespace lacedring {
namespace {

constexpr std::size_t kLookedAt = 4096;

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/// The first word of the text, comment lines skipped.
std::string_view first_word(std::string_view text) {
    while (!text.empty()) {
        if (is_space(text.front())) {
            text.remove_prefix(1);
        } else if (text.front() == '#') {
            text.remove_prefix(std::min(text.find('\n'), text.size()));
        } else {
            return text.substr(
                0, static_cast<std::size_t>(std::find_if(text.begin(), text.end(), is_space) - text.begin()));
        }
    }
    return {};
}

std::string_view text_kind(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    const std::string_view word = first_word(text);
    if (word.starts_with('{')) return "a glTF file";
    if (word == "ply") return "a PLY file";
    if (word == "solid") return "an STL file";
    if (word.size() <= 7 && word.ends_with("OFF")) return "an OFF file";
    constexpr std::string_view kObj[] = {"v", "vn", "vt", "f", "o", "g", "s", "mtllib", "usemtl"};
    return std::ranges::find(kObj, word) == std::end(kObj) ? "" : "an OBJ file";
}

}  // namespace

std::string_view kind_by_signature(std::span<const std::byte> bytes) {
    std::uint32_t first = 0;
    if (bytes.size() >= sizeof first) std::memcpy(&first, bytes.data(), sizeof first);
    switch (first) {
        case magic::kLean:
            return "a lean stream";
        case magic::kPacked:
            return "a packed stream";
        case magic::kPacked1:
            return "a packed stream of version 1";
        case magic::kLr:
            return "LR tables";
        case magic::kCompactLr:
            return "bit-efficient LR tables";
        case magic::kVertices:
            return "a vertex stream";
        case magic::kSeams:
            return "a seam section";
        case magic::kLrFile:
            return "an .lr file";
        case 0x46546c67:  // "glTF"
            return "a GLB file";
        default:
            break;
    }
    constexpr std::size_t kStlHeader = 80, kStlTriangle = 50;
    std::uint32_t triangles = 0;
    if (bytes.size() > kStlHeader + sizeof triangles) {
        std::memcpy(&triangles, bytes.data() + kStlHeader, sizeof triangles);
        if (bytes.size() - kStlHeader - sizeof triangles == std::uint64_t{triangles} * kStlTriangle)
            return "an STL file";
    }
    return text_kind({reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), kLookedAt)});
}

std::string wrong_magic(std::span<const std::uint32_t> words, std::string_view wanted) {
    const std::string_view kind = kind_by_signature(std::as_bytes(words));
    if (kind.empty()) return "wrong magic number";
    const bool one = kind.starts_with("a ") || kind.starts_with("an ");
    return std::string(one ? "this is " : "these are ").append(kind).append(", not ").append(wanted);
}

}  // namespace lacedring
