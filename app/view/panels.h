#pragma once
// The panels: they show the state, change what was chosen in it, and ask for things.

#include <array>

#include "app/view/orbit.h"
#include "app/view/state.h"

namespace lr::view {

/// Between ImGui::NewFrame and Render.
void draw_panels(State& state, const Orbit& orbit);

/// How large a picture in the middle of the window no panel covers.
std::array<double, 2> free_area(const State& state, double width, double height);

/// Parts, each with a file of its own.
void draw_choices(State& state);  ///< files, view, stream, ring
void draw_numbers(State& state);  ///< sizes, times
void draw_help();
void draw_selection(const State& state);
void draw_shader_error(State& state);

/// "1,234,567"
std::string grouped(std::uint64_t number);
/// "12.3 MiB"
std::string bytes_text(std::uint64_t bytes);
/// A heading above a part of a panel.
void heading(const char* text);

}  // namespace lr::view
