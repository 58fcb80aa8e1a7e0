#pragma once
// The selected corner: chosen by a click, moved by operators, kept in sight.

#include "app/view/scene/orbit.h"
#include "app/view/ui/state.h"

namespace lacedring::view {

/// A picture's size in pixels.
struct PictureArea {
    double width = 0, height = 0;
};

class Selecting {
  public:
    /// The corner nearest to pixel x, y of the scene's last picture; none where there is no surface. Errors: device
    /// failures. Cost: O(T) where the device's triangle is not the one under the pixel.
    Result<void> pick(State& state, Scene& scene, const Orbit& orbit, PictureArea area, double x, double y);
    /// From the selected corner by an operator; says so where there is no such corner.
    void step(Facts& facts, char operation);
    /// A corner that panels cover, or that is outside the picture, goes to the middle of what they leave. True: the
    /// camera moved.
    bool keep_in_sight(const Facts& facts, Orbit& orbit, PictureArea area);

  private:
    int frames_ = 0;  // in which a new selection is brought into sight: the panel takes some to get its size
};

/// The selection fills what panels leave of the picture. False: there is none.
bool frame_selection(const Facts& facts, Orbit& orbit, PictureArea area);

/// From the eye through the middle of the sample that a scene tells the triangle of.
Vector ray_through(const Scene& scene, const Orbit& orbit, PictureArea area, double x, double y);

}  // namespace lacedring::view
