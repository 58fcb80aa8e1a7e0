// lacedring: parses the command line, runs one command, and turns what went wrong into one line and an exit code.

#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

#include "app/command.h"
#include "app/commands.h"

namespace {

int run(int argc, char** argv) {
    CLI::App program("LacedRing: mesh connectivity in one reference per triangle, drawn straight from the GPU");
    program.name("lacedring");
    program.set_version_flag("--version", LACEDRING_VERSION);
    program.require_subcommand(1);
    program.failure_message([](const CLI::App*, const CLI::Error& error) {
        return fmt::format("lacedring: {} (lacedring --help lists the commands)\n", error.what());
    });
    lr::app::Action action;
    lr::app::add_commands(program, action);
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        const int code = program.exit(error);
        return code == 0 ? lr::app::done : lr::app::wrong_usage;
    }
    const int code = action();
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
        std::fputs("lacedring: standard output: cannot be written\n", stderr);
        return code == lr::app::done ? lr::app::bad_input : code;
    }
    return code;
}

}  // namespace

int main(int argc, char** argv) {
    std::signal(SIGXFSZ, SIG_IGN);  // a file past its size limit is an error to report, not a death
    try {
        return run(argc, argv);
    } catch (const std::bad_alloc&) {
        std::fputs("lacedring: not enough memory\n", stderr);
    } catch (const std::exception& error) {  // a bug: nothing of ours throws
        fmt::print(stderr, "lacedring: internal error: {}\n", error.what());
    }
    return lr::app::bad_input;
}
