#pragma once
// A camera that turns around what it looks at.

#include <array>
#include <string>

#include "app/view/session/vector.h"
#include "renderer/draw/camera.h"

namespace lacedring::view {

class Orbit {
  public:
    /// Three-quarter view, or as `options` say; the mesh fits the middle `width` x `height` pixels of the picture.
    /// `extent`: of the picture.
    Result<void> frame(const gpu::Model& model, const gpu::CameraOptions& options, std::array<double, 2> extent,
                       std::array<double, 2> fit);
    /// Looks at a ball of the mesh, from where it looks already.
    void look_at(const Vector& centre, double radius);
    /// From that side. "front", "right", "top", ... as f3d has them.
    void look_from(const Vector& direction);

    /// Pixels; a picture's height is half a turn.
    void turn(double dx, double dy, double height);
    /// The point under the cursor stays there. Pixels from the picture's middle, y up.
    void zoom(double factor, double x, double y, double height, double width);
    void pan(double dx, double dy, double height, double width);
    void turn_degrees(double degrees);

    /// For make_camera and for `lacedring render`.
    gpu::CameraOptions options() const;
    std::string text() const;

    const Vector& eye() const { return eye_; }
    const Vector& focal() const { return focal_; }
    /// Direction of the ray through a pixel (from the middle, y up). Mesh coordinates, as all here.
    Vector ray(double x, double y, double height, double width) const;
    /// Where a point is seen, from the picture's upper left corner; none behind the eye.
    std::optional<std::array<double, 2>> project(const Vector& point, double height, double width) const;

  private:
    struct Axes {
        Vector right, up, back;
    };
    Axes axes() const;
    double per_pixel(double height, double width) const;  // at the focal point

    Vector eye_{0, 0, 3}, focal_{}, up_{0, 1, 0};
    double view_angle_ = 30;
    double size_ = 1;  // of the mesh: its ball's radius
};

}  // namespace lacedring::view
