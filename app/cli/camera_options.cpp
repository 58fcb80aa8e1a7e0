#include "app/cli/camera_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include "app/cli/help.h"
#include "app/cli/values.h"

namespace lacedring::app {
namespace {

using Vector = std::array<double, 3>;

bool parse_number(std::string_view text, double& out) {
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), out);
    return error == std::errc() && rest == text.data() + text.size();
}

/// "1,0.5,-2"
bool parse_vector(std::string_view text, Vector& out) {
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t comma = i < 2 ? text.find(',') : text.size();
        if (comma == std::string_view::npos || !parse_number(text.substr(0, comma), out[i])) return false;
        text.remove_prefix(i < 2 ? comma + 1 : comma);
    }
    return true;
}

/// "+Z", "-x", "Y", or a vector
bool parse_up(std::string_view text, Vector& out) {
    std::string_view axis = text;
    const double sign = !axis.empty() && axis.front() == '-' ? -1 : 1;
    if (!axis.empty() && (axis.front() == '-' || axis.front() == '+')) axis.remove_prefix(1);
    const std::size_t i = axis.size() == 1 ? std::string_view("XYZxyz").find(axis.front()) : std::string_view::npos;
    if (i == std::string_view::npos) return parse_vector(text, out);
    out = {0, 0, 0};
    out[i % 3] = sign;
    return true;
}

template <class Parse, class Set>
void add_vector(CLI::App& command, const char* name, const char* allowed, const char* what, Parse parse, Set set) {
    command
        .add_option_function<std::string>(
            name,
            [=](const std::string& text) {
                Vector value{};
                if (!parse(text, value)) throw CLI::ValidationError(name, refusal(text, allowed));
                set(value);
            },
            what)
        ->type_name("X,Y,Z");
}

}  // namespace

void add_camera(CLI::App& command, gpu::CameraOptions& camera) {
    const OptionGroup group(command, "Camera");
    add_vector(command, "--up", "X, Y or Z with + or - before it, or three numbers X,Y,Z",
               "direction that is up: +X, -X, +Y, -Y, +Z, -Z or X,Y,Z (default +Y)", parse_up,
               [&camera](const Vector& v) { camera.up = v; });
    add_vector(command, "--camera-position", "three numbers X,Y,Z",
               "where the camera is; default: three quarters, all in view", parse_vector,
               [&camera](const Vector& v) { camera.position = v; });
    add_vector(command, "--camera-focal-point", "three numbers X,Y,Z",
               "where the camera looks; default: the middle of the mesh", parse_vector,
               [&camera](const Vector& v) { camera.focal_point = v; });
    const auto add = [&](const char* name, double& value, const char* help) {
        return command.add_option(name, value, help)->capture_default_str();
    };
    allow_numbers(
        add("--camera-azimuth-angle", camera.azimuth, "move the camera to its right, ANGLE degrees around that point"),
        -kNoLimit, kNoLimit)
        ->type_name("ANGLE");
    allow_numbers(add("--camera-elevation-angle", camera.elevation, "then move it up, ANGLE degrees around that point"),
                  -kNoLimit, kNoLimit)
        ->type_name("ANGLE");
    allow_numbers_between(add("--camera-zoom-factor", camera.zoom, "then divide its distance by F"), 0, kNoLimit);
    allow_numbers_between(
        add("--camera-view-angle", camera.view_angle, "degrees seen along the picture's shorter side"), 0, 179)
        ->type_name("ANGLE");
}

Result<gpu::CameraOptions> parse_camera(std::vector<std::string> words) {
    CLI::App command;
    gpu::CameraOptions camera;
    add_camera(command, camera);
    std::reverse(words.begin(), words.end());  // CLI11 takes the last word first
    try {
        command.parse(words);
    } catch (const CLI::ParseError& error) {
        return Error{ErrorCode::invalid_argument, error.what()};
    }
    return camera;
}

}  // namespace lacedring::app
