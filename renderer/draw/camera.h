#pragma once
// The camera of a picture. The options have the names and meanings of f3d's options.

#include <array>
#include <optional>

#include "lacedring/base.hpp"
#include "renderer/mesh/model.h"
#include "shaders/shared.h"

namespace lacedring::gpu {

/// Positions are in the mesh's coordinates, angles in degrees.
struct CameraOptions {
    std::array<double, 3> up{0, 1, 0};
    std::optional<std::array<double, 3>> position;     ///< default: three-quarter view, the mesh fills the picture
    std::optional<std::array<double, 3>> focal_point;  ///< default: the center of the visible mesh
    std::optional<std::array<double, 3>> direction;    ///< from the focal point to the eye; ignored with `position`
    double azimuth = 0;    ///< rotates the eye about `up` around the focal point, to the eye's right
    double elevation = 0;  ///< then raises the eye
    double zoom = 1;       ///< then divides the eye's distance from the focal point
    double view_angle = 30;
};

struct Camera {
    mat4 view_from_world{};  ///< world space has the model's unit sphere at the origin
    mat4 clip_from_view{};
    double pixels_per_unit = 0;  ///< pixels per unit of world space, at the focal point
};

/// Cost: O(T) if the mesh is fitted to the picture (no `position`), else O(1).
/// Errors: invalid_argument (the eye is at the focal point, `up` has no length, zoom or view angle is out of range).
Result<Camera> make_camera(const Model& model, const CameraOptions& options, std::uint32_t width, std::uint32_t height);

}  // namespace lacedring::gpu
