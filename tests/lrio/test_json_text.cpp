// Tests JsonText, a JSON document that is edited as text.

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <random>

#include "lrio/gltf/gltf_file.h"
#include "lrio/scene/json_text.h"
#include "tests/support/capture.h"

using namespace lacedring;
using detail::JsonText;
using detail::JsonValue;

namespace {

/// The same JSON with and without white space.
struct JsonPair {
    std::string spaced, tight;

    void add(const std::string& text) {
        spaced += text;
        tight += text;
    }
    void add(const JsonPair& other) {
        spaced += other.spaced;
        tight += other.tight;
    }
};

class JsonMaker {
  public:
    explicit JsonMaker(std::uint32_t seed) : random_(seed) {}

    std::uint32_t below(std::size_t n) { return static_cast<std::uint32_t>(random_() % n); }

    std::string scalar() {
        static const std::string all[] = {"null",
                                          "true",
                                          "false",
                                          "0",
                                          "-0",
                                          "-0.0",
                                          "7",
                                          "-12",
                                          "0.10",
                                          "1E+2",
                                          "1e300",
                                          "-2.50e-300",
                                          "123456789012345678901234567890",
                                          "18446744073709551616",
                                          "0.1000000000000000055511151231257827",
                                          "\"\"",
                                          "\"a b\"",
                                          "\"\\\"\"",
                                          "\"\\\\\"",
                                          "\"[{,:}]\"",
                                          "\"\\u00e9\\ud83d\\ude00\\/\\n\"",
                                          "\"\xc3\xa9\""};
        return all[below(std::size(all))];
    }
    std::string key() {
        static const std::string all[] = {"\"\"",        "\"a\"",     "\"a\"",       "\"b b\"",
                                          "\"\\u0061\"", "\"\\\"}\"", "\"\xc3\xa9\""};
        return all[below(std::size(all))];
    }
    JsonPair value(std::uint32_t depth) {
        JsonPair out;
        const std::uint32_t kind = depth == 0 ? 2 : below(3);
        space(out);
        if (kind == 2) {
            out.add(scalar());
        } else {
            out.add(kind == 0 ? "{" : "[");
            for (std::uint32_t i = 0, n = below(5); i < n; ++i) {
                if (i > 0) out.add(",");
                if (kind == 0) {
                    space(out);
                    out.add(key());
                    space(out);
                    out.add(":");
                }
                out.add(value(depth - 1));
            }
            space(out);
            out.add(kind == 0 ? "}" : "]");
        }
        space(out);
        return out;
    }

  private:
    void space(JsonPair& out) {
        for (std::uint32_t n = below(3); n > 0; --n) out.spaced += " \t\n\r"[below(4)];
    }
    std::mt19937 random_;
};

std::optional<std::uint64_t> integer_of(const std::string& text) {
    return JsonText(text).root.integer();
}

}  // namespace

TEST_CASE("unedited JSON is written unchanged except for white space") {
    for (std::uint32_t seed = 0; seed < 2000; ++seed) {
        CAPTURE(seed);
        JsonMaker maker(seed);
        const JsonPair made = maker.value(4);
        REQUIRE_MESSAGE(detail::check_json(made.spaced), "JsonMaker makes valid JSON");
        const JsonText json(made.spaced);
        REQUIRE(detail::text_of(json.root) == made.tight);
        const JsonText again(made.tight);
        REQUIRE(detail::text_of(again.root) == made.tight);
    }
    CHECK(detail::text_of(JsonText("\xef\xbb\xbf {\"a\": 1}").root) == "{\"a\":1}");
}

TEST_CASE("an edit of a JSON member leaves the text of all others unchanged") {
    const std::string names[] = {"", "a", "b b", "\"}", "\xc3\xa9", "none"};
    for (std::uint32_t seed = 0; seed < 2000; ++seed) {
        CAPTURE(seed);
        JsonMaker maker(seed);
        std::string text = "{";
        std::vector<std::array<std::string, 3>> members;  // plain name, key, value
        for (std::uint32_t i = 0, n = maker.below(8); i < n; ++i) {
            const std::string key = maker.key();
            const JsonPair value = maker.value(2);
            members.push_back({nlohmann::json::parse(key).get<std::string>(), key, value.tight});
            text += (i > 0 ? "," : "") + key + ":" + value.spaced;
        }
        text += "}";
        const std::string& name = names[maker.below(std::size(names))];
        const auto last = std::find_if(members.rbegin(), members.rend(), [&](const auto& m) { return m[0] == name; });
        JsonText json(text);
        const JsonValue* found = json.root.find(name);
        REQUIRE((found != nullptr) == (last != members.rend()));
        if (found != nullptr) REQUIRE(detail::text_of(*found) == (*last)[2]);
        if (name == "\"}" || maker.below(2) == 0) {
            json.root.remove(name);
            std::erase_if(members, [&](const auto& m) { return m[0] == name; });
        } else {
            json.root.set(name, json.number(seed));
            if (last != members.rend()) {
                (*last)[2] = std::to_string(seed);
            } else {
                members.push_back({name, "\"" + name + "\"", std::to_string(seed)});
            }
        }
        std::string expected = "{";
        for (const auto& m : members) expected += (expected.size() > 1 ? "," : "") + m[1] + ":" + m[2];
        REQUIRE(detail::text_of(json.root) == expected + "}");
    }
}

TEST_CASE("JSON integers are 0 to 2^64 - 1, without fraction and exponent") {
    CHECK(integer_of("0") == 0U);
    CHECK(integer_of("7") == 7U);
    CHECK(integer_of("4294967296") == 4294967296U);
    CHECK(integer_of("18446744073709551615") == UINT64_MAX);
    for (const char* text : {"18446744073709551616", "123456789012345678901234567890", "-1", "-0", "1.0", "1.", "1e2",
                             "1E0", "0.5", "\"7\"", "true", "null", "[7]", "{}", "[]"}) {
        CAPTURE(text);
        CHECK_FALSE(integer_of(text));
    }
    JsonText json(R"({"a":1,"a":2,"b":-3,"c":{"a":9},"d":[4]})");
    CHECK_MESSAGE(json.root.integer("a") == 2U, "the last member of a name counts");
    CHECK_FALSE(json.root.integer("b"));
    CHECK_FALSE(json.root.integer("c"));
    CHECK_FALSE(json.root.integer("none"));
    CHECK(json.root.list("d").size() == 1);
    CHECK(json.root.list("c").empty());
    CHECK_MESSAGE(json.root.find("d")->find("") == nullptr, "an array has no members");
}

TEST_CASE("JSON texts made of floats, integers, strings and booleans have their values") {
    std::mt19937 random(5);
    JsonText json("{}");
    for (int i = 0; i < 5000; ++i) {
        const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
        if (!std::isfinite(value)) continue;
        CAPTURE(value);
        const std::string text(json.real(value).text);
        REQUIRE(nlohmann::json::accept(text));
        REQUIRE(std::bit_cast<std::uint32_t>(std::strtof(text.c_str(), nullptr)) ==
                std::bit_cast<std::uint32_t>(value));
    }
    CHECK(json.number(UINT64_MAX).integer() == UINT64_MAX);
    CHECK(detail::plain_string(json.string("a b")) == "a b");
    CHECK(json.boolean(true).text == "true");
    CHECK(detail::plain_string(JsonText(R"("\u0041\n\\")").root) == "A\n\\");
    CHECK(detail::text_of(JsonText::object()) == "{}");
    CHECK(detail::text_of(JsonText::array()) == "[]");
}

TEST_CASE("JSON is nested at most 256 deep") {
    const auto nested = [](std::size_t depth, const std::string& open, const std::string& inner,
                           const std::string& close) {
        std::string out;
        for (std::size_t i = 0; i < depth; ++i) out += open;
        out += inner;
        for (std::size_t i = 0; i < depth; ++i) out += close;
        return out;
    };
    for (const auto& [open, inner, close] : {std::array<std::string, 3>{"[", "1", "]"}, {"{\"a\":", "1", "}"}}) {
        CHECK(detail::check_json(nested(256, open, inner, close)));
        CHECK_FALSE(detail::check_json(nested(257, open, inner, close)));
        CHECK_FALSE(detail::check_json(nested(1000000, open, inner, close)));
        const std::string deepest = nested(256, open, inner, close);
        CHECK(detail::text_of(JsonText(deepest).root) == deepest);
    }
    CHECK(detail::check_json("\"" + std::string(1000, '[') + "\\\"" + std::string(1000, '{') + "\""));
}
