// lacedring bench MESH...: construction, decoding and drawing, each beside a rival in the same run.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "app/bench/candidates.h"
#include "app/bench/gpu.h"
#include "app/bench/operators.h"
#include "app/bench/resident.h"
#include "app/bench/section.h"
#include "app/bench/unpack.h"
#include "app/bench/vertices.h"
#include "app/cli/help.h"
#include "app/cli/option_rules.h"
#include "app/cli/progress.h"
#include "app/cli/values.h"
#include "app/commands/commands.h"

namespace lacedring::app {
namespace {

using Json = nlohmann::ordered_json;

struct BenchOptions {
    std::vector<std::string> paths;
    InputOptions input;
    int rounds = 5;
    std::uint32_t seeds = 1;
    std::uint32_t positions = kBenchPositions;  ///< bits
    bool operators = false;
    bool resident = false;
    ResidentOptions limits;
    GpuBench gpu;
    bool json = false;
};

/// All measurements of one mesh.
struct Figures {
    std::string path;
    Counts counts;
    std::size_t triangles = 0;
    Section construct, decode, unpack, restore, decode_gpu{"decode_gpu (wall)", {}};
    std::vector<OperatorFigures> operators;
    std::optional<ResidentFigures> resident;
    std::optional<GpuFigures> gpu;
    std::string gpu_skipped;  ///< why `gpu` is empty
    Json peak = Json::object(), absent = Json::object();

    // Median seconds of the first candidate divided by those of the second.
    Json construct_ratio() const { return construct.ratio("strips", "lean"); }
    Json decode_cpu_ratio() const { return decode.ratio("meshopt_vertex_codec", "vertices"); }
    Json unpack_ratio() const { return unpack.ratio("draco", "lacedring"); }
    Json restore_ratio() const { return restore.ratio("draco", "lacedring"); }
    Json decode_gpu_ratio() const { return decode_gpu.ratio("packed_vertices", "packed"); }
};

/// Like fail, but invalid_argument, which means that structures disagree on a result, is a failed check.
int failed(const std::string& path, const Error& error) {
    const int code = fail(path, error);
    return error.code == ErrorCode::invalid_argument ? static_cast<int>(check_failed) : code;
}

/// Measures the candidates, with a progress bar, and adds the absent ones to `absent`.
Section measured(const char* name, Candidates candidates, int rounds, Json& absent) {
    for (const auto& [what, reason] : candidates.absent) absent[what] = reason;
    Section out{name, std::move(candidates.list)};
    measure(out, rounds);
    return out;
}

/// Peak memory of building lean, packed and strips.
Json peaks(const Section& construct) {
    Json out = Json::object();
    ProgressBar bar("peak memory", 3);
    for (const char* name : {"lean", "packed", "strips"}) {
        const auto at = std::ranges::find(construct.candidates, name, &Candidate::name);
        if (at != construct.candidates.end()) out[name] = peak_bytes(at->work);
        bar.step();
    }
    return out;
}

Result<Figures> measure_cpu(const BenchOptions& options, const std::string& path, const Subject& subject) {
    const Mesh& mesh = subject.mesh;
    Figures out;
    out.path = path;
    out.triangles = mesh.triangle_count();
    out.counts = {static_cast<double>(out.triangles), static_cast<double>(mesh.vertex_count)};
    out.construct = measured("construct", construction(subject), options.rounds, out.absent);
    const VertexOptions positions = position_options(options.positions);
    Result<Candidates> decoders = decoding(subject, positions);
    if (!decoders) return decoders.error();
    out.decode = measured("decode_cpu", std::move(*decoders), options.rounds * 3, out.absent);
    out.unpack =
        measure_unpacking("unpack", unpack_candidates(subject.loaded.mesh), options.rounds * 3, out.absent, "");
    out.restore = measure_unpacking(
        "restore",
        restore_candidates(mesh, as_encoded(EncodedPacked(subject.packed)), {.positions = options.positions}),
        options.rounds * 3, out.absent, "_restore");
    if (options.operators) {
        Result<OperatorBench> operators = measure_operators(mesh, subject.table, options.rounds);
        if (!operators) return operators.error();
        out.operators = std::move(operators->structures);
        for (const auto& [name, reason] : operators->absent) out.absent[name + "_operators"] = reason;
    }
    if (options.resident) {
        ResidentOptions limits = options.limits;
        limits.rounds = options.rounds;
        Result<ResidentFigures> resident = measure_resident(mesh, subject.table, limits);
        if (!resident) return resident.error();
        out.resident = std::move(*resident);
    }
    return out;
}

/// Adds the times on the device, if there is one.
Result<void> add_device(const BenchOptions& options, const Subject& subject, Figures& out) {
    Result<std::optional<GpuFigures>> gpu =
        options.gpu.measure(subject.loaded, position_options(options.positions), options.rounds, out.gpu_skipped);
    if (!gpu) return gpu.error();
    out.gpu = std::move(*gpu);
    if (!out.gpu) return {};
    out.decode_gpu.candidates = out.gpu->decode;
    out.peak["gpu"] = out.gpu->device_bytes;
    for (const auto& [name, reason] : out.gpu->absent) out.absent[name] = reason;
    return {};
}

Json draw_to_json(const Figures& figures) {
    if (!figures.gpu) return Json::object();
    Json draw = to_json({"", figures.gpu->draw}, figures.counts);
    for (std::size_t i = 0; i < figures.gpu->draw.size(); ++i) {
        const DrawCost& cost = figures.gpu->cost[i];
        Json& entry = draw[figures.gpu->draw[i].name];
        entry["connectivity_bytes"] = cost.connectivity_bytes;
        entry["connectivity_bytes_read"] = cost.bytes_read;
        if (cost.vertex_invocations) entry["vertex_invocations"] = *cost.vertex_invocations;
    }
    return draw;
}

Json figures_json(const BenchOptions& options, const Figures& figures) {
    Json operators = Json::object();
    for (const OperatorFigures& structure : figures.operators) {
        Json& entry = operators[structure.structure];
        for (const auto& row : structure.rows) entry[row.name] = {{"ns_per_op", row.ns_per_op()}};
    }
    const auto section = [&](const Section& s) { return to_json(s, figures.counts); };
    return {{"file", figures.path},
            {"triangles", figures.triangles},
            {"construct", section(figures.construct)},
            {"construct_ratio", figures.construct_ratio()},
            {"position_bits", options.positions},
            {"decode_cpu", section(figures.decode)},
            {"decode_cpu_ratio", figures.decode_cpu_ratio()},
            {"unpack", section(figures.unpack)},
            {"unpack_ratio", figures.unpack_ratio()},
            {"restore", section(figures.restore)},
            {"restore_ratio", figures.restore_ratio()},
            {"decode_gpu", section(figures.decode_gpu)},
            {"decode_gpu_ratio", figures.decode_gpu_ratio()},
            {"draw", draw_to_json(figures)},
            {"device", figures.gpu ? figures.gpu->device : ""},
            {"gpu_skipped", figures.gpu_skipped},
            {"absent", figures.absent},
            {"operators", operators},
            {"resident", figures.resident ? to_json(*figures.resident) : Json::object()},
            {"peak_bytes", figures.peak}};
}

void print_draw(const GpuFigures& figures, double triangles) {
    print("  draw (wall){:>39}{:>22}{:>10}{:>9}{:>10}{:>10}{:>9}\n", "ms", "min to max", "GPU ms", "plain", "resident",
          "read", "VS runs");
    const double plain = figures.draw[0].median();
    for (std::size_t i = 0; i < figures.draw.size(); ++i) {
        const Candidate& c = figures.draw[i];
        const DrawCost& cost = figures.cost[i];
        const auto [low, high] = std::minmax_element(c.seconds.begin(), c.seconds.end());
        const auto a_triangle = [&](std::uint64_t n) { return static_cast<double>(n) / triangles; };
        print("    {:<37}{:>9.2f}{:>22}{:>10}{:>8.2f}x{:>10.3f}{:>10.2f}{:>9}\n", c.name, c.median() * 1e3,
              fmt::format("{:.2f} to {:.2f}", *low * 1e3, *high * 1e3),
              c.gpu_seconds.empty() ? "-" : fmt::format("{:.2f}", median(c.gpu_seconds) * 1e3), c.median() / plain,
              a_triangle(cost.connectivity_bytes), a_triangle(cost.bytes_read),
              cost.vertex_invocations ? fmt::format("{:.2f}", a_triangle(*cost.vertex_invocations)) : "-");
    }
    print("    resident, read: bytes of connectivity a triangle; VS runs: vertex shader runs a triangle\n");
}
void print_operators(const std::vector<OperatorFigures>& operators) {
    print("  operators, ns each{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "refs/tri", "c.v", "c.o, c.s", "valence",
          "normal", "contour");
    for (const OperatorFigures& structure : operators) {
        print("    {:<16}{:>10.3f}", structure.structure, structure.references_per_triangle);
        for (const auto& row : structure.rows) print("{:>10.2f}", row.ns_per_op());
        print("\n");
    }
}

void print_ratio(const Json& ratio, std::string_view before, std::string_view after) {
    if (ratio.front().is_number()) print("  {} {:.2f} {}\n", before, ratio.front().get<double>(), after);
}

void print_figures(const BenchOptions& options, const Figures& figures) {
    const double triangles = figures.counts.triangles;
    print("{}: {} triangles; medians of {} rounds\n", figures.path, figures.triangles, options.rounds);
    for (const Section* section :
         {&figures.construct, &figures.decode, &figures.unpack, &figures.restore, &figures.decode_gpu}) {
        if (section->candidates.empty()) continue;
        print("  {}\n", section->name);
        for (const Candidate& c : section->candidates) {
            const double million = 1e6 * c.median();
            print("    {:<24}{:>11.3f} ms{:>10.1f} {}\n", c.name, c.median() * 1e3,
                  (c.vertices ? figures.counts.vertices : triangles) / million, c.vertices ? "Mvert/s" : "Mtri/s");
        }
    }
    if (figures.gpu) print_draw(*figures.gpu, triangles);
    print("  {}\n", figures.gpu ? "drawn at 1280x720 on " + figures.gpu->device : "not drawn: " + figures.gpu_skipped);
    if (!figures.operators.empty()) print_operators(figures.operators);
    if (figures.resident) print_resident(*figures.resident);
    print_ratio(figures.construct_ratio(), "lean is built", "times as fast as strips");
    print_ratio(figures.decode_cpu_ratio(), fmt::format("positions of {} bits decode", options.positions),
                "times as fast as by meshoptimizer's vertex codec");
    print_ratio(figures.unpack_ratio(), "the whole mesh is unpacked", "times as fast as by Draco");
    print_ratio(figures.restore_ratio(),
                fmt::format("a file in storage form takes {:.0f} ns a triangle to restore,",
                            1e9 * figures.restore.median("lacedring") / triangles),
                "times as fast as Draco decodes its smallest");
    print_ratio(figures.restore.ratio("draco", "lacedring_arrays"), "straight to indices and positions,",
                "times as fast");
    print_ratio(figures.decode_gpu_ratio(), "on the device, indices and positions take",
                "times as long as indices alone");
    for (const auto& [name, reason] : figures.absent.items()) {
        print("  {} absent: {}\n", name, reason.get<std::string>());
    }
    print("  peak memory beyond the input\n");
    for (const auto& [name, bytes] : figures.peak.items()) {
        print("    {:<24}{:>11.1f} MB{:>10.1f} bytes a triangle\n", name, bytes.get<double>() / 1e6,
              bytes.get<double>() / triangles);
    }
}

/// Measures one mesh and prints its figures or, with --json, adds them to `meshes`. Returns an Exit.
int bench(const BenchOptions& options, const std::string& path, Json& meshes, std::size_t& messages, RunLog& log) {
    Result<LoadedMesh> loaded = load_file({path, options.input}, log);
    if (!loaded) return fail(path, loaded.error());
    const Result<Subject> subject = make_subject(std::move(*loaded), options.seeds);
    if (!subject) return fail(path, subject.error());
    Result<Figures> figures = measure_cpu(options, path, *subject);
    if (!figures) return failed(path, figures.error());
    if (const Result<void> drawn = add_device(options, *subject, *figures); !drawn) {
        return fail(path, drawn.error());
    }
    if (figures->gpu) messages += figures->gpu->validation_messages;
    figures->peak.update(peaks(figures->construct));
    if (options.json) {
        meshes.push_back(figures_json(options, *figures));
    } else {
        print_figures(options, *figures);
    }
    return done;
}

int run_bench(const BenchOptions& options, RunLog& log) {
    Json meshes = Json::array();
    std::size_t messages = 0;
    const int exit = for_each_input(
        options.paths, log, [&](std::size_t i) { return bench(options, options.paths[i], meshes, messages, log); });
    if (options.json && (exit == done || !meshes.empty()))
        print_json(Json{{"schema", 1}, {"meshes", std::move(meshes)}});
    return exit == done && messages != 0 ? int{check_failed} : exit;
}

}  // namespace

void add_bench(CLI::App& program, Action& action) {
    auto options = std::make_shared<BenchOptions>();
    CLI::App* command = program.add_subcommand("bench", "time construction, decoding and drawing beside other codecs");
    command->add_option("MESH", options->paths, "mesh files or .lr files; - is standard input")->required();
    add_input_options(*command, options->input, 400);
    allow_whole_numbers(command->add_option("--rounds", options->rounds, "measure everything N times"), 1, 1000)
        ->capture_default_str();
    allow_whole_numbers(command->add_option("--seeds", options->seeds, "start corners to try per component"), 1, 10000)
        ->capture_default_str();
    add_bits(*command, "--positions", options->positions, 1, kMostBenchPositions,
             "round positions to {} bits along the largest extent")
        ->capture_default_str();
    command->add_flag("--operators", options->operators,
                      "also time the corner operators of LR and of other structures");
    CLI::Option* resident =
        command->add_flag("--resident", options->resident, "also time them on mapped files with limited memory");
    command
        ->add_option("--scratch", options->limits.scratch,
                     "folder of the mapped files; default: the system's temporary folder")
        ->type_name("FOLDER")
        ->needs(resident);
    allow_words(command->add_option("--page", options->limits.page_kib,
                                    "read this much at a time, a power of two; 0: by the mesh's size"),
                {"0", "4", "8", "16", "32", "64", "128", "256", "512", "1024"})
        ->type_name("KIB")
        ->needs(resident);
    allow_whole_numbers(command->add_option("--sample", options->limits.sample, "visit N elements in random order"), 1,
                        100000000)
        ->capture_default_str()
        ->needs(resident);
    allow_numbers(
        command->add_option("--levels", options->limits.levels, "memory limits, as shares of the corner table's size"),
        0, 1000)
        ->type_name("A,B,...")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->needs(resident);
    options->gpu.add_options(*command);
    add_json(*command, options->json);
    auto rules = std::make_shared<OptionRules>(*command);
    rules->never_with({"--device", "--device-memory", "--validation"}, "--no-gpu");
    add_example(*command, "bench bunny.ply --rounds 3", "results.md");
    command->callback([options, rules, &action] {
        rules->check();
        action = [options](RunLog& log) { return run_bench(*options, log); };
    });
}

}  // namespace lacedring::app
