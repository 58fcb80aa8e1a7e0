// The program lacedring: parses the command line, runs one command, reports a failure as one line and an exit code.

#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <sstream>

#include "app/cli/arguments.h"
#include "app/cli/command.h"
#include "app/cli/help.h"
#include "app/cli/progress.h"
#include "app/commands/commands.h"

namespace {

/// Opens /dev/null in place of each standard stream that the caller closed, so that no other file gets its number.
/// Read-only: reading finds nothing, and writing fails as on a closed stream.
void open_standard_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        // open() returns the lowest free number, which is `stream`.
        if (::fcntl(stream, F_GETFD) == -1) (void)::open("/dev/null", O_RDONLY);
    }
}

/// Flushes standard output. Returns `code`, or bad_input if `code` is done but the output could not be written.
int finish(int code) {
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
    lacedring::app::say("lacedring: standard output: cannot be written\n");
    return code == lacedring::app::done ? lacedring::app::bad_input : code;
}

int run(int argc, char** argv) {
    CLI::App program("make triangle meshes small, and use them while they are small");
    program.name("lacedring");
    lacedring::app::format_help(program);
    program.set_version_flag("-V,--version", LACEDRING_VERSION, "show the version");
    program.require_subcommand(1);
    program.footer(
        "lacedring COMMAND --help lists the options of a command.\n"
        "Example: lacedring encode bunny.ply -o bunny.lr\nMore in docs/command-line.md");
    lacedring::app::Action action;
    lacedring::app::add_commands(program, action);
    bool quiet = false;
    for (CLI::App* command : program.get_subcommands({})) {
        if (command->get_name() == "view") continue;  // which prints errors alone
        command->add_flag("-q,--quiet", quiet, "print no notes and no progress, only errors");
    }
    std::vector<std::string> words = lacedring::app::arguments(argc, argv);
    if (const std::string wrong = lacedring::app::check_command(program, words); !wrong.empty()) {
        lacedring::app::say("lacedring: {} (lacedring --help lists the commands)\n", wrong);
        return lacedring::app::wrong_usage;
    }
    try {
        std::reverse(words.begin(), words.end());  // CLI11 takes the last word first
        program.parse(std::move(words));
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() != 0) {
            lacedring::app::say("lacedring: {} (lacedring --help lists the commands)\n",
                                lacedring::app::what_is_wrong(program, error));
            return lacedring::app::wrong_usage;
        }
        std::ostringstream out;  // the help or the version
        program.exit(error, out, out);
        lacedring::app::print("{}", out.str());
        return finish(lacedring::app::done);
    }
    if (quiet) lacedring::app::hide_progress();
    lacedring::app::RunLog log(quiet);
    const int code = action(log);
    if (code == lacedring::app::done || code == lacedring::app::check_failed) log.flush();
    return finish(code);
}

}  // namespace

int main(int argc, char** argv) {
    // Without these signals, writing fails with an error that is reported.
    std::signal(SIGXFSZ, SIG_IGN);  // file-size limit exceeded
    std::signal(SIGPIPE, SIG_IGN);  // the reader closed the pipe
    open_standard_streams();
    try {
        return run(argc, argv);
    } catch (const std::bad_alloc&) {
        std::fputs("lacedring: not enough memory\n", stderr);
    } catch (const std::exception& error) {  // a bug: our own code never throws
        std::fprintf(stderr, "lacedring: internal error: %s\n", error.what());
    }
    return lacedring::app::bad_input;
}
