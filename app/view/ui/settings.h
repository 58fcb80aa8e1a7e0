#pragma once
// Choices by name: what `set NAME VALUE` of a script, the panels and the keys change.

#include <span>
#include <string_view>

#include "app/view/ui/state.h"

namespace lacedring::view {

struct NamedValue {
    const char* name;   ///< in scripts
    const char* label;  ///< in panels; null: not offered there
    double value;
};

struct Setting {
    const char* name;
    std::span<const NamedValue> values;  ///< empty: a number
    double low, high;
    bool whole;
    double (*get)(const Choices& choices);
    void (*set)(Choices& choices, double value);
};

std::span<const Setting> settings();
/// Null: there is none of that name.
const Setting* find_setting(std::string_view name);
/// Of names that this program has written.
Action set(std::string_view name, double value);
Action set(std::string_view name, std::string_view value);
/// To `value`, or from there to `other`.
Action toggle(const Choices& choices, std::string_view name, std::string_view value = "on",
              std::string_view other = "off");
/// The next value of a list, or the previous one.
Action cycle(const Choices& choices, std::string_view name, bool back);
/// What a script wrote. Errors: invalid_argument, saying what the setting has.
Result<Action> parse_setting(std::string_view name, const std::string& value);

}  // namespace lacedring::view
