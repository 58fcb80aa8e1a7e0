#pragma once
// The panels: they show the state, change what was chosen in it, and ask for things.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "app/view/ui/state.h"

namespace lacedring::view {

/// Between ImGui::NewFrame and Render.
/// `ring_line`: the ring is drawn over the surface. Sets state.facts.free.
void draw_panels(State& state, bool ring_line);

/// How large a picture in the middle of the window no panel covers, nor an ordinary legend.
std::array<double, 2> free_area(double width, double height);

/// Where a panel was drawn last, and how much of what it holds does not fit.
struct PanelBox {
    std::string name;
    double x, y, width, height;
    double hidden_right, hidden_below;  ///< pixels; below: reached by scrolling
};
std::vector<PanelBox> panel_boxes();

/// Parts, each with a file of its own.
void draw_choices(State& state);  ///< files, view, stream, ring
void draw_numbers(State& state);  ///< sizes, times
/// In the middle of what is left of the window.
void draw_help(float left, float right, float bottom);
void draw_selection(const State& state);
/// What the picture's colours mean, along the top of the picture; nothing where there is nothing to tell or it would be
/// higher than `room`. Gives where it ends.
float draw_legend(const State& state, bool ring_line, float left, float right, float room);

/// "1,234,567"
std::string grouped(std::uint64_t number);
/// "12.3 MiB"
std::string bytes_text(std::uint64_t bytes);
/// Cut in its middle, so that it is no wider than `room`: "a-very...name.ply".
std::string elided(std::string_view text, float room);
/// With line breaks after slashes and spaces, so that it is no wider than `room`.
std::string broken(std::string_view text, float room);
/// A heading above a part of a panel.
void heading(const char* text, const char* explained = nullptr);
/// Explains the last item when the mouse is over it.
void explain(const char* text);

}  // namespace lacedring::view
