#pragma once
// Options of every command that uses Vulkan.

#include <memory>
#include <string>

#include "renderer/vk/context.h"

namespace CLI {
class App;
}  // namespace CLI

namespace lacedring::app {

/// --device, --device-memory, --validation
void add_device_options(CLI::App& command, gpu::ContextOptions& options);

/// Was any of them given? Then a command that also works without a device must not go on without one.
bool asks_for_device(const gpu::ContextOptions& options);

/// A WIDTHxHEIGHT option.
struct PictureSize {
    std::uint32_t width = 1280;
    std::uint32_t height = 720;
};
void add_size(CLI::App& command, PictureSize& size);

/// Prints the validation messages on standard error, if there are any. Returns how many.
std::size_t print_validation(gpu::Context& context);

}  // namespace lacedring::app
