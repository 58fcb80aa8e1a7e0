#include "app/view/scene/orbit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lacedring::view {
namespace {

/// Rodrigues' formula.
Vector rotated(const Vector& v, const Vector& axis, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
}

constexpr double radians(double degrees) {
    return degrees * std::numbers::pi / 180;
}

}  // namespace

Result<void> Orbit::frame(const gpu::Model& model, const gpu::CameraOptions& options, std::array<double, 2> extent,
                          std::array<double, 2> fit) {
    const auto width = static_cast<std::uint32_t>(std::max(1.0, fit[0]));
    const auto height = static_cast<std::uint32_t>(std::max(1.0, fit[1]));
    const Result<gpu::Camera> camera = gpu::make_camera(model, options, width, height);
    if (!camera) return camera.error();
    up_ = unit(options.up);
    view_angle_ = options.view_angle;
    size_ = model.radius;
    const auto& m = camera->view_from_world;
    // The rows of the matrix are the axes; it moves the eye to the origin.
    const Vector right{m[0], m[4], m[8]}, up{m[1], m[5], m[9]}, back{m[2], m[6], m[10]};
    const Vector eye = (right * m[12] + up * m[13] + back * m[14]) * -1.0;
    const auto to_mesh = [&](const Vector& p) {
        return p * model.radius + Vector{model.center[0], model.center[1], model.center[2]};
    };
    const double tan_small = std::tan(radians(view_angle_) / 2);
    const auto distance_for = [&](double pixels_per_unit, double w, double h) {
        return h / (2 * (w >= h ? tan_small : tan_small * h / w) * pixels_per_unit);
    };
    const double asked = distance_for(camera->pixels_per_unit, width, height);
    const Vector focal = eye - back * asked;
    const bool placed = options.position.has_value();
    const double distance = placed ? asked : distance_for(camera->pixels_per_unit, extent[0], extent[1]);
    focal_ = options.focal_point ? *options.focal_point : to_mesh(focal);
    eye_ = to_mesh(focal + back * distance);
    if (placed && options.azimuth == 0 && options.elevation == 0 && options.zoom == 1) eye_ = *options.position;
    return {};
}

void Orbit::look_at(const Vector& center, double radius) {
    const double distance = std::max(radius, 1e-6 * size_) * 1.3 / std::tan(radians(view_angle_) / 2);
    const Vector back = axes().back;
    focal_ = center;
    eye_ = center + back * distance;
}

void Orbit::look_from(const Vector& direction) {
    eye_ = focal_ + unit(direction) * length(eye_ - focal_);
}

Orbit::Axes Orbit::axes() const {
    const Vector back = unit(eye_ - focal_);
    Vector right = cross(up_, back);
    if (length(right) < 1e-9) right = cross(std::abs(up_[2]) > 0.7 ? Vector{0, -1, 0} : Vector{0, 0, 1}, back);
    right = unit(right);
    return {right, cross(back, right), back};
}

double Orbit::per_pixel(double height, double width) const {
    return 2 * std::tan(radians(view_angle_) / 2) * length(eye_ - focal_) / std::max(1.0, std::min(height, width));
}

void Orbit::turn(double dx, double dy, double height) {
    const double step = std::numbers::pi / std::max(1.0, height);
    const Axes a = axes();
    Vector offset = rotated(eye_ - focal_, up_, -dx * step);
    const Vector right = rotated(a.right, up_, -dx * step);
    // Stop before the pole, where up would flip.
    const double elevation = std::asin(std::clamp(dot(unit(offset), up_), -1.0, 1.0));
    const double limit = radians(89.5);
    const double change = std::clamp(elevation + dy * step, -limit, limit) - elevation;
    offset = rotated(offset, right, -change);
    eye_ = focal_ + offset;
}

void Orbit::turn_degrees(double degrees) {
    eye_ = focal_ + rotated(eye_ - focal_, up_, radians(degrees));
}

void Orbit::zoom(double factor, double x, double y, double height, double width) {
    const double distance = length(eye_ - focal_);
    factor = std::clamp(factor, distance / (60 * size_), distance / (1e-5 * size_));
    const Axes a = axes();
    const double unit_size = per_pixel(height, width);
    const Vector under = focal_ + a.right * (x * unit_size) + a.up * (y * unit_size);
    focal_ = under + (focal_ - under) * (1 / factor);
    eye_ = focal_ + a.back * (distance / factor);
}

void Orbit::pan(double dx, double dy, double height, double width) {
    const Axes a = axes();
    const double unit_size = per_pixel(height, width);
    const Vector shift = a.right * (-dx * unit_size) + a.up * (dy * unit_size);
    focal_ = focal_ + shift;
    eye_ = eye_ + shift;
}

gpu::CameraOptions Orbit::options() const {
    gpu::CameraOptions options;
    options.up = up_;
    options.position = eye_;
    options.focal_point = focal_;
    options.view_angle = view_angle_;
    return options;
}

std::string Orbit::text() const {
    // All digits of a double: `render` then draws exactly this picture.
    const auto vector = [](const Vector& v) { return fmt::format("{:.17g},{:.17g},{:.17g}", v[0], v[1], v[2]); };
    std::string out =
        fmt::format("--camera-position={} --camera-focal-point={} --up={}", vector(eye_), vector(focal_), vector(up_));
    if (view_angle_ != 30) out += fmt::format(" --camera-view-angle={:.17g}", view_angle_);
    return out;
}

Vector Orbit::ray(double x, double y, double height, double width) const {
    const Axes a = axes();
    const double unit_size = per_pixel(height, width);
    return unit(a.right * (x * unit_size) + a.up * (y * unit_size) + focal_ - eye_);
}

std::optional<std::array<double, 2>> Orbit::project(const Vector& point, double height, double width) const {
    const Axes a = axes();
    const Vector d = point - eye_;
    const double depth = -dot(d, a.back);
    if (depth <= 1e-9 * size_) return std::nullopt;
    const double scale = length(eye_ - focal_) / (depth * per_pixel(height, width));
    return std::array<double, 2>{width / 2 + dot(d, a.right) * scale, height / 2 - dot(d, a.up) * scale};
}

}  // namespace lacedring::view
