#include "app/cli/arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <numeric>

#include "app/cli/print.h"

namespace lacedring::app {
namespace {

/// Edit distance (insertions, deletions, substitutions). Cost: O(|a| * |b|).
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({row[j] + 1, diagonal + 1, changed});
        }
    }
    return row.back();
}

std::string lower(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

/// "; nearest is 'NAME'" for the name that needs the fewest edits, or "" if none is near.
std::string nearest_of(const std::string& wrong, const std::vector<std::string>& names) {
    if (wrong.size() > 40) return {};
    std::string nearest;
    std::size_t least = SIZE_MAX;
    for (const std::string& name : names) {
        const std::size_t distance = edit_distance(lower(wrong), name);
        if (distance >= least) continue;
        least = distance;
        nearest = name;
    }
    if (least > 2 && (least > 4 || 2 * least > nearest.size())) return {};
    return fmt::format("; nearest is '{}'", nearest);
}

}  // namespace

std::vector<std::string> arguments(int argc, char** argv) {
    std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
    for (std::size_t i = 0; i + 1 < words.size(); ++i) {
        if (words[i] == "--") break;
        if (words[i] != "--weld" || (words[i + 1] != "position" && words[i + 1] != "attributes")) continue;
        words[i] += "=" + words[i + 1];
        words.erase(words.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    }
    return words;
}

std::string check_command(const CLI::App& program, std::vector<std::string>& words) {
    if (words.empty()) return "a command is missing";
    if (words[0].starts_with('-')) return {};
    if (words[0] == "help") {
        words.erase(words.begin());
        if (words.empty() || words[0].starts_with('-')) {
            words.assign(1, "--help");
            return {};
        }
        words.resize(1);
        words.push_back("--help");
    }
    const std::string& name = words[0];
    const std::vector<const CLI::App*> commands = program.get_subcommands({});
    if (std::ranges::any_of(commands, [&](const CLI::App* command) { return command->get_name() == name; })) return {};
    for (const char* gpu : {"render", "compare", "view"}) {
        if (name == gpu) return fmt::format("this program was built without Vulkan, and has no {}", name);
    }
    std::vector<std::string> names;
    for (const CLI::App* command : commands) names.push_back(command->get_name());
    return fmt::format("unknown command '{}'", one_line(name.substr(0, 40))) + nearest_of(name, names);
}

std::string what_is_wrong(const CLI::App& program, const CLI::ParseError& error) {
    const std::vector<std::string> rest = program.remaining(true);
    const auto unknown = std::ranges::find_if(rest, [](const std::string& word) { return word.starts_with("--"); });
    const auto commands = program.get_subcommands();
    if (error.get_exit_code() != static_cast<int>(CLI::ExitCodes::ExtrasError) || unknown == rest.end() ||
        commands.empty())
        return one_line(error.what());
    const std::string name = unknown->substr(0, unknown->find('='));
    std::vector<std::string> names;
    for (const CLI::Option* option : commands[0]->get_options()) {
        for (const std::string& known : option->get_lnames()) names.push_back("--" + known);
    }
    return fmt::format("{} has no option {}", commands[0]->get_name(), one_line(name.substr(0, 40))) +
           nearest_of(name, names);
}

std::string one_line(std::string text) {
    text = printable(std::move(text), ' ');
    text.erase(text.find_last_not_of(' ') + 1);
    return text;
}

}  // namespace lacedring::app
