#include "app/view/ui/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace lacedring::view {
namespace {

template <class T>
constexpr NamedValue named(const char* name, const char* label, T value) {
    return {name, label, static_cast<double>(value)};
}

constexpr NamedValue kOnOff[] = {named("off", "off", 0), named("on", "on", 1)};
/// Values with the renderer's names and labels.
template <class Choice, std::size_t N>
constexpr std::array<NamedValue, N> values_of(const std::array<gpu::Named<Choice>, N>& table) {
    std::array<NamedValue, N> out;
    for (std::size_t i = 0; i < N; ++i) out[i] = named(table[i].name, table[i].label, table[i].value);
    return out;
}
constexpr auto kViews = values_of(gpu::kViews);
constexpr auto kAllSources = values_of(gpu::kSources);
// All sources but packed vertices, which the viewer does not draw.
constexpr auto kSources = std::span(kAllSources).first<3>();
static_assert(gpu::kSources[2].value == gpu::Source::packed);
constexpr auto kPaths = values_of(gpu::kPaths);
constexpr NamedValue kModes[] = {named("single", "off", Mode::single), named("split", "side by side", Mode::split),
                                 named("difference", "difference", Mode::difference)};
constexpr NamedValue kPaints[] = {named("none", "none", Paint::none), named("corridors", "corridors", Paint::corridors),
                                  named("blocks", "blocks", Paint::blocks),
                                  named("growth", "ring-expander", Paint::growth)};
constexpr NamedValue kRings[] = {named("expander", "ring-expander", 0), named("hybrid", "hybrid", 1)};
constexpr NamedValue kWelds[] = {named("position", "by position", Weld::position),
                                 named("attributes", "by all attributes", Weld::attributes),
                                 named("none", "no", Weld::none)};

/// Makes a setting. `Field` returns its field of Choices; `Then` runs after the field was changed.
template <class Field, class Then>
constexpr Setting setting(const char* name, std::span<const NamedValue> values, double low, double high, bool whole,
                          Field, Then) {
    return {name,
            values,
            low,
            high,
            whole,
            [](const Choices& choices) { return static_cast<double>(Field{}(const_cast<Choices&>(choices))); },
            [](Choices& choices, double value) {
                auto& field = Field{}(choices);
                field = static_cast<std::remove_reference_t<decltype(field)>>(value);
                Then{}(choices);
            }};
}
constexpr auto kNothing = [](Choices&) {};

template <class Field, class Then = decltype(kNothing)>
constexpr Setting list(const char* name, std::span<const NamedValue> values, Field field, Then then = kNothing) {
    return setting(name, values, 0, 0, true, field, then);
}
template <class Field, class Then = decltype(kNothing)>
constexpr Setting whole(const char* name, double low, double high, Field field, Then then = kNothing) {
    return setting(name, {}, low, high, true, field, then);
}
template <class Field>
constexpr Setting number(const char* name, double low, double high, Field field) {
    return setting(name, {}, low, high, false, field, kNothing);
}
template <Drawer Which>
constexpr Setting drawer(const char* name) {
    return {name,
            kOnOff,
            0,
            0,
            true,
            [](const Choices& choices) { return choices.drawer == Which ? 1.0 : 0.0; },
            [](Choices& choices, double on) { choices.drawer = on != 0 ? Which : Drawer::none; }};
}

constexpr std::array kSettings{
    list(
        "view", kViews, [](Choices& c) -> auto& { return c.shown.view; }, [](Choices& c) { c.view_chosen = true; }),
    list(
        "mode", kModes, [](Choices& c) -> auto& { return c.shown.mode; }),
    list(
        "source", kSources, [](Choices& c) -> auto& { return c.shown.source; }),
    list(
        "path", kPaths, [](Choices& c) -> auto& { return c.shown.path; }),
    list(
        "paint", kPaints, [](Choices& c) -> auto& { return c.paint; },
        [](Choices& c) {
            c.growth = 0;
            c.growing = c.paint == Paint::growth;
        }),
    list(
        "ring", kRings, [](Choices& c) -> auto& { return c.ring.hybrid; }),
    list(
        "weld", kWelds, [](Choices& c) -> auto& { return c.weld; }),
    list(
        "ring-line", kOnOff, [](Choices& c) -> auto& { return c.ring_line; }),
    list(
        "outlines", kOnOff, [](Choices& c) -> auto& { return c.outlines; }),
    list(
        "warts", kOnOff, [](Choices& c) -> auto& { return c.ring.warts; }),
    list(
        "decode", kOnOff, [](Choices& c) -> auto& { return c.shown.decode_again; }),
    list(
        "turntable", kOnOff, [](Choices& c) -> auto& { return c.turntable; }),
    list(
        "growing", kOnOff, [](Choices& c) -> auto& { return c.growing; }),
    list(
        "panels", kOnOff, [](Choices& c) -> auto& { return c.panels; }),
    list(
        "help", kOnOff, [](Choices& c) -> auto& { return c.help; }),
    drawer<Drawer::choices>("choices"),
    drawer<Drawer::numbers>("numbers"),
    whole(
        "samples", 1, 3, [](Choices& c) -> auto& { return c.shown.samples; }),
    whole(
        "k", 1, 1e6, [](Choices& c) -> auto& { return c.ring.k; }),
    whole(
        "seeds", 1, 1e4, [](Choices& c) -> auto& { return c.ring.seeds; }),
    whole(
        "seed", 0, 1e6, [](Choices& c) -> auto& { return c.ring.random_seed; }),
    whole(
        "passes", 0, 1e4, [](Choices& c) -> auto& { return c.ring.passes; }),
    whole(
        "growth", 0, 4e9, [](Choices& c) -> auto& { return c.growth; }, [](Choices& c) { c.growing = false; }),
    whole(
        "fps", 0, 1000, [](Choices& c) -> auto& { return c.frame_cap; }),
    number(
        "speed", 1, 1e6, [](Choices& c) -> auto& { return c.growth_speed; }),
    number(
        "turntable-speed", -360, 360, [](Choices& c) -> auto& { return c.turntable_speed; }),
    number(
        "divider", 0, 1, [](Choices& c) -> auto& { return c.divider; }),
};

Error wrong_value(const std::string& why) {
    return {ErrorCode::invalid_argument, why};
}

}  // namespace

Layers Choices::layers() const {
    const bool shows_ring = gpu::has_ring(shown.view) || shown.view == gpu::View::silhouette;
    return {paint == Paint::growth ? Paint::none : paint, paint == Paint::growth     ? Paint::growth
                                                          : ring_line && !shows_ring ? Paint::ring
                                                                                     : Paint::none};
}

std::span<const Setting> settings() {
    return kSettings;
}

const Setting* find_setting(std::string_view name) {
    const auto found = std::ranges::find(kSettings, name, &Setting::name);
    return found == kSettings.end() ? nullptr : &*found;
}

Action set(std::string_view name, double value) {
    return action::Set{find_setting(name), value};
}

Action set(std::string_view name, std::string_view value) {
    const Setting* setting = find_setting(name);
    return action::Set{setting, std::ranges::find(setting->values, value, &NamedValue::name)->value};
}

Action toggle(const Choices& choices, std::string_view name, std::string_view value, std::string_view other) {
    const Action to = set(name, value);
    return find_setting(name)->get(choices) == std::get<action::Set>(to).value ? set(name, other) : to;
}

Action cycle(const Choices& choices, std::string_view name, bool back) {
    const Setting* setting = find_setting(name);
    const std::size_t count = setting->values.size();
    const auto at = std::ranges::find(setting->values, setting->get(choices), &NamedValue::value);
    const auto i = static_cast<std::size_t>(at - setting->values.begin());
    return action::Set{setting, setting->values[(i + (back ? count - 1 : 1)) % count].value};
}

Result<Action> parse_setting(std::string_view name, const std::string& value) {
    const Setting* setting = find_setting(name);
    if (setting == nullptr) return wrong_value(fmt::format("no setting is called {}", name));
    for (const NamedValue& one : setting->values) {
        if (value == one.name) return Action(action::Set{setting, one.value});
    }
    if (setting->values.data() == kOnOff) return wrong_value(fmt::format("{} is on or off", name));
    if (!setting->values.empty()) return wrong_value(fmt::format("no such {}: {}", name, value));
    double number = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (error != std::errc() || end != value.data() + value.size() || !std::isfinite(number) || number < setting->low ||
        number > setting->high || (setting->whole && number != std::floor(number))) {
        return wrong_value(fmt::format("{} is a {}number from {} to {}", name, setting->whole ? "whole " : "",
                                       setting->low, setting->high));
    }
    return Action(action::Set{setting, number});
}

}  // namespace lacedring::view
