#pragma once
// Selects a corner: picks it by a click, moves it by operators, and keeps it in sight.

#include "app/view/scene/orbit.h"
#include "app/view/ui/state.h"

namespace lacedring::view {

/// A picture's size in pixels.
struct PictureArea {
    double width = 0, height = 0;
};

class Selecting {
  public:
    /// Selects the corner nearest to pixel x, y of the scene's last picture; none if there is no surface. Errors:
    /// device failures. Cost: O(T) if the ray through the pixel misses the triangle that the device gives.
    Result<void> pick(State& state, Scene& scene, const Orbit& orbit, PictureArea area, double x, double y);
    /// Moves the selection by an operator; shows a note if there is no such corner.
    void step(Facts& facts, char operation);
    /// If panels cover a new selection, or it is outside the picture, moves it to the middle of the free area. Returns
    /// whether the camera moved.
    bool keep_in_sight(const Facts& facts, Orbit& orbit, PictureArea area);

  private:
    // Frames left in which a new selection is brought into sight: its panel takes some to reach its size.
    int frames_ = 0;
};

/// Moves the camera so that the selection fills the area free of panels. Returns false if nothing is selected.
bool frame_selection(const Facts& facts, Orbit& orbit, PictureArea area);

/// Direction from the eye through the sample of pixel x, y that Scene::triangle_at reads.
Vector ray_through(const Scene& scene, const Orbit& orbit, PictureArea area, double x, double y);

}  // namespace lacedring::view
