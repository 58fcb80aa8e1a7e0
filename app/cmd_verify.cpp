// lacedring verify MESH|IN.lr: every format gives back the same multiset of oriented triangles.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/formats.h"
#include "lrlab/rivals/whole_mesh.h"

namespace lacedring::app {
namespace {

struct VerifyOptions {
    MeshInput input;
    RingChoice ring;
    bool json = false;
};

/// Empty, or what of the mesh's vertices `order` loses. Copies of non-manifold vertices may come on top.
std::string check_order(const MeasuredFormat& format, std::uint32_t vertices) {
    std::vector<bool> seen(vertices, false);
    std::size_t again = 0;
    for (const std::uint32_t v : format.order) {
        if (v >= vertices) return fmt::format("vertex {} of {}", v, vertices);
        again += seen[v] ? 1 : 0;
        seen[v] = true;
    }
    if (again != format.copies) return fmt::format("{} vertices twice instead of {}", again, format.copies);
    return format.order.size() == vertices + format.copies ? "" : "some vertices are lost";
}

int run_verify(const VerifyOptions& options, RunLog& log) {
    const Result<LoadedMesh> loaded = load_file(options.input, log);
    if (!loaded) return fail(options.input.path, loaded.error());
    const Result<FormatSet> set = make_formats(loaded->mesh, loaded->surface, options.ring);
    if (!set) return fail(options.input.path, set.error());
    const auto expected = oriented_triangles(surface_mesh(loaded->mesh, loaded->surface).indices, {});
    nlohmann::ordered_json formats = nlohmann::ordered_json::object();
    bool all = true;
    for (const MeasuredFormat& format : set->formats) {
        std::string why = format.invalid;
        if (why.empty() && !format.order.empty()) why = check_order(format, set->vertices);
        if (why.empty()) {
            const auto got = oriented_triangles(format.indices, format.order);
            if (got.size() != expected.size()) {
                why = fmt::format("{} triangles instead of {}", got.size(), expected.size());
            } else if (got != expected) {
                why = "other triangles, or another orientation";
            }
        }
        all = all && why.empty();
        formats[format.name] = {{"ok", why.empty()}, {"why", why}};
        if (!options.json) print("{:<20} {}\n", format.name, why.empty() ? "ok" : "FAILED: " + why);
    }
    nlohmann::ordered_json absent = nlohmann::ordered_json::object();
    for (const auto& [name, reason] : set->absent) {
        absent[name] = reason;
        if (!options.json) print("{:<20} absent: {}\n", name, reason);
    }
    if (options.json) {
        const nlohmann::ordered_json out = {
            {"schema", 1}, {"file", input_name(options.input.path)}, {"formats", formats}, {"absent", absent}};
        print_json(out);
    }
    return all ? done : check_failed;
}

}  // namespace

void add_verify(CLI::App& program, Action& action) {
    auto options = std::make_shared<VerifyOptions>();
    CLI::App* command = program.add_subcommand("verify", "check that every format round-trips");
    command->add_option("MESH|IN.lr", options->input.path, "mesh file or .lr file")->required();
    add_input_options(*command, options->input.options, 350);
    add_ring_options(*command, options->ring);
    command->add_flag("--json", options->json, "one JSON document on standard output");
    command->callback([options, &action] { action = [options](RunLog& log) { return run_verify(*options, log); }; });
}

}  // namespace lacedring::app
