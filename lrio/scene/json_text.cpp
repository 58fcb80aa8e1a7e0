#include "lrio/scene/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

namespace lacedring::detail {
namespace {

/// Parses text that is valid JSON.
class JsonParser {
  public:
    explicit JsonParser(std::string_view text) : at_(text.data()), end_(text.data() + text.size()) {
        if (text.starts_with("\xef\xbb\xbf")) at_ += 3;  // a byte-order mark
    }

    JsonValue value() {
        skip_space();
        if (at_ == end_) return {};
        if (*at_ == '{' || *at_ == '[') return members(*at_ == '{');
        const char* from = at_;
        if (*at_ == '"') {
            skip_string();
        } else {
            while (at_ != end_ && !is_space(*at_) && *at_ != ',' && *at_ != '}' && *at_ != ']') ++at_;
        }
        return {JsonValue::Kind::scalar, {from, at_}, {}};
    }

  private:
    static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

    void skip_space() {
        while (at_ != end_ && is_space(*at_)) ++at_;
    }

    void skip_string() {
        for (++at_; at_ != end_ && *at_ != '"'; ++at_) {
            if (*at_ == '\\' && at_ + 1 != end_) ++at_;
        }
        if (at_ != end_) ++at_;
    }

    JsonValue members(bool named) {
        JsonValue out{named ? JsonValue::Kind::object : JsonValue::Kind::array, {}, {}};
        ++at_;
        while (true) {
            skip_space();
            if (at_ == end_) return out;
            if (*at_ == '}' || *at_ == ']') {
                ++at_;
                return out;
            }
            if (*at_ == ',') {
                ++at_;
                continue;
            }
            JsonValue::Member& member = out.members.emplace_back();
            if (named) {
                const char* from = at_;
                skip_string();
                member.key = std::string_view(from, at_);
                member.key.remove_prefix(1);
                member.key.remove_suffix(1);
                skip_space();
                if (at_ != end_) ++at_;  // the colon
            }
            member.value = value();
        }
    }

    const char* at_;
    const char* end_;
};

bool is_named(std::string_view key, std::string_view name) {
    return key == name || (key.find('\\') != std::string_view::npos && plain_key(key) == name);
}

void write_value(const JsonValue& value, std::string& out) {
    if (value.kind == JsonValue::Kind::scalar) {
        out += value.text;
        return;
    }
    const bool named = value.is_object();
    out += named ? '{' : '[';
    bool first = true;
    for (const JsonValue::Member& member : value.members) {
        if (!first) out += ',';
        first = false;
        if (named) {
            out += '"';
            out += member.key;
            out += "\":";
        }
        write_value(member.value, out);
    }
    out += named ? '}' : ']';
}

}  // namespace

std::string plain_key(std::string_view key) {
    if (key.find('\\') == std::string_view::npos) return std::string(key);
    const auto parsed = nlohmann::json::parse(fmt::format("\"{}\"", key), nullptr, false);
    return parsed.is_string() ? parsed.get<std::string>() : std::string(key);
}

std::string plain_string(const JsonValue& value) {
    if (!value.is_string()) return std::string(value.text);
    return plain_key(value.text.substr(1, value.text.size() - 2));
}

const JsonValue* JsonValue::find(std::string_view name) const {
    if (!is_object()) return nullptr;
    const auto found = std::find_if(members.rbegin(), members.rend(),
                                    [name](const Member& member) { return is_named(member.key, name); });
    return found == members.rend() ? nullptr : &found->value;
}

JsonValue* JsonValue::find(std::string_view name) {
    return const_cast<JsonValue*>(std::as_const(*this).find(name));
}

std::span<const JsonValue::Member> JsonValue::list(std::string_view name) const {
    const JsonValue* found = find(name);
    if (found == nullptr || !found->is_array()) return {};
    return found->members;
}

std::span<JsonValue::Member> JsonValue::list(std::string_view name) {
    JsonValue* found = find(name);
    if (found == nullptr || !found->is_array()) return {};
    return found->members;
}

std::optional<std::uint64_t> JsonValue::integer() const {
    std::uint64_t out = 0;
    if (kind != Kind::scalar) return {};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
    if (error != std::errc() || end != text.data() + text.size()) return {};
    return out;
}

std::optional<std::uint64_t> JsonValue::integer(std::string_view name) const {
    const JsonValue* found = find(name);
    return found == nullptr ? std::nullopt : found->integer();
}

void JsonValue::remove(std::string_view name) {
    std::erase_if(members, [name](const Member& member) { return is_named(member.key, name); });
}

JsonValue& JsonValue::set(std::string_view name, JsonValue value) {
    if (JsonValue* found = find(name)) return *found = std::move(value);
    members.push_back({name, std::move(value)});
    return members.back().value;
}

JsonText::JsonText(std::string_view text) : root(JsonParser(text).value()) {}

JsonValue JsonText::real(float value) {
    return scalar(fmt::format("{}", value));
}

JsonValue JsonText::string(std::string_view plain) {
    return scalar(fmt::format("\"{}\"", plain));
}

std::string text_of(const JsonValue& value) {
    std::string out;
    write_value(value, out);
    return out;
}

}  // namespace lacedring::detail
