#pragma once
// A JSON document that is edited as text: what nobody touches is written as it was read, the digits of its numbers and
// the escapes of its strings included, and members keep their order. Internal to lrio.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lacedring::detail {

/// A value: an object, an array, or anything else by its text. Texts are views of the document's, or of its JsonText's.
struct JsonValue {
    enum class Kind : std::uint8_t { scalar, array, object };
    struct Member;

    Kind kind = Kind::scalar;
    std::string_view text = "null";  ///< of a scalar, a string's quotes included
    std::vector<Member> members;     ///< of an object, or of an array (keys are empty)

    bool is_object() const { return kind == Kind::object; }
    bool is_array() const { return kind == Kind::array; }
    bool is_string() const { return kind == Kind::scalar && text.starts_with('"'); }
    std::size_t size() const;

    /// The member of that name, the last one if there are several; null: none, or this is no object.
    JsonValue* find(std::string_view name);
    const JsonValue* find(std::string_view name) const;
    /// The elements of the array of that name; none if there is no such array.
    std::span<Member> list(std::string_view name);
    std::span<const Member> list(std::string_view name) const;
    /// A number that is an integer from 0 on, written without fraction or exponent.
    std::optional<std::uint64_t> integer() const;
    /// The integer of the member `name`, as above.
    std::optional<std::uint64_t> integer(std::string_view name) const;

    void remove(std::string_view name);
    /// Adds the member, or replaces it where it stands. `name` outlives the document, or is a view of its text.
    JsonValue& set(std::string_view name, JsonValue value);
};

struct JsonValue::Member {
    std::string_view key;  ///< without quotes, as it is written
    JsonValue value;
};

inline std::size_t JsonValue::size() const {
    return members.size();
}

/// A document and the texts that were made for it.
class JsonText {
  public:
    /// `text` is valid JSON, nested no deeper than a parser of it went; it outlives this.
    explicit JsonText(std::string_view text);

    JsonValue root;

    JsonValue number(std::uint64_t value) { return scalar(std::to_string(value)); }
    /// The shortest digits that make this float.
    JsonValue real(float value);
    JsonValue string(std::string_view plain);  ///< ASCII without quotes, backslashes and control characters
    JsonValue boolean(bool value) const { return {JsonValue::Kind::scalar, value ? "true" : "false", {}}; }
    static JsonValue object() { return {JsonValue::Kind::object, {}, {}}; }
    static JsonValue array() { return {JsonValue::Kind::array, {}, {}}; }

  private:
    JsonValue scalar(std::string text) { return {JsonValue::Kind::scalar, texts_.emplace_back(std::move(text)), {}}; }
    std::deque<std::string> texts_;
};

/// The value without white space between its parts.
std::string text_of(const JsonValue& value);

/// The characters that a string or a key stands for.
std::string plain_string(const JsonValue& value);
std::string plain_key(std::string_view key);

}  // namespace lacedring::detail
