// lacedring view [MESH]: runs lacedring-view, a program of its own, so that no other command loads a window library.

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>

#include "app/commands/commands.h"

namespace lacedring::app {
namespace {

int run(const std::vector<std::string>& arguments) {
    std::error_code error;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
    const std::string viewer = (self.parent_path() / "lacedring-view").string();
    std::vector<std::string> words{"lacedring view"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    execv(viewer.c_str(), argv.data());
    const bool missing = errno == ENOENT;
    say("lacedring: {}: {}{}\n", viewer, std::strerror(errno),
        missing ? "; cmake --build BUILD --target lacedring-view makes it" : "");
    return no_device;
}

}  // namespace

void add_view(CLI::App& program, Action& action) {
    CLI::App* command = program.add_subcommand("view", "open a window that shows a mesh, its ring and its formats");
    command->set_help_flag();  // the viewer's own
    command->prefix_command();
    command->callback([command, &action] { action = [words = command->remaining()](RunLog&) { return run(words); }; });
}

}  // namespace lacedring::app
