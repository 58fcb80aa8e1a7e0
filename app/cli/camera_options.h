#pragma once
// Options of the camera, with the names that f3d uses.

#include <string>
#include <vector>

#include "lacedring/base.hpp"
#include "renderer/draw/camera.h"

namespace CLI {
class App;
}  // namespace CLI

namespace lacedring::app {

void add_camera(CLI::App& command, gpu::CameraOptions& camera);

/// Parses the same options from words: `--name value` or `--name=value`. Errors: invalid_argument.
Result<gpu::CameraOptions> parse_camera(std::vector<std::string> words);

}  // namespace lacedring::app
