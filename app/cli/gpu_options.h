#pragma once
// Options of every command that uses Vulkan.

#include <memory>
#include <string>

#include "renderer/vk/context.h"

namespace CLI {
class App;
}  // namespace CLI

namespace lacedring::app {

/// Adds --device, --device-memory and --validation.
void add_device_options(CLI::App& command, gpu::ContextOptions& options);

/// Returns whether an option of the device was given. Then a missing device is an error, also for commands that could
/// do without one.
bool asks_for_device(const gpu::ContextOptions& options);

/// A WIDTHxHEIGHT option.
struct PictureSize {
    std::uint32_t width = 1280;
    std::uint32_t height = 720;
};
void add_size(CLI::App& command, PictureSize& size);

/// Prints the validation messages on standard error; returns their number.
std::size_t print_validation(gpu::Context& context);

}  // namespace lacedring::app
