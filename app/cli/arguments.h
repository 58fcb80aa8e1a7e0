#pragma once
// The words of the command line before CLI11 sees them.

#include <string>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace lacedring::app {

/// The arguments, with `--weld position` as `--weld=position`: --weld alone takes no value, so that CLI11 would take
/// the word for a mesh.
std::vector<std::string> arguments(int argc, char** argv);

/// Turns `help` and `help COMMAND` into --help. Empty, or what is wrong with the command's name: an unknown one, with
/// the nearest known one, or one that this program was built without.
std::string check_command(const CLI::App& program, std::vector<std::string>& words);

/// A message of CLI11 as one line.
std::string one_line(std::string text);

}  // namespace lacedring::app
