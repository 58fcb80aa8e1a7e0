#include "app/cli/input.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <utility>

#include "app/cli/command.h"
#include "app/cli/help.h"
#include "app/cli/values.h"
#include "lacedring/file.hpp"
#include "lacedring/mesh_files.hpp"

namespace lacedring::app {
namespace {

constexpr std::pair<const char*, MeshFormat> kFormats[] = {{"gltf", MeshFormat::gltf}, {"glb", MeshFormat::gltf},
                                                           {"obj", MeshFormat::obj},   {"off", MeshFormat::off},
                                                           {"ply", MeshFormat::ply},   {"stl", MeshFormat::stl}};

MeshFormat format_named(const std::string& name) {
    for (const auto& [known, format] : kFormats) {
        if (name == known) return format;
    }
    return MeshFormat::any;
}

std::string listed(const std::vector<std::string>& items) {
    std::string out;
    for (const std::string& item : items) out += (out.empty() ? "" : ", ") + item;
    return out;
}

double bytes_of(const Mesh& mesh, std::uint32_t triangle_bytes) {
    double bytes = static_cast<double>(mesh.triangle_count()) * (12.0 + triangle_bytes);
    for (const Attribute& attribute : mesh.attributes) bytes += static_cast<double>(attribute.data.size());
    return bytes;
}

/// Checks the memory limit for a decoded .lr file: parse_lr has checked it only for the streams.
Result<void> check_memory(const Mesh& mesh, const InputOptions& options) {
    const double bytes = bytes_of(mesh, options.triangle_bytes);
    constexpr double kMebibyte = 1 << 20;
    if (options.max_memory == 0 || bytes <= static_cast<double>(options.max_memory) * kMebibyte) return {};
    return Error{ErrorCode::memory_limit, fmt::format("{} triangles take about {:.0f} MiB, and {} MiB are allowed",
                                                      mesh.triangle_count(), bytes / kMebibyte, options.max_memory)};
}

/// Reads a mesh without welding it. `list`, if not null, gets the primitives of a glTF that has several.
Result<LoadedMesh> read(const MeshInput& input, RunLog& log, PrimitiveList* list) {
    const InputOptions& options = input.options;
    const auto bytes = read_input(input.path, options, log);
    if (!bytes) return bytes.error();
    if (is_lr(*bytes) && options.format.empty()) {
        Result<LrContents> contents = list_lr(*bytes);
        if (!contents) return contents.error();
        const Result<LrFile> file = parse_lr(*bytes, options.max_memory << 20, thread_count(options.threads));
        if (!file) return file.error();
        Surface surface;
        Result<Mesh> mesh = decode_lr(*file, &surface);
        if (!mesh) return mesh.error();
        LoadedMesh out{std::move(*mesh), std::move(surface), std::move(*contents), {}};
        if (const Result<void> room = check_memory(out.mesh, options); !room) return room.error();
        return out;
    }
    ReadReport report;
    ReadOptions how = read_options(options);
    const std::string name = input.path == "-" ? "" : input.path;
    Materials materials;
    Result<Mesh> mesh = read_mesh(*bytes, name, how, &report, options.materials ? &materials : nullptr);
    for (std::filesystem::path& file : report.files) log.read(std::move(file));
    if (!mesh) return mesh.error();
    if (!report.left_out.empty()) {
        const bool hint = options.writes && report.format == MeshFormat::gltf;
        log.note(input_name(input.path), (options.writes ? "not kept: " : "not used here: ") + listed(report.left_out) +
                                             (hint ? " (lacedring pack keeps scenes)" : ""));
    }
    if (list != nullptr && report.primitives > 1) {
        // Commands process primitives one by one, in the memory that was counted for the joined mesh.
        how.triangle_bytes = 0;
        how.held_bytes = static_cast<std::uint64_t>(bytes_of(*mesh, options.triangle_bytes));
        Result<PrimitiveList> primitives = read_primitives(*bytes, name, how);
        if (!primitives) return primitives.error();
        *list = std::move(*primitives);
    }
    return LoadedMesh{std::move(*mesh), {}, {}, std::move(report.streams), std::move(materials)};
}

/// Joins vertices cut apart by seams, unless the file came with its surface.
SurfaceReport join_seams(Mesh& mesh, Surface& surface, const InputOptions& options) {
    SurfaceReport report;
    if (surface.has_seams() && options.tolerance == 0) return report;
    surface = find_surface(mesh, options.tolerance, &report);
    if (report.moved > 0) move_to_surface(mesh, surface);
    if (!options.keep_vertices) mesh = merge_copies(mesh, surface);
    return report;
}

/// Welds as the options say.
SurfaceReport weld_mesh(Mesh& mesh, Surface& surface, const InputOptions& options) {
    if (options.weld.empty() || options.weld == "position") return join_seams(mesh, surface, options);
    if (options.weld == "attributes") mesh = weld(mesh, Weld::attributes);
    surface = {mesh.vertex_count, {}};
    return {};
}

void note_moves(const SurfaceReport& report, const std::string& path, RunLog& log) {
    const std::string name = input_name(path);
    if (report.largest_move > 0) {
        log.note(name, fmt::format("--weld-tolerance: {} vertices move, by {:.3g} at most", report.moved,
                                   report.largest_move));
    } else if (report.moved > 0) {
        log.note(name,
                 fmt::format("{} vertices with -0 get the 0 of the vertex that they are joined with", report.moved));
    }
}

/// Shortens a mesh's name. It is stored with each of the mesh's primitives, and the file decides its length.
std::string shortened(const std::string& name) {
    constexpr std::size_t kMost = 80;
    if (name.size() <= kMost) return name;
    std::size_t end = kMost;
    while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xc0U) == 0x80U) --end;  // cut between UTF-8 characters
    return name.substr(0, end) + "...";
}

}  // namespace

void add_input_options(CLI::App& command, InputOptions& options, std::uint32_t triangle_bytes) {
    const OptionGroup group(command, "Reading meshes");
    options.triangle_bytes = triangle_bytes;
    CLI::Option* weld = allow_words(command.add_flag("--weld{attributes}", options.weld,
                                                     "join vertices only where all attributes are equal; position, the "
                                                     "default, joins all vertices at one place"),
                                    {"attributes", "position"});
    weld->option_text("[=attributes|position]");
    CLI::Option* none = command.add_flag("--no-weld{none}", options.weld, "join no vertices");
    none->excludes(weld);
    const CLI::Option* tolerance =
        allow_numbers_between(command.add_option("--weld-tolerance", options.tolerance,
                                                 "join vertices that are at most this far apart, in the mesh's units"),
                              0, kNoLimit)
            ->type_name("DISTANCE")
            ->excludes(none);
    command.parse_complete_callback([&options, tolerance] {
        if (tolerance->count() == 0 || options.weld != "attributes") return;
        throw CLI::ValidationError("--weld-tolerance", "has no effect with --weld, which moves no vertex");
    });
    std::vector<std::string> formats;
    for (const auto& [name, format] : kFormats) formats.emplace_back(name);
    allow_words(command.add_option("--input-format", options.format, "read the input as {}"), formats);
    add_allow_outside(command, options);
    add_max_memory(command, options);
}

void add_allow_outside(CLI::App& command, InputOptions& options) {
    command.add_flag("--allow-outside", options.allow_outside, "let a glTF name files outside its folder");
}

void add_max_memory(CLI::App& command, InputOptions& options) {
    allow_whole_numbers(command.add_option("--max-memory", options.max_memory,
                                           "memory for a mesh; default: 512, or 128 times the file if larger"),
                        1, kMostMebibytes)
        ->type_name("MIB");
}

ReadOptions read_options(const InputOptions& options) {
    return {.format = format_named(options.format),
            .allow_outside = options.allow_outside,
            .max_bytes = options.max_memory << 20,
            .triangle_bytes = options.triangle_bytes};
}

std::string input_name(const std::string& path) {
    return path == "-" ? "standard input" : path;
}

Result<std::vector<std::byte>> read_input(const std::string& path, const InputOptions& options, RunLog& log) {
    constexpr std::uint64_t kMostFromPipe = std::uint64_t{4} << 30;  // a pipe may never end
    const std::uint64_t limit = options.max_memory << 20;
    if (path == "-") return read_descriptor(STDIN_FILENO, limit != 0 ? limit : kMostFromPipe);
    log.read(path);
    Result<std::vector<std::byte>> bytes = read_file(path, limit != 0 ? limit : UINT64_MAX);
    if (bytes || bytes.error().code != ErrorCode::too_large) return bytes;
    return Error{ErrorCode::memory_limit, bytes.error().message};
}

Result<LoadedMesh> load_file(const MeshInput& input, RunLog& log) {
    Result<LoadedMesh> loaded = read(input, log, nullptr);
    if (loaded) note_moves(weld_mesh(loaded->mesh, loaded->surface, input.options), input.path, log);
    return loaded;
}

std::string LoadedPrimitive::label() const {
    return fmt::format("mesh {}, primitive {}{}", mesh, number, name.empty() ? "" : " (" + printable(name) + ")");
}

Result<LoadedScene> load_scene(const MeshInput& input, RunLog& log) {
    PrimitiveList list;
    Result<LoadedMesh> joined = read(input, log, &list);
    if (!joined) return joined.error();
    note_moves(weld_mesh(joined->mesh, joined->surface, input.options), input.path, log);
    LoadedScene scene{std::move(*joined), {}, std::move(list.placed)};
    std::vector<std::size_t> copies(list.mesh_names.size());
    for (const PlacedMesh& placed : scene.placed) ++copies[placed.mesh];
    for (Primitive& from : list.primitives) {
        LoadedPrimitive to{from.mesh, from.number,       shortened(list.mesh_names[from.mesh]),
                           from.mode, copies[from.mesh], std::move(from.geometry),
                           {}};
        weld_mesh(to.geometry, to.surface, input.options);
        scene.primitives.push_back(std::move(to));
    }
    return scene;
}

Result<CornerTable> surface_table(const LoadedMesh& loaded) {
    if (!loaded.surface.has_seams()) return build_corner_table(loaded.mesh.indices, loaded.mesh.vertex_count);
    const Mesh surface = surface_mesh(loaded.mesh, loaded.surface);
    return build_corner_table(surface.indices, surface.vertex_count);
}

}  // namespace lacedring::app
