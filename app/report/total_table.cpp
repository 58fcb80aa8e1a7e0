#include "app/report/total_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/bench/measure.h"
#include "app/formats/formats.h"
#include "app/formats/whole_file.h"
#include "lrlab/rivals/compressors.h"
#include "lrlab/rivals/whole_mesh.h"

namespace lacedring::app {
namespace {

using Json = nlohmann::ordered_json;

double bits_per(std::size_t bytes, std::size_t elements) {
    return 8 * static_cast<double>(bytes) / static_cast<double>(elements);
}

TotalEntry entry_of(const char* name, std::span<const std::byte> bytes, bool random_access) {
    return {name, bytes.size(), zstd_size(bytes), brotli_size(bytes), random_access, {}};
}

void add_rival(TotalTable& table, const Mesh& mesh, const char* name, const Result<RivalMesh>& rival) {
    if (!rival) {
        table.absent.emplace_back(name, rival.error().message);
        return;
    }
    if (!rival->invalid.empty()) table.invalid = fmt::format("{}: {}", name, rival->invalid);
    TotalEntry& entry = table.entries.emplace_back(entry_of(name, rival->bytes, std::string_view(name) == "raw"));
    for (std::size_t i = 0; i < rival->largest_errors.size(); ++i)
        entry.errors.emplace_back(mesh.attributes[i].name, rival->largest_errors[i]);
}

/// Median of a figure over the tables that have it; empty if no table has it.
template <class Figure>
std::optional<double> median_of(std::span<const TotalTable> tables, Figure figure) {
    std::vector<double> values;
    for (const TotalTable& table : tables) {
        if (const std::optional<double> value = figure(table)) values.push_back(*value);
    }
    if (values.empty()) return {};
    return median(std::move(values));
}

std::string text_of(std::optional<std::size_t> bytes) {
    return bytes ? fmt::format("{}", *bytes) : "";
}

}  // namespace

const TotalEntry* TotalTable::find(std::string_view name) const {
    const auto found = std::find_if(entries.begin(), entries.end(), [&](const auto& e) { return e.name == name; });
    return found == entries.end() ? nullptr : &*found;
}

Result<TotalTable> make_total(const std::string& path, const Mesh& mesh, const Surface& surface, const RingChoice& ring,
                              const AttributeBits& bits, RunLog& log) {
    const Mesh joined = surface_mesh(mesh, surface);
    const Result<CornerTable> corners = build_corner_table(joined.indices, joined.vertex_count);
    if (!corners) return corners.error();
    TotalTable table;
    table.triangles = mesh.triangle_count() - corners->topology.degenerate;
    const Mesh whole{mesh.vertex_count, without_degenerate(mesh.indices), mesh.attributes};
    add_rival(table, whole, "raw", store_raw(whole));
    TotalEntry stored;
    for (const PackedProfile profile : {PackedProfile::small, PackedProfile::cache}) {
        const bool small = profile == PackedProfile::small;
        EncodeOptions options = encode_options(ring, Format::packed, mesh.triangle_count());
        options.profile = profile;
        const Result<WholeFile> file = make_file(mesh, surface, *corners, options, bits);
        if (!file) return file.error();
        if (const Result<LrFile> parsed = parse_lr(file->bytes); !parsed) table.invalid = parsed.error().message;
        table.vertices = file->file.vertex_count;
        table.copies = mesh.vertex_count;
        if (small) note_lossless(log, path, file->attributes);
        TotalEntry& entry = table.entries.emplace_back(entry_of(small ? "packed" : "packed_cache", file->bytes, true));
        for (const CompressedAttribute& a : file->attributes) entry.errors.emplace_back(a.name, a.largest_error);
        if (!small) continue;
        const std::vector<std::byte> bytes = serialize_lr(file->file, LrForm::stored);
        stored = entry_of("storage", bytes, false);
        const Result<LrFile> restored = parse_lr(bytes);
        if (!restored || serialize_lr(*restored) != file->bytes) table.invalid = "storage: restores to another file";
    }
    stored.errors = table.entries[table.entries.size() - 2].errors;
    table.entries.push_back(std::move(stored));
    add_rival(table, whole, "meshopt", encode_meshopt_mesh(whole, bits));
    add_rival(table, whole, "draco", encode_draco_mesh(whole, bits));
    if (!table.entries.front().zstd) table.absent.emplace_back("bytes_zstd", "built without libzstd");
    if (!table.entries.front().brotli) table.absent.emplace_back("bytes_brotli", "built without libbrotlienc");
    return table;
}

Json to_json(const TotalTable& table) {
    Json out = Json::object();
    for (const TotalEntry& entry : table.entries) {
        Json errors = Json::object();
        for (const auto& [name, error] : entry.errors) errors[name] = error;
        Json row = {{"bytes", entry.bytes},
                    {"bits_per_triangle", bits_per(entry.bytes, table.triangles)},
                    {"bits_per_vertex", bits_per(entry.bytes, table.vertices)}};
        if (entry.zstd) row["bytes_zstd"] = *entry.zstd;
        if (entry.brotli) row["bytes_brotli"] = *entry.brotli;
        row["random_access"] = entry.random_access;
        row["max_error"] = std::move(errors);
        out[entry.name] = std::move(row);
    }
    return out;
}

Json total_versions() {
    Json out = {{"meshoptimizer", meshopt_version()}};
    if (const std::string draco = draco_version(); !draco.empty()) out["draco"] = draco;
    return out;
}

void print_total(const std::string& path, const TotalTable& table) {
    print("{}: {} triangles, {}\n\n", path, table.triangles, vertices_text(table.vertices, table.copies));
    print("  {:<14}{:>11}{:>10}{:>13}{:>11}{:>11}{:>15}{:>20}\n", "format", "bytes", "bits/tri", "bits/vertex", "zstd",
          "brotli", "random access", "error of positions");
    for (const TotalEntry& entry : table.entries) {
        const auto position = std::find_if(entry.errors.begin(), entry.errors.end(),
                                           [](const auto& error) { return error.first == "POSITION"; });
        print("  {:<14}{:>11}{:>10.2f}{:>13.2f}{:>11}{:>11}{:>15}{:>20}\n", entry.name, entry.bytes,
              bits_per(entry.bytes, table.triangles), bits_per(entry.bytes, table.vertices), text_of(entry.zstd),
              text_of(entry.brotli), entry.random_access ? "yes" : "no",
              position == entry.errors.end() ? "" : fmt::format("{:.3g}", position->second));
    }
    for (const auto& [name, reason] : table.absent) print("  {:<14}absent: {}\n", name, reason);
    const std::string draco = draco_version();
    print("  raw has {} indices; meshoptimizer {}{}\n\n", table.copies <= 65536 ? "u16" : "u32", meshopt_version(),
          draco.empty() ? "" : "; Draco " + draco);
}

void print_medians(std::span<const TotalTable> tables) {
    std::string line;
    for (const char* name : {"raw", "packed", "packed_cache", "storage", "meshopt", "draco"}) {
        const std::optional<double> bits = median_of(tables, [&](const TotalTable& table) -> std::optional<double> {
            const TotalEntry* entry = table.find(name);
            if (entry == nullptr) return {};
            return bits_per(entry->bytes, table.vertices);
        });
        if (bits) line += fmt::format("{}{} {:.2f}", line.empty() ? "" : ", ", name, *bits);
    }
    const auto add_ratio = [&](const char* what, auto size) {
        std::size_t smaller = 0;
        const std::optional<double> ratio = median_of(tables, [&](const TotalTable& table) -> std::optional<double> {
            const TotalEntry *packed = table.find("packed"), *meshopt = table.find("meshopt");
            if (packed == nullptr || meshopt == nullptr || !size(*packed) || !size(*meshopt)) return {};
            smaller += *size(*packed) < *size(*meshopt) ? 1 : 0;
            return static_cast<double>(*size(*meshopt)) / static_cast<double>(*size(*packed));
        });
        if (ratio) line += fmt::format("; {} {:.2f} (packed is smaller on {})", what, *ratio, smaller);
    };
    add_ratio("meshopt over packed", [](const TotalEntry& entry) { return std::optional(entry.bytes); });
    add_ratio("both after brotli", [](const TotalEntry& entry) { return entry.brotli; });
    print("median of {} meshes, bits/vertex: {}\n", tables.size(), line);
}

}  // namespace lacedring::app
