#pragma once
// Prepares the words of the command line for CLI11.

#include <string>
#include <vector>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace lacedring::app {

/// The arguments, with `--weld position` joined to `--weld=position`: --weld also works without a value, so CLI11 would
/// take `position` for a mesh. Likewise `--weld attributes`.
std::vector<std::string> arguments(int argc, char** argv);

/// Turns `help` and `help COMMAND` into --help. Returns what is wrong with the command's name (missing; unknown, with
/// the nearest known one; not in this build), or "".
std::string check_command(const CLI::App& program, std::vector<std::string>& words);

/// CLI11's error as one line; for an unknown option also the command's nearest one.
std::string what_is_wrong(const CLI::App& program, const CLI::ParseError& error);

/// A message of CLI11 as one line.
std::string one_line(std::string text);

}  // namespace lacedring::app
