#pragma once
// A camera that turns around its focal point. Points and directions are in the mesh's coordinates.

#include <array>
#include <string>

#include "app/view/session/vector.h"
#include "renderer/draw/camera.h"

namespace lacedring::view {

class Orbit {
  public:
    /// Looks at the whole mesh: from three quarters, or as `options` say. The mesh fits the middle fit[0] x fit[1]
    /// pixels of a picture of extent[0] x extent[1] pixels.
    Result<void> frame(const gpu::Model& model, const gpu::CameraOptions& options, std::array<double, 2> extent,
                       std::array<double, 2> fit);
    /// Looks at a ball of the mesh, keeping the direction.
    void look_at(const Vector& center, double radius);
    /// Moves the eye to the side `direction` of the focal point, keeping the distance.
    void look_from(const Vector& direction);

    /// Turns by a mouse movement in pixels; the picture's height is half a turn.
    void turn(double dx, double dy, double height);
    /// Zooms; the point under the cursor stays there. x, y: pixels from the picture's middle, y up.
    void zoom(double factor, double x, double y, double height, double width);
    void pan(double dx, double dy, double height, double width);
    void turn_degrees(double degrees);

    /// The camera for make_camera, and as options of `lacedring render`.
    gpu::CameraOptions options() const;
    std::string text() const;

    const Vector& eye() const { return eye_; }
    const Vector& focal() const { return focal_; }
    /// Direction of the ray through a pixel. x, y: from the picture's middle, y up.
    Vector ray(double x, double y, double height, double width) const;
    /// Pixel of a point, from the picture's upper left corner; empty for points behind the eye.
    std::optional<std::array<double, 2>> project(const Vector& point, double height, double width) const;

  private:
    struct Axes {
        Vector right, up, back;
    };
    Axes axes() const;
    double per_pixel(double height, double width) const;  // mesh units per pixel, at the focal point

    Vector eye_{0, 0, 3}, focal_{}, up_{0, 1, 0};
    double view_angle_ = 30;
    double size_ = 1;  // radius of the mesh
};

}  // namespace lacedring::view
