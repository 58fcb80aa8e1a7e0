#include "renderer/draw/camera.h"

#define GLM_FORCE_DEPTH_ZERO_TO_ONE
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "renderer/vk/try.h"

namespace lacedring::gpu {
namespace {

constexpr double kMargin = 1.07;  // around a mesh that is fitted to the picture
constexpr double kSmallestNear = 1e-3;

glm::dvec3 vec(const std::array<double, 3>& a) {
    return {a[0], a[1], a[2]};
}

bool finite(const glm::dvec3& a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

mat4 store(const glm::dmat4& m) {
    mat4 out;
    const glm::mat4 f(m);
    std::copy_n(glm::value_ptr(f), 16, out.begin());
    return out;
}

/// The side from which a mesh with this up is usually looked at: +Z for Y up, -Y for Z up.
glm::dvec3 front_of(const glm::dvec3& up) {
    const glm::dvec3 candidate = std::abs(up.z) > 0.7 ? glm::dvec3(0, -1, 0) : glm::dvec3(0, 0, 1);
    return glm::normalize(candidate - up * glm::dot(candidate, up));
}

glm::dvec3 rotate(const glm::dvec3& v, double degrees, const glm::dvec3& axis) {
    return glm::dvec3(glm::rotate(glm::dmat4(1.0), glm::radians(degrees), axis) * glm::dvec4(v, 0.0));
}

struct Frame {
    glm::dvec3 right, up, back;
};

Frame frame_of(const glm::dvec3& back, const glm::dvec3& up) {
    glm::dvec3 right = glm::cross(up, back);
    // The eye looks along `up`: any direction that differs from `back` will do.
    if (glm::length(right) < 1e-9) right = glm::cross(front_of(up), back);
    right = glm::normalize(right);
    return {right, glm::cross(back, right), back};
}

/// Returns the distance at which all used vertices fit in the picture; if `center`, moves `focal` to center them.
double fit(const Model& model, const Frame& frame, double tan_x, double tan_y, bool center, glm::dvec3& focal) {
    double distance = 0;
    for (int pass = 0; pass < 3; ++pass) {
        distance = 0;
        double low_x = 1e300, high_x = -1e300, low_y = 1e300, high_y = -1e300;
        const auto each = [&](const auto& visit) {
            for (const std::uint32_t v : model.indices) {
                const float* p = &model.positions[3 * std::size_t{v}];
                const glm::dvec3 d = glm::dvec3(p[0], p[1], p[2]) - focal;
                visit(glm::dot(d, frame.right), glm::dot(d, frame.up), glm::dot(d, frame.back));
            }
        };
        each([&](double x, double y, double z) {
            distance = std::max({distance, z + kMargin * std::abs(x) / tan_x, z + kMargin * std::abs(y) / tan_y});
        });
        distance = std::max(distance, 1e-3);
        if (!center) return distance;
        each([&](double x, double y, double z) {
            const double depth = std::max(distance - z, 1e-6);
            low_x = std::min(low_x, x / depth);
            high_x = std::max(high_x, x / depth);
            low_y = std::min(low_y, y / depth);
            high_y = std::max(high_y, y / depth);
        });
        // The last pass only measures the distance, for the focal point as moved before.
        if (pass == 2) break;
        focal += 0.5 * distance * ((low_x + high_x) * frame.right + (low_y + high_y) * frame.up);
    }
    return distance;
}

}  // namespace

Result<Camera> make_camera(const Model& model, const CameraOptions& options, std::uint32_t width,
                           std::uint32_t height) {
    const auto invalid = [](const char* what) { return Error{ErrorCode::invalid_argument, what}; };
    glm::dvec3 up = vec(options.up);
    if (!finite(up) || glm::length(up) == 0) return invalid("the camera's up direction has no length");
    up = glm::normalize(up);
    if (!(options.zoom > 0) || !std::isfinite(options.zoom)) return invalid("the camera's zoom factor is not positive");
    if (!(options.view_angle > 0) || options.view_angle >= 179) return invalid("the view angle is not in (0, 179)");
    if (!std::isfinite(options.azimuth) || !std::isfinite(options.elevation))
        return invalid("an angle is not a number");

    const auto to_unit = [&](const std::array<double, 3>& p) { return (vec(p) - vec(model.center)) / model.radius; };
    glm::dvec3 focal = options.focal_point ? to_unit(*options.focal_point) : glm::dvec3(0.0);
    glm::dvec3 offset;  // from the focal point to the eye
    if (options.position) {
        offset = to_unit(*options.position) - focal;
    } else if (options.direction) {
        offset = vec(*options.direction);
    } else {
        const glm::dvec3 front = front_of(up);
        offset = 0.80 * front + 0.50 * glm::cross(up, front) + 0.40 * up;
    }
    if (!finite(offset) || !finite(focal)) return invalid("a camera coordinate is not a number");
    if (glm::length(offset) < 1e-9) return invalid("the camera's position is its focal point");
    offset = rotate(offset, options.azimuth, up);
    const glm::dvec3 right = frame_of(glm::normalize(offset), up).right;
    offset = rotate(offset, -options.elevation, right);

    const double aspect = static_cast<double>(width) / static_cast<double>(height);
    // The view angle belongs to the picture's shorter side, so that a tall picture shows as much as a wide one.
    const double tan_small = std::tan(glm::radians(options.view_angle) / 2);
    const double tan_y = aspect >= 1 ? tan_small : tan_small / aspect;
    const double tan_x = tan_y * aspect;
    const Frame frame = frame_of(glm::normalize(offset), up);
    double distance = glm::length(offset);
    if (!options.position) distance = fit(model, frame, tan_x, tan_y, !options.focal_point, focal);
    distance /= options.zoom;
    const glm::dvec3 eye = focal + distance * frame.back;

    const double to_center = glm::length(eye);
    const double far = to_center + 1.01;
    const double near = std::max(to_center - 1.01, kSmallestNear * std::max(1.0, far));
    Camera camera;
    camera.view_from_world = store(glm::lookAt(eye, focal, frame.up));
    camera.clip_from_view = store(glm::perspective(2 * std::atan(tan_y), aspect, near, far));
    camera.pixels_per_unit = static_cast<double>(height) / (2 * tan_y * distance);
    return camera;
}

}  // namespace lacedring::gpu
