#include "app/report/html.h"

#include <fmt/format.h>

#include <cmath>

namespace lacedring::app {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

/// Returns the length in bytes of the UTF-8 sequence at the start of `text`, or 0 if it is invalid; sets `code` to its
/// code point.
std::size_t first_code_point(std::string_view text, std::uint32_t& code) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const std::uint32_t lead = byte(0);
    const std::size_t length = lead < 0x80                   ? 1
                               : lead >= 0xC2 && lead < 0xE0 ? 2
                               : lead >= 0xE0 && lead < 0xF0 ? 3
                               : lead >= 0xF0 && lead < 0xF5 ? 4
                                                             : 0;
    if (length == 0 || length > text.size()) return 0;
    code = length == 1 ? lead : lead & (0xFFU >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xC0U) != 0x80U) return 0;
        code = code << 6 | (byte(i) & 0x3FU);
    }
    constexpr std::uint32_t kSmallest[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool surrogate = code >= 0xD800 && code < 0xE000;
    return code < kSmallest[length] || code > 0x10FFFF || surrogate ? 0 : length;
}

/// Control characters and noncharacters: errors in an HTML document.
bool is_forbidden(std::uint32_t code) {
    return (code >= 0x7F && code < 0xA0) || (code >= 0xFDD0 && code <= 0xFDEF) || (code & 0xFFFE) == 0xFFFE;
}

}  // namespace

std::string escape_html(std::string_view text) {
    std::string out;
    while (!text.empty()) {
        std::uint32_t code = 0;
        const std::size_t length = first_code_point(text, code);
        if (length == 0 || is_forbidden(code)) {
            out += kReplacement;
        } else if (code < 0x20) {
            // U+2400 to U+241F: pictures of control characters
            out += {'\xE2', '\x90', static_cast<char>(0x80 + code)};
        } else if (code == '&') {
            out += "&amp;";
        } else if (code == '<') {
            out += "&lt;";
        } else if (code == '>') {
            out += "&gt;";
        } else if (code == '"') {
            out += "&quot;";
        } else if (code == '\'') {
            out += "&#39;";
        } else {
            out += text.substr(0, length);
        }
        text.remove_prefix(length == 0 ? 1 : length);
    }
    return out;
}

std::string name_html(std::string_view name) {
    return "<bdi>" + escape_html(name) + "</bdi>";
}

std::string grouped(std::uint64_t number) {
    std::string out = std::to_string(number);
    for (std::size_t i = out.size(); i > 3; i -= 3) out.insert(i - 3, 1, ',');
    return out;
}

std::string fixed(double number, int decimals) {
    return std::isfinite(number) ? fmt::format("{:.{}f}", number, decimals) : "–";
}

std::string counted(std::uint64_t number, std::string_view one, std::string_view many) {
    return fmt::format("{} {}", grouped(number), number == 1 ? one : many);
}

std::string png_uri(std::span<const std::byte> png) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out = "data:image/png;base64,";
    out.reserve(out.size() + (png.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < png.size(); i += 3) {
        const auto at = [&](std::size_t j) { return j < png.size() ? std::to_integer<std::uint32_t>(png[j]) : 0U; };
        const std::uint32_t three = at(i) << 16 | at(i + 1) << 8 | at(i + 2);
        out += kDigits[three >> 18];
        out += kDigits[three >> 12 & 63];
        out += i + 1 < png.size() ? kDigits[three >> 6 & 63] : '=';
        out += i + 2 < png.size() ? kDigits[three & 63] : '=';
    }
    return out;
}

std::string shell_word(std::string_view argument) {
    constexpr std::string_view kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=./:,@%";
    if (!argument.empty() && argument.find_first_not_of(kPlain) == std::string_view::npos) return std::string(argument);
    std::string out = "'";
    for (const char c : argument) c == '\'' ? out += "'\\''" : out += c;
    return out + "'";
}

}  // namespace lacedring::app
