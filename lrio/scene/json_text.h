#pragma once
// A JSON document that is edited as text: unchanged values are written exactly as read, including the digits of numbers
// and the escapes of strings, and members keep their order. Internal to lrio.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lacedring::detail {

/// An object, an array, or a scalar (any other value) with its text. Texts are views of the document or of its
/// JsonText.
struct JsonValue {
    enum class Kind : std::uint8_t { scalar, array, object };
    struct Member;

    Kind kind = Kind::scalar;
    std::string_view text = "null";  ///< a scalar's text, including the quotes of a string
    std::vector<Member> members;     ///< of an object, or of an array (with empty keys)

    bool is_object() const { return kind == Kind::object; }
    bool is_array() const { return kind == Kind::array; }
    bool is_string() const { return kind == Kind::scalar && text.starts_with('"'); }
    std::size_t size() const;

    /// The member `name`, the last one if there are several; null if there is none or this is not an object.
    JsonValue* find(std::string_view name);
    const JsonValue* find(std::string_view name) const;
    /// The elements of the member `name`; empty if it is not an array.
    std::span<Member> list(std::string_view name);
    std::span<const Member> list(std::string_view name) const;
    /// The value if it is an integer >= 0, written without fraction or exponent.
    std::optional<std::uint64_t> integer() const;
    /// integer() of the member `name`.
    std::optional<std::uint64_t> integer(std::string_view name) const;

    void remove(std::string_view name);
    /// Replaces the value of a member in place, or adds the member. `name` outlives the document, or is a view of its
    /// text.
    JsonValue& set(std::string_view name, JsonValue value);
};

struct JsonValue::Member {
    std::string_view key;  ///< without quotes, with escapes
    JsonValue value;
};

inline std::size_t JsonValue::size() const {
    return members.size();
}

/// A document, and the texts of the values made for it.
class JsonText {
  public:
    /// `text` is JSON that check_json (gltf_file.h) accepts; it outlives this.
    explicit JsonText(std::string_view text);

    JsonValue root;

    JsonValue number(std::uint64_t value) { return scalar(std::to_string(value)); }
    /// Writes the shortest digits that read back as the same float.
    JsonValue real(float value);
    JsonValue string(std::string_view plain);  ///< `plain`: no quotes, backslashes or control characters
    JsonValue boolean(bool value) const { return {JsonValue::Kind::scalar, value ? "true" : "false", {}}; }
    static JsonValue object() { return {JsonValue::Kind::object, {}, {}}; }
    static JsonValue array() { return {JsonValue::Kind::array, {}, {}}; }

  private:
    JsonValue scalar(std::string text) { return {JsonValue::Kind::scalar, texts_.emplace_back(std::move(text)), {}}; }
    std::deque<std::string> texts_;
};

/// Writes the value without white space between tokens.
std::string text_of(const JsonValue& value);

/// A string value, or a key, without quotes and escapes.
std::string plain_string(const JsonValue& value);
std::string plain_key(std::string_view key);

}  // namespace lacedring::detail
