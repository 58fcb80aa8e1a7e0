#pragma once
// Marks on top of the picture.

#include <cstdint>

#include "app/view/scene/orbit.h"
#include "app/view/ui/state.h"

namespace lacedring::view {

/// Draws the divider, and letters at the selected corner and its neighbors. Call between ImGui::NewFrame and Render.
void draw_marks(const State& state, const Orbit& orbit, std::uint32_t width, std::uint32_t height);

}  // namespace lacedring::view
