// lacedring info MESH: contents and topology of a file.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>

#include "app/cli/help.h"
#include "app/commands/commands.h"
#include "app/report/lr_contents.h"
#include "app/report/scene_tables.h"
#include "lacedring/topology.hpp"

namespace lacedring::app {
namespace {

struct InfoOptions {
    MeshInput input;
    bool json = false;
};

/// Numbers and total volume of the closed shells of a mesh.
struct Solid {
    std::size_t shells = 0, inside_out = 0, flat = 0;
    double volume = 0;  ///< hollows are subtracted
};

Solid sum(const std::vector<ClosedShell>& shells) {
    Solid solid;
    solid.shells = shells.size();
    for (const ClosedShell& shell : shells) {
        solid.inside_out += shell.inside_out() ? 1 : 0;
        solid.flat += shell.flat() ? 1 : 0;
        solid.volume += shell.volume;
    }
    return solid;
}

std::string describe(const Solid& solid, bool all_closed) {
    if (solid.shells == 0) return "none: no piece of surface is closed";
    std::string text = all_closed ? fmt::format("{:.6g}", solid.volume) : "none: not all pieces of surface are closed";
    if (solid.shells > 1 || !all_closed) text += fmt::format("; {} closed", solid.shells);
    if (solid.inside_out > 0) text += fmt::format("; {} inside out, or hollows", solid.inside_out);
    if (solid.flat > 0) text += fmt::format("; {} flat", solid.flat);
    return text;
}

std::uint64_t total_bytes(const std::vector<std::uint64_t>& bytes) {
    return std::accumulate(bytes.begin(), bytes.end(), std::uint64_t{0});
}

int run_info(const InfoOptions& options, RunLog& log) {
    const Result<LoadedScene> scene = load_scene(options.input, log);
    if (!scene) return fail(options.input.path, scene.error());
    const LoadedMesh* const loaded = &scene->joined;
    const Mesh* mesh = &loaded->mesh;
    const Mesh surface = surface_mesh(*mesh, loaded->surface);
    const Result<CornerTable> table = build_corner_table(surface.indices, surface.vertex_count);
    if (!table) return fail(options.input.path, table.error());
    const TopologyReport r = report_topology(*table);
    const Topology& t = table->topology;
    const std::uint32_t vertices = surface.vertex_count;
    const Positions positions = positions_of(surface);
    const std::size_t seams = seam_edges(*table, *mesh).size();
    const std::vector<ClosedShell> closed = closed_shells(*table, positions);
    const SmeshCheck smesh = positions.empty() ? check_smesh(*table, r) : check_smesh(*table, r, closed);
    const Solid solid = sum(closed);
    const bool has_volume = r.closed && r.shells > 0 && !positions.empty();
    if (options.json) {
        nlohmann::ordered_json attributes = nlohmann::ordered_json::array();
        for (const Attribute& a : mesh->attributes) {
            attributes.push_back({{"name", a.name}, {"type", type_name(a.type)}, {"components", a.components}});
        }
        nlohmann::ordered_json out = {{"schema", 1},
                                      {"file", input_name(options.input.path)},
                                      {"triangles", mesh->triangle_count()},
                                      {"vertices", vertices},
                                      {"copies", mesh->vertex_count},
                                      {"seam_edges", seams},
                                      {"unused_vertices", vertices - r.used_vertices},
                                      {"components", r.components},
                                      {"shells", r.shells},
                                      {"border_edges", t.border_edges},
                                      {"border_loops", r.border_loops},
                                      {"nonmanifold_edges", t.nonmanifold_edges},
                                      {"nonmanifold_vertices", r.nonmanifold_vertices},
                                      {"degenerate_dropped", t.degenerate},
                                      {"flipped", t.flipped},
                                      {"cut_edges", t.cut_edges},
                                      {"orientable", r.orientable},
                                      {"closed", r.closed},
                                      {"euler_characteristic", r.euler_characteristic},
                                      {"genus", r.genus},
                                      {"valence6_percent", r.valence6_percent},
                                      {"max_valence", r.max_valence},
                                      {"handles", r.orientable ? nlohmann::ordered_json(r.genus) : nullptr},
                                      {"smesh", smesh.is_smesh()},
                                      {"smesh_reason", smesh.reason},
                                      {"closed_shells", solid.shells},
                                      {"inside_out_shells", solid.inside_out},
                                      {"flat_shells", solid.flat},
                                      {"volume", has_volume ? nlohmann::ordered_json(solid.volume) : nullptr},
                                      {"attributes", attributes}};
        if (loaded->lr) out["lr"] = to_json(*loaded->lr);
        if (!loaded->streams.empty()) {
            out["packed"] = {{"streams", loaded->streams}, {"bytes", total_bytes(loaded->streams)}};
        }
        if (!scene->primitives.empty()) {
            out["primitives"] = primitives_to_json(*scene);
            out["sum"] = sum_to_json(*scene);
        }
        print_json(out);
        return done;
    }
    print("{}\n", input_name(options.input.path));
    const auto line = [](const char* name, const std::string& value) { print("  {:<22} {}\n", name, value); };
    if (loaded->lr) print_contents(*loaded->lr);
    if (!loaded->streams.empty()) {
        line("packed scene", fmt::format("{} stream{} of {} bytes", loaded->streams.size(),
                                         loaded->streams.size() == 1 ? "" : "s", total_bytes(loaded->streams)));
    }
    line("triangles", fmt::format("{}{}", mesh->triangle_count(),
                                  t.degenerate > 0 ? fmt::format(", {} of them degenerate", t.degenerate) : ""));
    const std::uint32_t unused = vertices - r.used_vertices;
    line("vertices", fmt::format("{}{}", vertices, unused > 0 ? fmt::format(", {} unused", unused) : ""));
    if (seams > 0) line("seams", fmt::format("{} edges; {} vertex copies", seams, mesh->vertex_count));
    line("components", fmt::format("{}{}", r.components,
                                   r.shells != r.components ? fmt::format(", {} pieces of surface", r.shells) : ""));
    line("borders",
         fmt::format("{} edges in {} loop{}", t.border_edges, r.border_loops, r.border_loops == 1 ? "" : "s"));
    line("non-manifold", fmt::format("{} edges, {} vertices", t.nonmanifold_edges, r.nonmanifold_vertices));
    line("orientation", !r.orientable    ? fmt::format("not orientable: cut at {} edges", t.cut_edges)
                        : t.flipped == 0 ? "consistent"
                                         : fmt::format("orientable once {} triangles are reversed", t.flipped));
    line("Euler characteristic", fmt::format("{}", r.euler_characteristic));
    line("genus", fmt::format("{}{}{}", r.genus, r.shells > 1 ? ", all pieces together" : "",
                              r.orientable ? "" : ", of the surface as cut"));
    line("smesh", smesh.is_smesh() ? "yes: a sphere, counterclockwise" : "no: " + smesh.reason);
    line("volume", describe(solid, r.closed));
    line("valence 6", fmt::format("{:.1f} % of vertices; largest valence {}", r.valence6_percent, r.max_valence));
    std::string attributes;
    for (const Attribute& a : mesh->attributes) {
        attributes += fmt::format("{}{} ({} x {})", attributes.empty() ? "" : ", ", printable(a.name), a.components,
                                  type_name(a.type));
    }
    line("attributes", attributes);
    if (!scene->primitives.empty()) print_primitives(*scene);
    return done;
}

}  // namespace

void add_info(CLI::App& program, Action& action) {
    auto options = std::make_shared<InfoOptions>();
    CLI::App* command =
        program.add_subcommand("info", "describe a mesh: its topology, a scene's primitives, an .lr file's sections");
    command->add_option("MESH", options->input.path, "mesh file or .lr file; - is standard input")->required();
    add_input_options(*command, options->input.options, 130);
    add_threads(*command, {&options->input.options.threads});
    add_json(*command, options->json);
    add_example(*command, "info bunny.ply", "command-line.md");
    command->callback([options, &action] { action = [options](RunLog& log) { return run_info(*options, log); }; });
}

}  // namespace lacedring::app
