// lacedring verify MESH|IN.lr: checks that every format decodes to the same multiset of oriented triangles, and an .lr
// file to the same attributes; also for each primitive of a scene.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/cli/help.h"
#include "app/cli/progress.h"
#include "app/commands/commands.h"
#include "app/formats/formats.h"
#include "app/formats/scene_check.h"

namespace lacedring::app {
namespace {

struct VerifyOptions {
    MeshInput input;
    RingChoice ring;
    bool json = false;
};

using Json = nlohmann::ordered_json;

/// Checks every format and an .lr file of the primitive. Returns the first failure; empty: none.
std::string check_primitive(const LoadedPrimitive& primitive, const RingChoice& ring) {
    const Mesh& mesh = primitive.geometry;
    {
        const Result<FormatSet> set = make_formats(mesh, primitive.surface, ring);
        if (!set) return set.error().message;
        for (const FormatCheck& check : check_formats(*set, mesh, primitive.surface)) {
            if (!check.why.empty()) return check.name + ": " + check.why;
        }
    }
    const std::string why = check_file(mesh, primitive.surface, ring.threads);
    return why.empty() ? why : "attributes: " + why;
}

/// Checks each primitive on its own, and in the joined mesh. Prints failures, or fills `json`. Returns whether all
/// pass.
bool verify_primitives(const VerifyOptions& options, const LoadedScene& scene, Json& json) {
    const PlacedDifference placed = check_placed(scene, options.input.options.tolerance);
    std::size_t failed = 0;
    ProgressBar bar("primitives", scene.primitives.size());
    for (const LoadedPrimitive& primitive : scene.primitives) {
        std::string why = check_primitive(primitive, options.ring);
        const LoadedPrimitive* const elsewhere =
            placed.primitive != nullptr ? placed.primitive : &scene.primitives.back();
        if (why.empty() && elsewhere == &primitive) why = placed.why;
        json.push_back({{"mesh", primitive.mesh},
                        {"primitive", primitive.number},
                        {"name", primitive.name},
                        {"ok", why.empty()},
                        {"why", why}});
        failed += why.empty() ? 0 : 1;
        if (!options.json && !why.empty()) print("{}: FAILED: {}\n", primitive.label(), why);
        bar.step();
    }
    if (!options.json && failed == 0) {
        print("{:<20} ok: {}, one by one and where the scene places them\n", "primitives", scene.primitives.size());
    }
    return failed == 0;
}

int run_verify(const VerifyOptions& options, RunLog& log) {
    const Result<LoadedScene> scene = load_scene(options.input, log);
    if (!scene) return fail(options.input.path, scene.error());
    const Mesh& mesh = scene->joined.mesh;
    const Surface& surface = scene->joined.surface;
    bool all = true;
    Json formats = Json::object(), absent = Json::object(), primitives = Json::array();
    const auto tell = [&](const std::string& name, const std::string& why) {
        all = all && why.empty();
        if (!options.json) print("{:<20} {}\n", name, why.empty() ? "ok" : "FAILED: " + why);
    };
    {
        const Result<FormatSet> set = make_formats(mesh, surface, options.ring);
        if (!set) return fail(options.input.path, set.error());
        for (const FormatCheck& check : check_formats(*set, mesh, surface)) {
            formats[check.name] = {{"ok", check.why.empty()}, {"why", check.why}};
            tell(check.name, check.why);
        }
        for (const auto& [name, reason] : set->absent) {
            absent[name] = reason;
            if (!options.json) print("{:<20} absent: {}\n", name, reason);
        }
    }
    const std::string why = check_file(mesh, surface, options.ring.threads);
    tell("attributes", why);
    if (!scene->primitives.empty()) {
        all = verify_primitives(options, *scene, primitives) && all;
    }
    if (options.json) {
        Json out = {{"schema", 1},
                    {"file", input_name(options.input.path)},
                    {"formats", formats},
                    {"absent", absent},
                    {"attributes", {{"ok", why.empty()}, {"why", why}}}};
        if (!primitives.empty()) out["primitives"] = std::move(primitives);
        print_json(out);
    }
    return all ? done : check_failed;
}

}  // namespace

void add_verify(CLI::App& program, Action& action) {
    auto options = std::make_shared<VerifyOptions>();
    CLI::App* command =
        program.add_subcommand("verify", "check that every format gives back the mesh, and each primitive of a scene");
    command->add_option("MESH|IN.lr", options->input.path, "mesh file or .lr file; - is standard input")->required();
    add_input_options(*command, options->input.options, 420);
    add_ring_options(*command, options->ring);
    add_threads(*command, {&options->input.options.threads, &options->ring.threads});
    add_json(*command, options->json);
    add_example(*command, "verify bunny.ply", "reliability.md");
    command->callback([options, &action] { action = [options](RunLog& log) { return run_verify(*options, log); }; });
}

}  // namespace lacedring::app
