#include <cmath>

#include "renderer/draw/camera.h"
#include "tests/gpu/gpu_test.h"

using namespace lacedring;
using namespace lacedring::test;

namespace {

gpu::Camera camera_of(const gpu::Model& model, const gpu::CameraOptions& options) {
    const auto camera = gpu::make_camera(model, options, 400, 300);
    REQUIRE_MESSAGE(camera, camera.error().message);
    return *camera;
}

/// A point of the mesh in normalized device coordinates.
std::array<double, 3> project(const gpu::Model& model, const gpu::Camera& camera, std::array<double, 3> p) {
    std::array<double, 4> v{0, 0, 0, 1}, view{}, clip{};
    for (std::size_t i = 0; i < 3; ++i) v[i] = (p[i] - model.center[i]) / model.radius;
    for (std::size_t r = 0; r < 4; ++r) {
        for (std::size_t c = 0; c < 4; ++c) view[r] += static_cast<double>(camera.view_from_world[4 * c + r]) * v[c];
    }
    for (std::size_t r = 0; r < 4; ++r) {
        for (std::size_t c = 0; c < 4; ++c) clip[r] += static_cast<double>(camera.clip_from_view[4 * c + r]) * view[c];
    }
    return {clip[0] / clip[3], clip[1] / clip[3], clip[2] / clip[3]};
}

}  // namespace

TEST_CASE("the default camera shows the whole mesh, which fills the picture") {
    for (const char* kind : {"sphere", "terrain", "genus"}) {
        CAPTURE(kind);
        const Mesh mesh = generated(kind, 1000);
        const gpu::Model model = model_of(mesh);
        const gpu::Camera camera = camera_of(model, {});
        double widest = 0;
        const std::vector<float> p = positions_f32(mesh);
        for (const std::uint32_t v : mesh.indices) {
            const auto q = project(model, camera, {p[3 * v], p[3 * v + 1], p[3 * v + 2]});
            widest = std::max({widest, std::abs(q[0]), std::abs(q[1])});
            CHECK(q[2] >= 0);
            CHECK(q[2] <= 1);
        }
        CHECK(widest < 1);
        CHECK(widest > 0.85);
    }
}

TEST_CASE("azimuth moves the eye to the right, elevation up, zoom nearer") {
    const Mesh mesh = generated("sphere", 1000);
    const gpu::Model model = model_of(mesh);
    gpu::CameraOptions options;
    options.focal_point = {0, 0, 0};
    options.position = {0, 0, 10};
    const auto eye_of = [&](const gpu::CameraOptions& o) {
        const gpu::Camera c = camera_of(model, o);
        std::array<double, 3> eye{};
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t r = 0; r < 3; ++r) {
                eye[i] -=
                    static_cast<double>(c.view_from_world[4 * i + r]) * static_cast<double>(c.view_from_world[12 + r]);
            }
            eye[i] = eye[i] * model.radius + model.center[i];
        }
        return eye;
    };
    const auto close_to = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
        return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]) < 1e-3;
    };
    CHECK(close_to(eye_of(options), {0, 0, 10}));
    options.azimuth = 90;
    CHECK(close_to(eye_of(options), {10, 0, 0}));
    options.azimuth = 0;
    options.elevation = 30;
    CHECK(close_to(eye_of(options), {0, 5, 10 * std::sqrt(0.75)}));
    options.elevation = 0;
    options.zoom = 2;
    CHECK(close_to(eye_of(options), {0, 0, 5}));
    options.zoom = 1;
    options.up = {0, 0, 1};  // along the line of sight, which is valid
    CHECK(close_to(eye_of(options), {0, 0, 10}));
}

TEST_CASE("cameras that see nothing are refused") {
    const Mesh mesh = generated("sphere", 100);
    const gpu::Model model = model_of(mesh);
    const auto refused = [&](const gpu::CameraOptions& options) {
        const auto camera = gpu::make_camera(model, options, 4, 3);
        return !camera && camera.error().code == ErrorCode::invalid_argument;
    };
    gpu::CameraOptions options;
    options.up = {0, 0, 0};
    CHECK(refused(options));
    options = {};
    options.zoom = 0;
    CHECK(refused(options));
    options = {};
    options.position = options.focal_point = std::array<double, 3>{1, 2, 3};
    CHECK(refused(options));
    options = {};
    options.azimuth = NAN;
    CHECK(refused(options));
    options = {};
    options.position = std::array<double, 3>{INFINITY, 0, 0};
    CHECK(refused(options));
    options = {};
    options.view_angle = 180;
    CHECK(refused(options));
}
