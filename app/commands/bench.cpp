// lacedring bench MESH...: construction, decoding and drawing, each beside a rival in the same run.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "app/bench/measure.h"
#include "app/bench/operators.h"
#include "app/bench/resident.h"
#include "app/bench/section.h"
#include "app/bench/unpack.h"
#include "app/bench/vertices.h"
#include "app/cli/option_rules.h"
#include "app/cli/progress.h"
#include "app/commands/commands.h"
#include "lacedring/lacedring.hpp"
#include "lacedring/ring.hpp"
#include "lacedring/streams.hpp"
#include "lacedring/topology.hpp"
#include "lrlab/rivals/codecs.h"
#include "lrlab/rivals/limit.h"
#include "lrlab/rivals/squad.h"
#include "lrlab/rivals/strips.h"
#ifdef LACEDRING_GPU
#include "app/bench/gpu.h"
#include "app/cli/gpu_options.h"
#include "renderer/vk/device_error.h"
#endif

namespace lacedring::app {
namespace {

using Json = nlohmann::ordered_json;

struct BenchOptions {
    std::vector<std::string> paths;
    InputOptions input;
    int rounds = 5;
    std::uint32_t seeds = 1;
    std::uint32_t positions = kBenchPositions;  ///< bits
    bool no_gpu = false;
    bool operators = false;
    bool resident = false;
    ResidentOptions limits;
#ifdef LACEDRING_GPU
    gpu::ContextOptions context;
#endif
    bool json = false;
};

constexpr std::uint32_t kHybridPeriod = 32;  // of Figure 8's middle picture

#ifdef LACEDRING_GPU
void add_costs(Json& draw, const GpuFigures& figures) {
    for (std::size_t i = 0; i < figures.draw.size(); ++i) {
        Json& entry = draw[figures.draw[i].name];
        entry["connectivity_bytes"] = figures.cost[i].connectivity_bytes;
        entry["connectivity_bytes_read"] = figures.cost[i].bytes_read;
        if (figures.cost[i].vertex_invocations) entry["vertex_invocations"] = *figures.cost[i].vertex_invocations;
    }
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
#endif

/// Structures that disagree on a result are a check that failed, and no wrong usage.
int failed(const std::string& path, const Error& error) {
    const int code = fail(path, error);
    return error.code == ErrorCode::invalid_argument ? static_cast<int>(check_failed) : code;
}

/// One mesh: its figures printed, or put into `meshes`. Returns an Exit.
int bench(const BenchOptions& options, const std::string& path, Json& meshes, [[maybe_unused]] std::size_t& messages,
          RunLog& log) {
    const Result<LoadedMesh> loaded = load_file({path, options.input}, log);
    if (!loaded) return fail(path, loaded.error());
    // Connectivity is the surface's, the rivals' too; what is drawn has its copies.
    const Mesh joined = surface_mesh(loaded->mesh, loaded->surface);
    const Mesh* mesh = &joined;
    const auto build = [&] { return build_corner_table(mesh->indices, mesh->vertex_count); };
    const Result<CornerTable> table = build();
    if (!table) return fail(path, table.error());
    const auto triangles = static_cast<double>(mesh->triangle_count());
    const Counts counts{triangles, static_cast<double>(mesh->vertex_count)};
    const RingOptions ring_choice{options.seeds, 1};
    const Rings rings = expand_rings(*table, ring_choice);
    const Result<EncodedLean> lean = encode_lean(*table, rings);
    if (!lean) return fail(path, lean.error());
    const Result<LeanView> view = view_lean(lean->words);
    if (!view) return fail(path, view.error());

    Section construct{"construct", {}};
    construct.candidates.push_back({"corner_table", [&] { (void)build(); }, {}, {}});
    construct.candidates.push_back({"ring", [&] { expand_rings(*table, ring_choice); }, {}, {}});
    construct.candidates.push_back({"lean_encode", [&] { (void)encode_lean(*table, rings); }, {}, {}});
    const auto whole = [&] {
        const Result<CornerTable> t = build();
        (void)encode_lean(*t, expand_rings(*t, ring_choice));
    };
    construct.candidates.push_back({"lean", whole, {}, {}});
    Json absent = Json::object();
    const auto strips = [&] { (void)make_restart_strip(mesh->indices, mesh->vertex_count); };
    const Result<void> orders = check_valences(mesh->indices, mesh->vertex_count);
    if (orders) {
        construct.candidates.push_back({"strips", strips, {}, {}});
    } else {
        absent["strips"] = orders.error().message;
    }
    // From a corner table of a pseudo-manifold to the tables, ring included.
    CornerTable split = *table;
    split_fans(split);
    const auto make_lr = [&](std::uint32_t k) {
        return build_lr(split, expand_rings(split, {options.seeds, 1, k, true}));
    };
    const auto hybrid = [&] { expand_rings(*table, {options.seeds, 1, kHybridPeriod}); };
    const auto compact = [&] {
        if (const auto lr = make_lr(kHybridPeriod)) (void)build_compact_lr(lr->view());
    };
    construct.candidates.push_back({"ring_hybrid", hybrid, {}, {}});
    construct.candidates.push_back({"lr", [&] { (void)make_lr(0); }, {}, {}});
    construct.candidates.push_back({"lr_compact", compact, {}, {}});
    construct.candidates.push_back({"squad", [&] { (void)build_squad(split); }, {}, {}});
    // The optimiser alone, at its default, and from index list to packed stream with it.
    const OptimizeOptions optimize{.cost = kPackedRingCost};
    const auto whole_packed = [&] {
        const Result<CornerTable> t = build();
        (void)encode_packed(*t, optimize_rings(*t, expand_rings(*t, ring_choice), optimize));
    };
    construct.candidates.push_back({"optimize", [&] { (void)optimize_rings(*table, rings, optimize); }, {}, {}});
    construct.candidates.push_back({"packed_encode", [&] { (void)encode_packed(*table, rings); }, {}, {}});
    construct.candidates.push_back(
        {"packed_cache_encode", [&] { (void)encode_packed(*table, rings, PackedProfile::cache); }, {}, {}});
    construct.candidates.push_back({"packed", whole_packed, {}, {}});
    measure(construct, options.rounds);

    Section decode{"decode_cpu", {}};
    std::vector<std::uint32_t> indices(std::size_t{3} * view->slots()), copy(indices.size());
    decode.candidates.push_back({"lean", [&] { decode_lean(*view, indices); }, {}, {}});
    decode.candidates.push_back({"copy", [&] { std::copy(indices.begin(), indices.end(), copy.begin()); }, {}, {}});
    const Rings optimised = optimize_rings(*table, rings, optimize);
    const Result<EncodedPacked> small = encode_packed(*table, optimised),
                                cache = encode_packed(*table, optimised, PackedProfile::cache);
    if (!small || !cache) return fail(path, small ? cache.error() : small.error());
    const Result<PackedView> packed = view_packed(small->words), packed_cache = view_packed(cache->words);
    if (!packed || !packed_cache) return fail(path, packed ? packed_cache.error() : packed.error());
    std::vector<std::uint32_t> unpacked(std::size_t{3} * packed->triangles), decoded(unpacked.size());
    std::vector<std::uint32_t> proper;  // the rival takes no degenerate triangles
    for (const std::uint32_t t : small->triangle_order) {
        for (std::size_t k = 0; k < 3; ++k) proper.push_back(mesh->indices[std::size_t{3} * t + k]);
    }
    const Result<CodedIndices> codec = encode_meshopt_indices(proper, mesh->vertex_count);
    decode.candidates.push_back({"packed", [&] { decode_packed(*packed, unpacked); }, {}, {}});
    decode.candidates.push_back({"packed_2_threads", [&] { decode_packed(*packed, unpacked, 2); }, {}, {}});
    decode.candidates.push_back({"packed_cache", [&] { decode_packed(*packed_cache, unpacked); }, {}, {}});
    if (codec) {
        decode.candidates.push_back(
            {"meshopt_index_codec", [&] { (void)decode_meshopt_indices(codec->bytes, decoded); }, {}, {}});
    } else {
        absent["meshopt_index_codec"] = codec.error().message;
    }
    const VertexOptions positions = position_options(options.positions);
    Result<VertexBench> vertices =
        vertex_candidates(*mesh, positions, small->vertex_order,
                          codec ? std::span<const std::uint32_t>(codec->order) : std::span<const std::uint32_t>());
    if (!vertices) return failed(path, vertices.error());
    for (const auto& [name, reason] : vertices->absent) absent[name] = reason;
    std::ranges::move(vertices->candidates, std::back_inserter(decode.candidates));
    EncodedSeams seams;
    Result<SeamView> seam_view = SeamView{};
    if (loaded->surface.has_seams()) {
        Result<EncodedSeams> encoded =
            encode_seams(as_encoded(EncodedPacked(*small)), loaded->mesh.indices, loaded->surface.vertex_of);
        if (!encoded) return failed(path, encoded.error());
        seams = std::move(*encoded);
        seam_view = view_seams(seams.words, packed->triangles, packed->vertices);
        if (!seam_view) return failed(path, seam_view.error());
        decode.candidates.push_back({"packed_seams",
                                     [&] {
                                         decode_packed(*packed, unpacked);
                                         decode_seams(*seam_view, unpacked, decoded);
                                     },
                                     {},
                                     {}});
    }
    measure(decode, options.rounds * 3);

    const Section unpack = measure_unpacking("unpack", unpack_candidates(loaded->mesh), options.rounds * 3, absent, "");
    const Section restore = measure_unpacking(
        "restore", restore_candidates(*mesh, as_encoded(EncodedPacked(*small)), {.positions = options.positions}),
        options.rounds * 3, absent, "_restore");

    std::vector<OperatorFigures> operators;
    Json operators_json = Json::object();
    if (options.operators) {
        Result<OperatorBench> measured = measure_operators(*mesh, *table, options.rounds);
        if (!measured) return failed(path, measured.error());
        operators = std::move(measured->structures);
        for (const auto& [name, reason] : measured->absent) absent[name + "_operators"] = reason;
        for (const OperatorFigures& structure : operators) {
            Json& entry = operators_json[structure.structure];
            for (const auto& row : structure.rows) entry[row.name] = {{"ns_per_op", row.ns_per_op()}};
        }
    }

    std::optional<ResidentFigures> resident;
    if (options.resident) {
        ResidentOptions limits = options.limits;
        limits.rounds = options.rounds;
        Result<ResidentFigures> measured = measure_resident(*mesh, *table, limits);
        if (!measured) return failed(path, measured.error());
        resident = std::move(*measured);
    }

    Section decode_gpu{"decode_gpu (wall)", {}};
    Json draw = Json::object();
    std::string device, gpu_skipped = "built without Vulkan";
    Json peak = Json::object();
#ifdef LACEDRING_GPU
    Result<GpuFigures> gpu = Error{gpu::kNoDevice, ""};
    if (options.no_gpu) {
        gpu_skipped = "--no-gpu";
    } else if (gpu = measure_gpu(*loaded, positions, options.context, options.rounds); gpu) {
        gpu_skipped.clear();
        device = gpu->device;
        decode_gpu.candidates = gpu->decode;
        draw = to_json({"", gpu->draw}, counts);
        add_costs(draw, *gpu);
        peak["gpu"] = gpu->device_bytes;
        for (const auto& [name, reason] : gpu->absent) absent[name] = reason;
        messages += gpu->validation_messages;
    } else if (gpu.error().code == gpu::kNoDevice && !asks_for_device(options.context)) {
        gpu_skipped = gpu.error().message;
    } else {
        return fail(path, gpu.error());
    }
#endif
    {
        ProgressBar bar("peak memory", 3);
        const auto add_peak = [&](const char* name, const std::function<void()>& work) {
            peak[name] = peak_bytes(work);
            bar.step();
        };
        add_peak("lean", whole);
        add_peak("packed", whole_packed);
        if (orders) add_peak("strips", strips);
    }
    const Json construct_ratio = construct.ratio("strips", "lean"),
               decode_cpu_ratio = decode.ratio("meshopt_vertex_codec", "vertices"),
               unpack_ratio = unpack.ratio("draco", "lacedring"), restore_ratio = restore.ratio("draco", "lacedring"),
               arrays_ratio = restore.ratio("draco", "lacedring_arrays"),
               decode_gpu_ratio = decode_gpu.ratio("packed_vertices", "packed");
    if (options.json) {
        meshes.push_back({{"file", path},
                          {"triangles", mesh->triangle_count()},
                          {"construct", to_json(construct, counts)},
                          {"construct_ratio", construct_ratio},
                          {"position_bits", options.positions},
                          {"decode_cpu", to_json(decode, counts)},
                          {"decode_cpu_ratio", decode_cpu_ratio},
                          {"unpack", to_json(unpack, counts)},
                          {"unpack_ratio", unpack_ratio},
                          {"restore", to_json(restore, counts)},
                          {"restore_ratio", restore_ratio},
                          {"decode_gpu", to_json(decode_gpu, counts)},
                          {"decode_gpu_ratio", decode_gpu_ratio},
                          {"draw", draw},
                          {"device", device},
                          {"gpu_skipped", gpu_skipped},
                          {"absent", absent},
                          {"operators", operators_json},
                          {"resident", resident ? to_json(*resident) : Json::object()},
                          {"peak_bytes", peak}});
        return done;
    }
    print("{}: {} triangles; medians of {} rounds\n", path, mesh->triangle_count(), options.rounds);
    for (const Section& section : {construct, decode, unpack, restore, decode_gpu}) {
        if (section.candidates.empty()) continue;
        print("  {}\n", section.name);
        for (const Candidate& c : section.candidates) {
            const double million = 1e6 * c.median();
            print("    {:<24}{:>11.3f} ms{:>10.1f} {}\n", c.name, c.median() * 1e3,
                  (c.vertices ? counts.vertices : triangles) / million, c.vertices ? "Mvert/s" : "Mtri/s");
        }
    }
#ifdef LACEDRING_GPU
    if (gpu) print_draw(*gpu, triangles);
#endif
    print("  {}\n", gpu_skipped.empty() ? "drawn at 1280x720 on " + device : "not drawn: " + gpu_skipped);
    if (!operators.empty()) {
        print("  operators, ns each{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "refs/tri", "c.v", "c.o, c.s", "valence",
              "normal", "contour");
    }
    for (const OperatorFigures& structure : operators) {
        print("    {:<16}{:>10.3f}", structure.structure, structure.references_per_triangle);
        for (const auto& row : structure.rows) print("{:>10.2f}", row.ns_per_op());
        print("\n");
    }
    if (resident) print_resident(*resident);
    const auto print_ratio = [](const Json& ratio, std::string_view before, std::string_view after) {
        if (ratio.front().is_number()) print("  {} {:.2f} {}\n", before, ratio.front().get<double>(), after);
    };
    print_ratio(construct_ratio, "lean is built", "times as fast as strips");
    print_ratio(decode_cpu_ratio, fmt::format("positions of {} bits decode", options.positions),
                "times as fast as by meshoptimizer's vertex codec");
    print_ratio(unpack_ratio, "the whole mesh is unpacked", "times as fast as by Draco");
    print_ratio(restore_ratio,
                fmt::format("a file in storage form takes {:.0f} ns a triangle to restore,",
                            1e9 * restore.median("lacedring") / triangles),
                "times as fast as Draco decodes its smallest");
    print_ratio(arrays_ratio, "straight to indices and positions,", "times as fast");
    print_ratio(decode_gpu_ratio, "on the device, indices and positions take", "times as long as indices alone");
    for (const auto& [name, reason] : absent.items()) {
        print("  {} absent: {}\n", name, reason.get<std::string>());
    }
    print("  peak memory beyond the input\n");
    for (const auto& [name, bytes] : peak.items()) {
        print("    {:<24}{:>11.1f} MB{:>10.1f} bytes a triangle\n", name, bytes.get<double>() / 1e6,
              bytes.get<double>() / triangles);
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
    CLI::App* command = program.add_subcommand("bench", "time construction, decoding and drawing beside rivals");
    command->add_option("MESH", options->paths, "mesh files")->required();
    add_input_options(*command, options->input, 400);
    command->add_option("--rounds", options->rounds, "how often each is run")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_option("--seeds", options->seeds, "seed corners per component")
        ->check(CLI::Range(1, 10000))
        ->capture_default_str();
    add_bits(*command, "--positions", options->positions, 1, kMostBenchPositions,
             "bits along the largest extent of the positions that are decoded");
    command->add_flag("--operators", options->operators,
                      "also time the corner operators on LR and on what it is compared with");
    CLI::Option* resident = command->add_flag("--resident", options->resident,
                                              "also time them with resident memory limited, on memory-mapped files");
    command->add_option("--scratch", options->limits.scratch, "folder for the memory-mapped files; else the system's")
        ->needs(resident);
    command
        ->add_option("--page", options->limits.page_kib,
                     "KiB that are read at a time; 0: by the mesh's size, mostly 32")
        ->check(CLI::IsMember(std::set<std::size_t>{0, 4, 8, 16, 32, 64, 128, 256, 512, 1024}))
        ->needs(resident);
    command->add_option("--sample", options->limits.sample, "elements that a random-order visit takes")
        ->check(CLI::Range(1, 100000000))
        ->capture_default_str()
        ->needs(resident);
    command->add_option("--levels", options->limits.levels, "limits, as shares of the corner table's size, with commas")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::Range(0.0, 1000.0))
        ->needs(resident);
#ifdef LACEDRING_GPU
    command->add_flag("--no-gpu", options->no_gpu, "leave the device out");
    add_device_options(*command, options->context);
#endif
    command->add_flag("--json", options->json, "one JSON document on standard output");
    auto rules = std::make_shared<OptionRules>(*command);
    rules->never_with({"--device", "--device-memory", "--validation"}, "--no-gpu");
    command->callback([options, rules, &action] {
        rules->check();
        action = [options](RunLog& log) { return run_bench(*options, log); };
    });
}

}  // namespace lacedring::app
