#include "app/cli/gpu_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdio>

#include "app/cli/help.h"
#include "app/cli/print.h"
#include "app/cli/values.h"

namespace lacedring::app {
namespace {

bool parse_size(const std::string& text, PictureSize& size) {
    const char* end = text.data() + text.size();
    const auto [x, error] = std::from_chars(text.data(), end, size.width);
    if (error != std::errc() || x == end || *x != 'x') return false;
    const auto [rest, error2] = std::from_chars(x + 1, end, size.height);
    if (error2 != std::errc() || rest != end) return false;
    return size.width >= 1 && size.height >= 1 && size.width <= 8192 && size.height <= 8192;
}

}  // namespace

void add_device_options(CLI::App& command, gpu::ContextOptions& options) {
    const OptionGroup group(command, "Vulkan device");
    command.add_option("--device", options.device, "use the device whose name, or whose driver's name, contains NAME")
        ->type_name("NAME");
    allow_whole_numbers(
        command.add_option_function<std::uint64_t>(
            "--device-memory", [&options](const std::uint64_t& mebibytes) { options.memory = mebibytes << 20; },
            "use at most this much device memory"),
        1, kMostMebibytes)
        ->type_name("MIB");
    command.add_flag("--validation", options.validation, "run with Vulkan's validation layers");
}

bool asks_for_device(const gpu::ContextOptions& options) {
    return !options.device.empty() || options.memory != 0 || options.validation;
}

void add_size(CLI::App& command, PictureSize& size) {
    command
        .add_option_function<std::string>(
            "--size",
            [&size](const std::string& text) {
                if (parse_size(text, size)) return;
                throw CLI::ValidationError("--size", refusal(text, "WIDTHxHEIGHT with both from 1 to 8192"));
            },
            "width and height in pixels")
        ->type_name("WxH")
        ->default_str(fmt::format("{}x{}", size.width, size.height));
}

std::size_t print_validation(gpu::Context& context) {
    const std::vector<std::string> messages = context.validation().messages();
    for (const std::string& message : messages) say("lacedring: validation: {}\n", message);
    return messages.size();
}

}  // namespace lacedring::app
