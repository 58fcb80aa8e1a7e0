#include "tests/fuzz/gltf.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <string_view>

namespace lacedring::fuzz {
namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::string_view kMarker = ";base64,";

/// Decodes up to the first character that is not a base64 digit; sets `end` to its position.
Bytes decode_base64(std::string_view text, std::size_t& end) {
    Bytes out;
    std::uint32_t bits = 0, held = 0;
    for (end = 0; end < text.size(); ++end) {
        const std::size_t digit = kDigits.find(text[end]);
        if (digit == std::string_view::npos) break;
        bits = bits << 6 | static_cast<std::uint32_t>(digit);
        held += 6;
        if (held < 8) continue;
        held -= 8;
        out.push_back(static_cast<std::byte>(bits >> held));
    }
    while (end < text.size() && text[end] == '=') ++end;
    return out;
}

std::string encode_base64(const Bytes& bytes) {
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (i + k < bytes.size() ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0);
        for (std::size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
    }
    return out;
}

void mutate_buffer(Bytes& buffer, std::size_t max_size, Random& random) {
    const std::size_t size = buffer.size();
    mutate_bytes(buffer, max_size);
    if (random_below(random, 4) != 0) buffer.resize(size);  // usually keep the length that the JSON gives
}

void mutate_json(Bytes& json, std::size_t max_size, Random& random) {
    const std::string_view text(reinterpret_cast<const char*>(json.data()), json.size());
    const std::size_t marker = text.find(kMarker);
    if (marker == std::string_view::npos || random_below(random, 2) == 0) return mutate_bytes(json, max_size);
    const std::size_t begin = marker + kMarker.size();
    std::size_t length = 0;
    Bytes buffer = decode_base64(text.substr(begin), length);
    mutate_buffer(buffer, max_size / 2, random);
    std::string out(text.substr(0, begin));
    out += encode_base64(buffer);
    out += text.substr(begin + length);
    const auto bytes = std::as_bytes(std::span(out));
    json.assign(bytes.begin(), bytes.end());
}

std::uint32_t word_at(const Bytes& bytes, std::size_t at) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + at, sizeof word);
    return word;
}

void put_word(Bytes& bytes, std::uint32_t word) {
    for (std::uint32_t shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::byte>(word >> shift));
}

/// The bytes [at, at + size), cut at the end of `bytes`.
Bytes piece(const Bytes& bytes, std::size_t at, std::size_t size) {
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(std::min(at, bytes.size()));
    const auto left = static_cast<std::size_t>(bytes.end() - begin);
    return {begin, begin + static_cast<std::ptrdiff_t>(std::min(size, left))};
}

constexpr std::uint32_t kGlbMagic = 0x46546c67, kJsonType = 0x4e4f534a, kBinType = 0x004e4942;
constexpr std::size_t kHeader = 12, kChunkHeader = 8;

bool is_glb(const Bytes& bytes) {
    return bytes.size() >= kHeader + kChunkHeader && word_at(bytes, 0) == kGlbMagic;
}

}  // namespace

GlbChunks split_glb(const Bytes& glb) {
    if (!is_glb(glb)) return {};
    Bytes json = piece(glb, kHeader + kChunkHeader, word_at(glb, kHeader));
    Bytes bin = piece(glb, kHeader + kChunkHeader + json.size() + kChunkHeader, SIZE_MAX);
    return {std::move(json), std::move(bin)};
}

Bytes join_glb(GlbChunks chunks) {
    auto& [json, bin] = chunks;
    json.resize((json.size() + 3) / 4 * 4, std::byte{' '});
    bin.resize((bin.size() + 3) / 4 * 4);
    const std::size_t size = kHeader + kChunkHeader + json.size() + kChunkHeader + bin.size();
    Bytes out;
    for (const std::size_t word : {std::size_t{kGlbMagic}, std::size_t{2}, size, json.size(), std::size_t{kJsonType}}) {
        put_word(out, static_cast<std::uint32_t>(word));
    }
    out.insert(out.end(), json.begin(), json.end());
    put_word(out, static_cast<std::uint32_t>(bin.size()));
    put_word(out, kBinType);
    out.insert(out.end(), bin.begin(), bin.end());
    return out;
}

void mutate_gltf(Bytes& bytes, std::size_t max_size, Random& random) {
    if (!is_glb(bytes)) return mutate_json(bytes, max_size, random);
    if (random_below(random, 8) == 0 || max_size < 64) return mutate_bytes(bytes, max_size);
    auto [json, bin] = split_glb(bytes);
    if (random_below(random, 2) == 0) {
        mutate_json(json, max_size - std::min(bin.size(), max_size / 2) - 32, random);
    } else {
        mutate_buffer(bin, max_size - std::min(json.size(), max_size / 2) - 32, random);
    }
    bytes = join_glb({std::move(json), std::move(bin)});
}

}  // namespace lacedring::fuzz
