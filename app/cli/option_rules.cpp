#include "app/cli/option_rules.h"

#include <CLI/CLI.hpp>
#include <utility>

namespace lacedring::app {
namespace {

bool is_given(const CLI::App& command, const std::string& option) {
    const CLI::Option* found = command.get_option_no_throw(option);
    return found != nullptr && found->count() != 0;
}

}  // namespace

OptionRules& OptionRules::only_with(std::initializer_list<const char*> options, std::string with,
                                    std::function<bool()> applies) {
    for (const char* option : options) {
        rules_.push_back(
            {option, std::string(option) + " applies only with " + with, [applies] { return !applies(); }});
    }
    return *this;
}

OptionRules& OptionRules::never_with(std::initializer_list<const char*> options, const char* other) {
    for (const char* option : options) {
        rules_.push_back({option, std::string(option) + " has no effect with " + other,
                          [&command = command_, name = std::string(other)] { return is_given(command, name); }});
    }
    return *this;
}

OptionRules& OptionRules::forbid(std::string message, std::function<bool()> wrong) {
    rules_.push_back({"", std::move(message), std::move(wrong)});
    return *this;
}

void OptionRules::check() const {
    for (const Rule& rule : rules_) {
        if (!rule.option.empty() && !is_given(command_, rule.option)) continue;
        if (rule.broken()) throw CLI::ValidationError(rule.message);
    }
}

}  // namespace lacedring::app
