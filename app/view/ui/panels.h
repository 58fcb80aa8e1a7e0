#pragma once
// The panels. They show the state and ask for actions.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "app/view/ui/state.h"

namespace lacedring::view {

/// Draws all panels, and sets state.facts.free. Call between ImGui::NewFrame and Render. `ring_line`: the ring is drawn
/// over the surface.
void draw_panels(State& state, bool ring_line);

/// Size of the largest picture in the middle of a window that neither the panels nor a legend of two lines cover.
std::array<double, 2> free_area(double width, double height);

/// Where a panel was drawn last, and how many pixels of its contents do not fit.
struct PanelBox {
    std::string name;
    double x, y, width, height;
    double hidden_right, hidden_below;  ///< below: reached by scrolling
};
std::vector<PanelBox> panel_boxes();

// The panels, each in a file of its own.
void draw_choices(State& state);  ///< files, view, stream, ring
void draw_numbers(State& state);  ///< sizes, times
/// Draws the help in the middle of this part of the window.
void draw_help(float left, float right, float bottom);
void draw_selection(const State& state);
/// Draws the legend of the picture's colors along the top of the picture, unless it is empty or higher than `room`.
/// Returns its lower end; 0: not drawn.
float draw_legend(const State& state, bool ring_line, float left, float right, float room);

/// "1,234,567"
std::string grouped(std::uint64_t number);
/// "12.3 MiB"
std::string bytes_text(std::uint64_t bytes);
/// Cuts text in its middle so that it is at most `room` wide: "a-very...name.ply".
std::string elided(std::string_view text, float room);
/// Breaks text after slashes and spaces so that it is at most `room` wide.
std::string broken(std::string_view text, float room);
/// Draws a heading above a part of a panel.
void heading(const char* text, const char* explained = nullptr);
/// Shows `text` as a tooltip while the mouse is over the item drawn last.
void explain(const char* text);

}  // namespace lacedring::view
