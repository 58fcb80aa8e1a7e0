#pragma once
// Choices by name, for scripts (`set NAME VALUE`), panels and keys.

#include <span>
#include <string_view>

#include "app/view/ui/state.h"

namespace lacedring::view {

struct NamedValue {
    const char* name;   ///< in scripts
    const char* label;  ///< on panels; null: not on panels
    double value;
};

struct Setting {
    const char* name;
    std::span<const NamedValue> values;  ///< empty: the setting is a number
    double low, high;
    bool whole;
    double (*get)(const Choices& choices);
    void (*set)(Choices& choices, double value);
};

std::span<const Setting> settings();
/// Null: no setting has this name.
const Setting* find_setting(std::string_view name);
// Actions that change settings. The names must be valid.
Action set(std::string_view name, double value);
Action set(std::string_view name, std::string_view value);
/// Sets to `value`, or to `other` if it is `value` already.
Action toggle(const Choices& choices, std::string_view name, std::string_view value = "on",
              std::string_view other = "off");
/// Sets the next value of the setting's list, or the previous one if `back`.
Action cycle(const Choices& choices, std::string_view name, bool back);
/// The action for `set NAME VALUE` of a script. Errors: invalid_argument, with the values that the setting has.
Result<Action> parse_setting(std::string_view name, const std::string& value);

}  // namespace lacedring::view
