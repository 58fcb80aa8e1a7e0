// lacedring stats MESH...: the size of every format, side by side.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/cli/help.h"
#include "app/cli/option_rules.h"
#include "app/cli/values.h"
#include "app/commands/commands.h"
#include "app/formats/whole_file.h"
#include "app/report/lr_contents.h"
#include "app/report/paper_tables.h"
#include "app/report/scene_tables.h"
#include "app/report/total_table.h"
#include "lrcore/codec/packed/packed_format.h"
#include "lrlab/rivals/strips.h"

namespace lacedring::app {
namespace {

using Json = nlohmann::ordered_json;

struct StatsOptions {
    std::vector<std::string> paths;
    InputOptions input;
    RingChoice ring;
    bool paper = false;
    AttributeBits bits;
    std::vector<std::string> attributes;  ///< counted by --table total; empty: all
    std::string table = "sizes";
    bool json = false;
};

Json sizes_to_json(const std::string& path, const Mesh& mesh, const FormatSet& set) {
    Json out = {{"file", input_name(path)},
                {"triangles", mesh.triangle_count()},
                {"vertices", set.vertices},
                {"copies", mesh.vertex_count},
                {"seam_edges", set.seam_edges},
                {"components", set.report.components},
                {"border_edges", set.topology.border_edges},
                {"border_loops", set.report.border_loops},
                {"nonmanifold_edges", set.topology.nonmanifold_edges},
                {"degenerate_dropped", set.topology.degenerate},
                {"valence6_percent", set.report.valence6_percent},
                {"ring",
                 {{"ring_vertices", set.lean.ring_vertices},
                  {"isolated", set.lean.isolated},
                  {"t0", set.lean.t0},
                  {"t0_wart", set.lean.t0_wart},
                  {"t2", set.lean.t2},
                  {"irregular", set.lean.irregular},
                  {"seeds", set.ring.seeds}}},
                {"formats", Json::object()},
                {"absent", Json::object()}};
    const double triangles = set.triangles();
    for (const MeasuredFormat& format : set.formats) {
        const CacheFigures cache = analyze_fifo32(format.indices, format.vertex_count(set.vertices));
        Json entry = {{"bytes", format.bytes},
                      {"seam_bytes", format.seam_bytes},
                      {"bits_per_triangle", 8 * static_cast<double>(format.bytes) / triangles},
                      {"references_per_triangle", static_cast<double>(format.references) / triangles},
                      {"acmr_fifo32", cache.acmr},
                      {"atvr_fifo32", cache.atvr}};
        if (format.deflated != 0) entry["bytes_deflated"] = format.deflated;
        if (format.ring != nullptr) {
            entry["ring"] = format.ring;
            entry["k"] = format.k == 0 ? Json(nullptr) : Json(format.k);  // null: depth first
            entry["passes"] = format.passes;
        }
        out["formats"][format.name] = std::move(entry);
    }
    out["lr_ring"] = {{"t0", set.lr.t0},
                      {"t0_wart", set.lr.t0_wart},
                      {"t2", set.lr.t2},
                      {"irregular", set.lr.t1_irregular + set.lr.t2_irregular},
                      {"isolated", set.lr.isolated}};
    out["lr_compact_ring"] = {
        {"t0", set.lr_compact.t0},     {"t0_wart", set.lr_compact.t0_wart},
        {"t2", set.lr_compact.t2},     {"irregular", set.lr_compact.t1_irregular + set.lr_compact.t2_irregular},
        {"long", set.lr_compact_long}, {"isolated", set.lr_compact.isolated}};
    for (const auto& [name, reason] : set.absent) out["absent"][name] = reason;
    out["best_order"] = nullptr;
    if (set.best_order) {
        out["best_order"] = {{"acmr_fifo32", set.best_order->acmr}, {"atvr_fifo32", set.best_order->atvr}};
    }
    out["packed"] = {{"ring_vertices", set.packed.ring_vertices},
                     {"warts", set.packed.warts},
                     {"splits", set.packed.events[LR_PACKED_SPLIT]},
                     {"parted_blocks", set.packed.parted_blocks},
                     {"plain_blocks", set.packed.plain_blocks}};
    return out;
}

void print_sizes(const std::string& path, const Mesh& mesh, const FormatSet& set, const std::optional<LrContents>& lr) {
    const double triangles = set.triangles();
    const auto share = [&](std::uint32_t count) { return 100.0 * count / triangles; };
    print("{}: {} triangles, {}, {} component{}, {} border edges", path, mesh.triangle_count(),
          vertices_text(set.vertices, mesh.vertex_count), set.report.components, set.report.components == 1 ? "" : "s",
          set.topology.border_edges);
    if (set.seam_edges > 0) print(", {} seam edges", set.seam_edges);
    if (set.topology.nonmanifold_edges > 0) print(", {} non-manifold edges", set.topology.nonmanifold_edges);
    if (set.topology.degenerate > 0) print(", {} dropped", count_text(set.topology.degenerate, "degenerate triangle"));
    print("\n");
    if (lr) print_contents(*lr);
    print("  ring: {} vertices on it, {} isolated; T0 {:.2f} %, in warts {:.2f} %, T2 {:.2f} %\n\n",
          set.lean.ring_vertices, set.lean.isolated, share(set.lean.t0), share(set.lean.t0_wart), share(set.lean.t2));
    const bool seams = set.seam_edges > 0;
    print("  {:<20}{:>11}{:>10}{}{:>10}{:>10}{:>10}{:>10}{:>11}\n", "format", "bytes", "bits/tri",
          seams ? "   + seams" : "", "refs/tri", "of u32", "ACMR(32)", "ATVR(32)", "deflated");
    const auto base = static_cast<double>(set.formats.front().bytes);
    for (const MeasuredFormat& format : set.formats) {
        const auto bits = [&](std::size_t bytes) { return 8 * static_cast<double>(bytes) / triangles; };
        const CacheFigures cache = analyze_fifo32(format.indices, format.vertex_count(set.vertices));
        print("  {:<20}{:>11}{:>10.2f}{}{:>10}{:>8.1f} %{:>10.3f}{:>10.3f}{:>11}\n", format.name, format.bytes,
              bits(format.bytes),
              seams
                  ? fmt::format("{:>10}", format.seam_bytes == 0 ? "" : fmt::format("{:.2f}", bits(format.seam_bytes)))
                  : "",
              format.references == 0 ? "" : fmt::format("{:.3f}", static_cast<double>(format.references) / triangles),
              base > 0 ? 100 * static_cast<double>(format.bytes) / base : 0.0, cache.acmr, cache.atvr,
              format.deflated == 0 ? "" : fmt::format("{}", format.deflated));
    }
    if (set.best_order) {
        print("  meshoptimizer's best order for the vertex cache: ACMR(32) {:.3f}, ATVR(32) {:.3f}\n",
              set.best_order->acmr, set.best_order->atvr);
    }
    for (const auto& [name, reason] : set.absent) print("  {:<20}absent: {}\n", name, reason);
    if (seams) print("  every format is of the surface; + seams: bits/tri beside, which copy each corner has\n");
    print("\n");
}

/// Returns whether the command makes rings for this table alone.
bool makes_rings(const StatsOptions& options) {
    return options.table == "offsets" || options.table == "periods" || options.table == "seeds";
}

/// Returns whether the output has rows for the primitives of a scene.
bool shows_primitives(const StatsOptions& options) {
    return options.json || options.table == "sizes";
}

/// Loads a scene without its primitives.
Result<LoadedScene> load_joined(const MeshInput& input, RunLog& log) {
    Result<LoadedMesh> loaded = load_file(input, log);
    if (!loaded) return loaded.error();
    return LoadedScene{std::move(*loaded), {}, {}};
}

/// Measures every format: prints it, fills `json`, or adds a row to `rows` for a table of sizes. Returns an Exit.
int add_sizes(const StatsOptions& options, const std::string& path, const LoadedScene& scene, Json& json,
              std::vector<MeshRow>& rows) {
    const LoadedMesh& loaded = scene.joined;
    const Mesh& mesh = loaded.mesh;
    const Result<FormatSet> set = make_formats(mesh, loaded.surface, options.ring, options.paper);
    if (!set) return fail(path, set.error());
    for (const MeasuredFormat& format : set->formats) {
        if (format.invalid.empty()) continue;
        say("lacedring: {}: {}: {}\n", path, format.name, format.invalid);
        return check_failed;
    }
    Result<PrimitiveSizes> primitives = measure_primitives(scene, options.ring, options.paper);
    if (!primitives) return fail(path, primitives.error());
    if (!primitives->invalid.empty()) {
        say("lacedring: {}: {}\n", path, primitives->invalid);
        return check_failed;
    }
    if (options.json) {
        json = sizes_to_json(path, mesh, *set);
        if (loaded.lr) json["lr"] = to_json(*loaded.lr);
        if (!scene.primitives.empty()) add_primitive_sizes(*primitives, json);
    } else if (options.table == "sizes") {
        print_sizes(path, mesh, *set, loaded.lr);
        if (!scene.primitives.empty()) print_primitive_sizes(*primitives);
    } else {
        MeshRow& row = rows.emplace_back(MeshRow{path, {}});
        for (const Column& column : size_table(options.table)) row.values.push_back(column.value(mesh, *set));
    }
    return done;
}

/// Measures whole meshes (--table total): prints the table or, if not null, fills `json`. Returns an Exit.
int add_total(const StatsOptions& options, const std::string& path, LoadedMesh loaded, Json* json,
              std::vector<TotalTable>& tables, RunLog& log) {
    Mesh& mesh = loaded.mesh;
    const std::vector<std::string>& wanted = options.attributes;
    std::erase_if(mesh.attributes, [&](const Attribute& attribute) {
        return !wanted.empty() && std::find(wanted.begin(), wanted.end(), attribute.name) == wanted.end();
    });
    if (!wanted.empty() && loaded.surface.has_seams()) {  // some copies may now be equal
        mesh = merge_copies(mesh, loaded.surface);
    }
    Result<TotalTable> table = make_total(path, mesh, loaded.surface, options.ring, options.bits, log);
    if (!table) return fail(path, table.error());
    if (!table->invalid.empty()) {
        say("lacedring: {}: {}\n", path, table->invalid);
        return check_failed;
    }
    if (json != nullptr) {
        (*json)["total"] = to_json(*table);
        for (const auto& [name, reason] : table->absent) (*json)["absent"][name] = reason;
    } else {
        print_total(path, *table);
    }
    tables.push_back(std::move(*table));
    return done;
}

/// Makes rings for --table offsets, periods or seeds: prints their figures or, if not null, fills `json`; `rows` gets
/// those of seeds. Returns an Exit.
int add_ring_figures(const StatsOptions& options, const std::string& path, const Mesh& mesh, Json* json,
                     std::vector<SeedRow>& rows) {
    const RingOptions ring = compact_ring_options(options.ring);
    if (options.table == "seeds") {
        const Result<SeedRow> row = figures_by_seeds(path, mesh, ring);
        if (!row) return fail(path, row.error());
        if (json != nullptr) (*json)["by_seeds"] = to_json(*row);
        rows.push_back(*row);
        return done;
    }
    const bool figure8 = options.table == "offsets";
    const auto periods =
        figures_by_period(mesh, ring, figure8 ? std::span<const std::uint32_t>(kFigure8Periods) : kPeriods);
    if (!periods) return fail(path, periods.error());
    if (json != nullptr) {
        (*json)["by_period"] = to_json(*periods);
    } else {
        (figure8 ? print_offsets : print_periods)(path, *periods);
    }
    return done;
}

int run_stats(const StatsOptions& options, RunLog& log) {
    Json meshes = Json::array();
    std::vector<MeshRow> mesh_rows;
    std::vector<SeedRow> seed_rows;
    std::vector<TotalTable> totals;
    const bool rings = makes_rings(options), total = options.table == "total";
    const int exit = for_each_input(options.paths, log, [&](std::size_t i) {
        const std::string& path = options.paths[i];
        const MeshInput input{path, options.input};
        Result<LoadedScene> scene = shows_primitives(options) ? load_scene(input, log) : load_joined(input, log);
        if (!scene) return fail(path, scene.error());
        LoadedMesh* const loaded = &scene->joined;
        Json json;
        if (options.json || !(rings || total)) {
            if (const int code = add_sizes(options, path, *scene, json, mesh_rows); code != done) return code;
        }
        if (rings) {
            const int code = add_ring_figures(options, path, surface_mesh(loaded->mesh, loaded->surface),
                                              options.json ? &json : nullptr, seed_rows);
            if (code != done) return code;
        }
        if (total) {
            const int code = add_total(options, path, std::move(*loaded), options.json ? &json : nullptr, totals, log);
            if (code != done) return code;
        }
        if (options.json) meshes.push_back(std::move(json));
        return int{done};
    });
    if (options.json) {
        Json document{{"schema", 1}};
        if (total) document["versions"] = total_versions();
        const bool some = !meshes.empty();
        document["meshes"] = std::move(meshes);
        if (exit == done || some) print_json(document);
    } else if (!mesh_rows.empty()) {
        print(size_table(options.table), mesh_rows);
    } else if (!seed_rows.empty()) {
        print(seed_rows);
    } else if (totals.size() > 1) {
        print_medians(totals);
    }
    return exit;
}

}  // namespace

void add_stats(CLI::App& program, Action& action) {
    auto options = std::make_shared<StatsOptions>();
    CLI::App* command = program.add_subcommand("stats", "list the size of a mesh in every format");
    command->add_option("MESH", options->paths, "mesh files or .lr files; - is standard input")->required();
    add_input_options(*command, options->input, 420);
    add_ring_options(*command, options->ring);
    add_threads(*command, {&options->input.threads, &options->ring.threads});
    command->add_flag("--paper", options->paper, "make rings as the paper does, without the optimizer");
    add_attribute_bits(*command, options->bits);
    command->add_option("--attributes", options->attributes, "count only these attributes, in --table total")
        ->expected(1)
        ->delimiter(',')
        ->type_name("A,B,...");
    allow_words(command->add_option("--table", options->table, "print {}"),
                {"sizes", "total", "packed", "table1", "lean", "storage", "offsets", "periods", "seeds"})
        ->capture_default_str();
    add_json(*command, options->json);
    auto rules = std::make_shared<OptionRules>(*command);
    rules->never_with({"--optimize"}, "--paper");
    const auto makes_sizes = [options] { return options->json || !makes_rings(*options); };
    const auto total = [options] { return options->table == "total"; };
    rules->only_with({"--ring", "--k", "--optimize"}, "--json, or a table of sizes", makes_sizes);
    rules->only_with({"--paper"}, "--json, or a table of sizes, total excepted",
                     [options, makes_sizes, total] { return options->json || (makes_sizes() && !total()); });
    rules->only_with(kAttributeBits, "--table total", total);
    rules->only_with({"--attributes"}, "--table total", total);
    rules->forbid("--attributes must name POSITION", [options] {
        const std::vector<std::string>& named = options->attributes;
        return !named.empty() && std::find(named.begin(), named.end(), "POSITION") == named.end();
    });
    rules->only_with({"--seeds"}, "--json, or another --table than seeds",
                     [options, makes_sizes] { return makes_sizes() || options->table != "seeds"; });
    add_example(*command, "stats bunny.ply", "command-line.md and docs/results.md");
    command->callback([options, rules, &action] {
        rules->check();
        action = [options](RunLog& log) { return run_stats(*options, log); };
    });
}

}  // namespace lacedring::app
