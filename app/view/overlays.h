#pragma once
// What is laid over the drawn triangles: colours by triangle, and marks on top.

#include <cstdint>
#include <span>

#include "app/view/orbit.h"
#include "app/view/state.h"

namespace lr::view {

/// RGBA a triangle of the mesh, as State::paint says; those with no colour are left as they are. Keeps in the state
/// what the next picture needs again.
void lay_paint(State& state, std::span<std::uint32_t> colours);

/// The divider, and letters at the selected corner and its neighbours. Between ImGui::NewFrame and Render.
void draw_marks(const State& state, const Orbit& orbit, std::uint32_t width, std::uint32_t height);

/// The corridor of each triangle (a maximal run of T1 triangles on one side of the ring), UINT32_MAX for other
/// triangles.
std::vector<std::uint32_t> corridors(const Document& document);

}  // namespace lr::view
