#pragma once
// The camera on the command line, as f3d has it.

#include <string>
#include <vector>

#include "lacedring/base.hpp"
#include "renderer/draw/camera.h"

namespace CLI {
class App;
}  // namespace CLI

namespace lacedring::app {

void add_camera(CLI::App& command, gpu::CameraOptions& camera);

/// The same options as words, each with its value behind it or after a "=". Errors: invalid_argument.
Result<gpu::CameraOptions> parse_camera(std::vector<std::string> words);

}  // namespace lacedring::app
