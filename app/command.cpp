#include "app/command.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <system_error>

#include "lrcore/file/lr_file.h"
#include "lrcore/mesh/read.h"
#include "lrcore/mesh/weld.h"

namespace lr::app {

void add_weld(CLI::App& command, std::string& weld) {
    command
        .add_flag("--weld{attributes}", weld,
                  "merge vertices whose attributes are all identical; --weld=position: whose positions are")
        ->check(CLI::IsMember({"attributes", "position"}));
}

void add_ring_options(CLI::App& command, RingChoice& choice) {
    command.add_option("--ring", choice.ring, "ring construction")
        ->check(CLI::IsMember({"expander"}))
        ->capture_default_str();
    command.add_option("--seeds", choice.seeds, "seed corners tried per component; 0: by the mesh's size")
        ->check(CLI::Range(0, 100000))
        ->capture_default_str();
    command.add_option("--random-seed", choice.random_seed, "for the choice of seed corners")->capture_default_str();
}

RingOptions ring_options(const RingChoice& choice, std::size_t triangles) {
    RingOptions options;
    options.random_seed = choice.random_seed;
    options.seeds = choice.seeds != 0 ? choice.seeds : recommended_seeds(triangles);
    return options;
}

Result<Mesh> load(const MeshInput& input) {
    Result<Mesh> mesh = [&]() -> Result<Mesh> {
        if (!is_lr(input.path)) return read_mesh(input.path);
        Result<LrFile> file = read_lr(input.path);
        if (!file) return file.error();
        return decode_lr(*file);
    }();
    if (!mesh || input.weld.empty()) return mesh;
    return weld(*mesh, input.weld == "position" ? Weld::position : Weld::attributes);
}

int fail(const std::string& file, const Error& error) {
    std::string line = fmt::format("lacedring: {}: {}", file, error.message);
    for (char& c : line) {
        if (c == '\n' || c == '\r') c = ' ';
    }
    fmt::print(stderr, "{}\n", line);
    switch (error.code) {
        case ErrorCode::no_device: return no_device;
        case ErrorCode::invalid_argument: return wrong_usage;
        default: return bad_input;
    }
}

}  // namespace lr::app
