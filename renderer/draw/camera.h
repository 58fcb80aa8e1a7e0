#pragma once
// Where a picture is taken from. Names and meaning of the options follow f3d's.

#include <array>
#include <optional>

#include "lacedring/base.hpp"
#include "renderer/mesh/model.h"
#include "shaders/shared.h"

namespace lacedring::gpu {

/// Positions are in the mesh's coordinates, angles in degrees.
struct CameraOptions {
    std::array<double, 3> up{0, 1, 0};
    std::optional<std::array<double, 3>> position;     ///< else three-quarter view, the mesh just fitting the picture
    std::optional<std::array<double, 3>> focal_point;  ///< else the middle of what is seen
    std::optional<std::array<double, 3>> direction;    ///< from the focal point to the eye, where position is not given
    double azimuth = 0;    ///< turns the eye around the focal point about `up`, to its right
    double elevation = 0;  ///< then raises it
    double zoom = 1;       ///< then divides its distance
    double view_angle = 30;
};

struct Camera {
    mat4 view_from_world{};  ///< world: the model's unit sphere
    mat4 clip_from_view{};
    double pixels_per_unit = 0;  ///< of the unit sphere, at the focal point
};

/// Cost: O(V + T) where the mesh is fitted to the picture.
/// Errors: invalid_argument (the eye at the focal point, up of no length, zoom or view angle out of range).
Result<Camera> make_camera(const Model& model, const CameraOptions& options, std::uint32_t width, std::uint32_t height);

}  // namespace lacedring::gpu
