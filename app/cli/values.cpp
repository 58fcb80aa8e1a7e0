#include "app/cli/values.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <optional>
#include <string_view>

namespace lacedring::app {
namespace {

/// A plus sign is allowed in front of every number.
std::string_view without_plus(std::string_view text) {
    return text.size() > 1 && text[0] == '+' && text[1] != '-' ? text.substr(1) : text;
}

std::optional<double> parse_number(std::string_view text) {
    text = without_plus(text);
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || rest != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::string take_digits(std::string_view& text) {
    const std::size_t count = std::min(text.find_first_not_of("0123456789"), text.size());
    const std::string digits(text.substr(0, count));
    text.remove_prefix(count);
    return digits;
}

/// Digits, as in 1500, 1e6 or 1.5e3. Exact: no double is involved.
std::optional<std::uint64_t> parse_whole_number(std::string_view text) {
    text = without_plus(text);
    std::string digits = take_digits(text);
    int power = 0;
    if (text.starts_with('.')) {
        text.remove_prefix(1);
        const std::string fraction = take_digits(text);
        if (fraction.size() > 20) return std::nullopt;
        digits += fraction;
        power = -static_cast<int>(fraction.size());
    }
    if (digits.empty()) return std::nullopt;
    if (text.starts_with('e') || text.starts_with('E')) {
        text.remove_prefix(text.starts_with("e+") || text.starts_with("E+") ? 2 : 1);
        int exponent = 0;
        const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), exponent);
        if (error != std::errc() || exponent < 0 || exponent > 20) return std::nullopt;
        power += exponent;
        text.remove_prefix(static_cast<std::size_t>(rest - text.data()));
    }
    if (!text.empty() || power < 0) return std::nullopt;
    digits.append(static_cast<std::size_t>(power), '0');
    std::uint64_t value = 0;
    const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || rest != digits.data() + digits.size()) return std::nullopt;
    return value;
}

/// `accept` may change the text; false refuses it. `allowed` is for messages, `shown` for the description.
CLI::Option* allow(CLI::Option* option, std::function<bool(std::string&)> accept, const std::string& allowed,
                   const std::string& shown) {
    std::string description = option->get_description();
    if (const std::size_t at = description.find("{}"); at != std::string::npos) {
        option->description(description.replace(at, 2, shown));
    }
    return option->transform(CLI::Validator(
        [accept = std::move(accept), allowed](std::string& text) {
            const std::string given = text;
            return accept(text) ? std::string() : refusal(given, allowed);
        },
        ""));
}

CLI::Option* allow_real(CLI::Option* option, std::function<bool(double)> in_range, const std::string& allowed,
                        const std::string& shown) {
    return allow(
        option->type_name("F"),
        [in_range = std::move(in_range)](const std::string& text) {
            const std::optional<double> value = parse_number(text);
            return value && in_range(*value);
        },
        "a number" + (allowed.empty() ? allowed : " " + allowed), shown);
}

}  // namespace

CLI::Option* allow_whole_numbers(CLI::Option* option, std::uint64_t least, std::uint64_t most,
                                 const std::string& word) {
    const std::string range = fmt::format("{} to {}", least, most);
    return allow(
        option->type_name("N"),
        [=](std::string& text) {
            if (!word.empty() && text == word) return true;
            const std::optional<std::uint64_t> value = parse_whole_number(text);
            if (!value || *value < least || *value > most) return false;
            text = fmt::format("{}", *value);
            return true;
        },
        fmt::format("a whole number from {}{}", range, word.empty() ? word : " or " + word), range);
}

CLI::Option* allow_numbers(CLI::Option* option, double least, double most) {
    const std::string range = fmt::format("{} to {}", least, most);
    const bool any = least == -kNoLimit && most == kNoLimit;
    return allow_real(
        option, [=](double value) { return value >= least && value <= most; }, any ? "" : "from " + range, range);
}

CLI::Option* allow_numbers_between(CLI::Option* option, double lower, double upper) {
    const std::string range =
        upper == kNoLimit ? fmt::format("above {}", lower) : fmt::format("above {} and below {}", lower, upper);
    return allow_real(
        option, [=](double value) { return value > lower && value < upper; }, range, range);
}

CLI::Option* allow_words(CLI::Option* option, const std::vector<std::string>& words) {
    return allow(
        option->type_name("NAME"),
        [words](const std::string& text) { return std::find(words.begin(), words.end(), text) != words.end(); },
        or_list(words), or_list(words));
}

std::string refusal(const std::string& text, const std::string& allowed) {
    constexpr std::size_t kMost = 40;
    return fmt::format("'{}{}' is not {}", text.substr(0, kMost), text.size() > kMost ? "..." : "", allowed);
}

std::string or_list(const std::vector<std::string>& words) {
    std::string out;
    for (std::size_t i = 0; i < words.size(); ++i) {
        out += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
    }
    return out;
}

}  // namespace lacedring::app
