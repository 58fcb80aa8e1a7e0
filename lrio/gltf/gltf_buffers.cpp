#include "lrio/gltf/gltf_buffers.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <system_error>

#include "lacedring/file.hpp"
#include "lrcore/base/try.h"

namespace lacedring::detail {
namespace {

namespace fs = std::filesystem;

template <class... Args>
Error cannot_open(fmt::format_string<Args...> format, Args&&... args) {
    return {ErrorCode::cannot_open, fmt::format(format, std::forward<Args>(args)...)};
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

bool equals_ignoring_case(std::string_view text, std::string_view lower) {
    return std::equal(text.begin(), text.end(), lower.begin(), lower.end(),
                      [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

/// Does the URI begin with "scheme:" (RFC 3986)? A single letter may be a Windows drive, but neither is read.
bool has_scheme(std::string_view uri) {
    const std::size_t colon = uri.find_first_of(":/?#");
    if (colon == std::string_view::npos || colon == 0 || uri[colon] != ':') return false;
    return std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '+' || c == '-' || c == '.';
    });
}

/// Decodes the part of a data URI after "data:": a media type, ignored, and the bytes.
Result<std::vector<std::byte>> decode_data_uri(std::string_view rest) {
    const std::size_t comma = rest.find(',');
    if (comma == std::string_view::npos) return malformed("a data URI without a comma");
    const std::string_view type = rest.substr(0, comma);
    const std::string_view data = rest.substr(comma + 1);
    constexpr std::string_view kBase64 = ";base64";
    std::vector<std::byte> out;
    if (type.size() >= kBase64.size() && equals_ignoring_case(type.substr(type.size() - kBase64.size()), kBase64)) {
        if (!decode_base64(data, out)) return malformed("a data URI that is not base64");
    } else {
        const std::string text = decode_percent(data);
        const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
        out.assign(bytes.begin(), bytes.end());
    }
    return out;
}

/// Is `path` in `folder` or below it? Both are absolute paths without links and dots.
bool is_inside(const fs::path& path, const fs::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace

std::string decode_percent(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 && hex_digit(text[i + 2]) >= 0) {
            out += static_cast<char>(hex_digit(text[i + 1]) * 16 + hex_digit(text[i + 2]));
            i += 2;
        } else {
            out += text[i];
        }
    }
    return out;
}

bool decode_base64(std::string_view text, std::vector<std::byte>& out) {
    static const auto kValues = [] {
        std::array<std::int8_t, 256> values{};
        values.fill(-1);
        constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        for (std::size_t i = 0; i < kDigits.size(); ++i) {
            values[static_cast<unsigned char>(kDigits[i])] = static_cast<std::int8_t>(i);
        }
        return values;
    }();
    while (text.ends_with('=')) text.remove_suffix(1);
    if (text.size() % 4 == 1) return false;
    out.resize(text.size() / 4 * 3 + (text.size() % 4 == 0 ? 0 : text.size() % 4 - 1));
    std::uint32_t bits = 0;
    std::size_t at = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const std::int8_t value = kValues[static_cast<unsigned char>(text[i])];
        if (value < 0) return false;
        bits = bits << 6U | static_cast<std::uint32_t>(value);
        // After 2, 3 and 4 digits of a group there are 12, 18 and 24 bits: one more complete byte each time.
        if (i % 4 == 1) out[at++] = static_cast<std::byte>(bits >> 4U & 0xffU);
        if (i % 4 == 2) out[at++] = static_cast<std::byte>(bits >> 2U & 0xffU);
        if (i % 4 == 3) out[at++] = static_cast<std::byte>(bits & 0xffU);
    }
    return true;
}

Result<GltfBuffers> GltfBuffers::make(const nlohmann::json& document, std::optional<std::span<const std::byte>> bin,
                                      Reading& reading) {
    GltfBuffers out(reading);
    out.bin_ = bin;
    const auto buffers = document.find("buffers");
    if (buffers == document.end()) return out;
    out.buffers_.reserve(buffers->size());
    for (const nlohmann::json& from : *buffers) {
        Buffer buffer;
        const auto length = from.is_object() ? from.find("byteLength") : from.end();
        if (length == from.end() || !length->is_number_unsigned()) {
            return malformed("glTF: buffer {} has no byteLength", out.buffers_.size());
        }
        buffer.length = length->get<std::uint64_t>();
        if (const auto uri = from.find("uri"); uri != from.end()) {
            if (!uri->is_string()) return malformed("glTF: buffer {}: the URI is not a string", out.buffers_.size());
            buffer.uri = uri->get_ptr<const std::string*>();
        }
        out.buffers_.push_back(buffer);
    }
    return out;
}

Result<std::span<const std::byte>> GltfBuffers::open(std::size_t index) {
    Buffer& buffer = buffers_[index];
    if (!buffer.bytes) {
        const auto bytes = load(index, buffer);
        if (!bytes) {
            return Error{bytes.error().code, fmt::format("buffer {}: {}", index, bytes.error().message)};
        }
        if (bytes->size() < buffer.length) {
            return malformed("buffer {}: {} bytes, where byteLength is {}", index, bytes->size(), buffer.length);
        }
        buffer.bytes = bytes->first(static_cast<std::size_t>(buffer.length));
    }
    return *buffer.bytes;
}

Result<std::span<const std::byte>> GltfBuffers::load(std::size_t index, const Buffer& buffer) {
    if (buffer.uri == nullptr) {
        if (index == 0 && bin_) return *bin_;
        return malformed("has no URI, and there is no BIN chunk for it");
    }
    return open_uri(*buffer.uri, buffer.length);
}

Result<std::span<const std::byte>> GltfBuffers::open_uri(const std::string& name, std::uint64_t most) {
    constexpr std::string_view kData = "data:";
    const std::string_view uri = name;
    if (uri.size() >= kData.size() && equals_ignoring_case(uri.substr(0, kData.size()), kData)) {
        LR_ASSIGN(auto bytes, decode_data_uri(uri.substr(kData.size())));
        loaded_bytes_ += bytes.size();
        return std::span<const std::byte>(storage_.emplace_back(std::move(bytes)));
    }
    if (has_scheme(uri)) return cannot_open("the URI {} is not a file beside the glTF", shown(uri));
    return load_file(name, most);
}

Result<std::span<const std::byte>> GltfBuffers::load_file(const std::string& uri, std::uint64_t length) {
    if (reading_->name.empty()) {
        return cannot_open("{} is a file, and a glTF without a name has no folder to look in", shown(uri));
    }
    const std::string name = decode_percent(uri);
    if (name.empty() || name.find('\0') != std::string::npos) return malformed("the URI {} names no file", shown(uri));
    const fs::path parent = reading_->name.parent_path();
    std::error_code error;
    const fs::path folder = fs::canonical(parent.empty() ? "." : parent, error);
    const fs::path path = error ? fs::path() : fs::canonical(folder / name, error);
    if (error) return cannot_open("{}: {}", shown(uri), error.message());
    if (!reading_->options.allow_outside && !is_inside(path, folder)) {
        return cannot_open("{} leaves the folder of the glTF", shown(uri));
    }
    const auto known = files_.find(path);
    if (known != files_.end() && storage_[known->second].size() >= length) {
        return std::span<const std::byte>(storage_[known->second]);
    }
    // A buffer needs more of the file than was read: reads at least twice as much as before, so that the total is
    // proportional to the file's size.
    std::uint64_t wanted = length;
    if (known != files_.end()) {
        const std::uint64_t before = storage_[known->second].size();
        wanted = std::max(length, 2 * before);
    }
    auto bytes = read_file_start(path, wanted);
    if (!bytes) return Error{bytes.error().code, fmt::format("{}: {}", shown(uri), bytes.error().message)};
    if (known == files_.end()) reading_->report.files.push_back(path);
    files_[path] = storage_.size();
    loaded_bytes_ += bytes->size();
    return std::span<const std::byte>(storage_.emplace_back(std::move(*bytes)));
}

}  // namespace lacedring::detail
