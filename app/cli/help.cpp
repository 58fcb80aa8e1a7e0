#include "app/cli/help.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string_view>
#include <vector>

namespace lacedring::app {
namespace {

constexpr std::size_t kHelpColumn = 34;  // where descriptions begin
constexpr std::size_t kCommandColumn = 12;
constexpr std::size_t kLineWidth = 110;

/// One entry: the name, and the description in lines that begin at `column`.
std::string help_entry(const std::string& name, std::string_view description, std::size_t column = kHelpColumn) {
    std::string out = "  " + name;
    out += out.size() < column ? std::string(column - out.size(), ' ') : "\n" + std::string(column, ' ');
    const std::size_t room = kLineWidth - column;
    while (!description.empty()) {
        std::size_t end = std::min(description.find('\n'), description.size());
        if (end > room) {
            end = description.rfind(' ', room);
            if (end == std::string_view::npos) end = std::min(description.find(' '), description.size());
        }
        out += description.substr(0, end);
        out += '\n';
        description.remove_prefix(std::min(end + 1, description.size()));
        if (!description.empty()) out += std::string(column, ' ');
    }
    return out;
}

/// "-o, --output FILE", "MESH...", "--weld[=attributes|position]"
std::string option_label(const CLI::Option* option) {
    if (!option->nonpositional()) {
        return option->get_name(true) + (option->get_expected_max() > 1 ? "..." : "");
    }
    std::string out;
    for (const std::string& name : option->get_snames()) out += (out.empty() ? "-" : ", -") + name;
    for (const std::string& name : option->get_lnames()) out += (out.empty() ? "--" : ", --") + name;
    if (!option->get_option_text().empty()) return out + option->get_option_text();
    return option->get_items_expected_max() == 0 ? out : out + " " + option->get_type_name();
}

std::string help_text(const CLI::Option* option) {
    const std::string& value = option->get_default_str();
    return option->get_description() + (value.empty() ? "" : " (default " + value + ")");
}

std::string usage_line(const CLI::App& app, const std::string& name) {
    std::string out = "Usage: " + name;
    if (!app.get_subcommands({}).empty()) return out + " COMMAND [OPTIONS]\n";
    for (const CLI::Option* option : app.get_options()) {
        if (!option->nonpositional())
            out += option->get_required() ? " " + option_label(option) : " [" + option_label(option) + "]";
    }
    for (const CLI::Option* option : app.get_options()) {
        if (!option->nonpositional() || !option->get_required()) continue;
        const bool is_short = !option->get_snames().empty();
        out += is_short ? " -" + option->get_snames()[0] : " --" + option->get_lnames()[0];
        out += " " + option->get_type_name();
    }
    return out + " [OPTIONS]\n";
}

class Help : public CLI::Formatter {
  public:
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode) const override {
        std::string out = name + ": " + app->get_description() + "\n\n" + usage_line(*app, name) + "\n";
        for (const CLI::App* command : app->get_subcommands({})) {
            out += help_entry(command->get_name(), command->get_description(), kCommandColumn);
        }
        if (!app->get_subcommands({}).empty()) out += "\n";
        const std::vector<const CLI::Option*> options = app->get_options();
        for (const CLI::Option* option : options) {
            if (!option->nonpositional()) out += help_entry(option_label(option), help_text(option));
        }
        std::vector<std::string> groups;
        for (const CLI::Option* option : options) {
            const std::string& group = option->get_group();
            if (option->nonpositional() && std::ranges::find(groups, group) == groups.end()) groups.push_back(group);
        }
        for (const std::string& group : groups) {
            if (group != groups.front()) out += group + ":\n";
            for (const CLI::Option* option : options) {
                if (option->nonpositional() && option->get_group() == group) {
                    out += help_entry(option_label(option), help_text(option));
                }
            }
        }
        return app->get_footer().empty() ? out : out + "\n" + app->get_footer() + "\n";
    }
};

}  // namespace

void format_help(CLI::App& program) {
    program.formatter(std::make_shared<Help>());
    program.set_help_flag("-h,--help", "show this help");
}

void add_example(CLI::App& command, const std::string& example, const std::string& document) {
    command.footer(fmt::format("Example: lacedring {}\nMore in docs/{}", example, document));
}

OptionGroup::OptionGroup(CLI::App& command, const std::string& heading)
    : command_(command), before_(command.option_defaults()->get_group()) {
    command.option_defaults()->group(heading);
}

OptionGroup::~OptionGroup() {
    command_.option_defaults()->group(before_);
}

}  // namespace lacedring::app
