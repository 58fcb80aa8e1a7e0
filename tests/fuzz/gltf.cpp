#include "tests/fuzz/gltf.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <string_view>

namespace lacedring::fuzz {
namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::string_view kMarker = ";base64,";

/// Decodes up to the first character that is no digit, and says where that is.
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
    if (random_below(random, 4) != 0) buffer.resize(size);  // the JSON says its length
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

/// A piece of `bytes`, cut where they end.
Bytes piece(const Bytes& bytes, std::size_t at, std::size_t size) {
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(std::min(at, bytes.size()));
    const auto left = static_cast<std::size_t>(bytes.end() - begin);
    return {begin, begin + static_cast<std::ptrdiff_t>(std::min(size, left))};
}

}  // namespace

void mutate_gltf(Bytes& bytes, std::size_t max_size, Random& random) {
    constexpr std::uint32_t glb_magic = 0x46546c67, json_type = 0x4e4f534a, bin_type = 0x004e4942;
    constexpr std::size_t header = 12, chunk_header = 8;
    if (bytes.size() < header + chunk_header || word_at(bytes, 0) != glb_magic)
        return mutate_json(bytes, max_size, random);
    if (random_below(random, 8) == 0 || max_size < 64) return mutate_bytes(bytes, max_size);
    Bytes json = piece(bytes, header + chunk_header, word_at(bytes, header));
    Bytes bin = piece(bytes, header + chunk_header + json.size() + chunk_header, SIZE_MAX);
    if (random_below(random, 2) == 0) {
        mutate_json(json, max_size - std::min(bin.size(), max_size / 2) - 32, random);
    } else {
        mutate_buffer(bin, max_size - std::min(json.size(), max_size / 2) - 32, random);
    }
    json.resize((json.size() + 3) / 4 * 4, std::byte{' '});
    bin.resize((bin.size() + 3) / 4 * 4);
    const std::size_t size = header + chunk_header + json.size() + chunk_header + bin.size();
    bytes.clear();
    for (const std::size_t word : {std::size_t{glb_magic}, std::size_t{2}, size, json.size(), std::size_t{json_type}}) {
        put_word(bytes, static_cast<std::uint32_t>(word));
    }
    bytes.insert(bytes.end(), json.begin(), json.end());
    put_word(bytes, static_cast<std::uint32_t>(bin.size()));
    put_word(bytes, bin_type);
    bytes.insert(bytes.end(), bin.begin(), bin.end());
}

}  // namespace lacedring::fuzz
