#pragma once
// The text of --help: what the command does, its usage, its options in groups, an example, and the document to read.

#include <string>

namespace CLI {
class App;
}  // namespace CLI

namespace lacedring::app {

/// Sets how the help of a program, and of the commands that are added to it from now on, is written.
void format_help(CLI::App& program);

/// The last lines of a command's help. `example` is what stands after "lacedring"; `document` is a file of docs/.
void add_example(CLI::App& command, const std::string& example, const std::string& document);

/// Options that are added to the command while this lives are listed under this heading.
class OptionGroup {
  public:
    OptionGroup(CLI::App& command, const std::string& heading);
    ~OptionGroup();
    OptionGroup(const OptionGroup&) = delete;
    OptionGroup& operator=(const OptionGroup&) = delete;

  private:
    CLI::App& command_;
    std::string before_;
};

}  // namespace lacedring::app
