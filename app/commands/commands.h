#pragma once
// All commands. add_commands adds them in the order of --help.

#include "app/cli/command.h"

namespace lacedring::app {

void add_info(CLI::App& program, Action& action);
void add_stats(CLI::App& program, Action& action);
void add_encode(CLI::App& program, Action& action);
void add_decode(CLI::App& program, Action& action);
void add_pack(CLI::App& program, Action& action);
void add_unpack(CLI::App& program, Action& action);
void add_verify(CLI::App& program, Action& action);
void add_generate(CLI::App& program, Action& action);
void add_bench(CLI::App& program, Action& action);
void add_report(CLI::App& program, Action& action);
void add_render(CLI::App& program, Action& action);   // render.cpp; with LACEDRING_GPU
void add_compare(CLI::App& program, Action& action);  // compare.cpp; with LACEDRING_GPU
void add_view(CLI::App& program, Action& action);     // view.cpp; with LACEDRING_VIEWER

inline void add_commands(CLI::App& program, Action& action) {
    add_info(program, action);
    add_stats(program, action);
    add_report(program, action);
    add_encode(program, action);
    add_decode(program, action);
    add_pack(program, action);
    add_unpack(program, action);
    add_verify(program, action);
#ifdef LACEDRING_GPU
    add_render(program, action);
    add_compare(program, action);
#endif
#ifdef LACEDRING_VIEWER
    add_view(program, action);
#endif
    add_bench(program, action);
    add_generate(program, action);
}

}  // namespace lacedring::app
