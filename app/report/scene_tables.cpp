#include "app/report/scene_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/cli/progress.h"
#include "app/formats/formats.h"
#include "app/formats/scene_check.h"
#include "app/report/lr_contents.h"

namespace lacedring::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostRows = 24;  // in one table

const char* mode_name(PrimitiveMode mode) {
    return mode == PrimitiveMode::triangles ? "triangles" : mode == PrimitiveMode::strip ? "strip" : "fan";
}

/// Shortens a name to `width` columns. It counts bytes, so names with non-ASCII characters come out narrower.
std::string fitted(const std::string& name, std::size_t width) {
    const std::string text = printable(name);
    return text.size() <= width ? text : text.substr(0, width - 3) + "...";
}

void tell_of_more(std::size_t rows) {
    if (rows > kMostRows) print("    and {} more (all of them with --json)\n", rows - kMostRows);
}

struct SceneSum {
    std::size_t triangles = 0, placed_triangles = 0, vertices = 0, copies = 0, placed = 0;
};

SceneSum sum_of(const LoadedScene& scene) {
    SceneSum sum;
    for (const LoadedPrimitive& primitive : scene.primitives) {
        sum.triangles += primitive.geometry.triangle_count();
        sum.placed_triangles += primitive.geometry.triangle_count() * primitive.placed;
        sum.vertices += primitive.surface.vertex_count;
        sum.copies += primitive.geometry.vertex_count;
        sum.placed += primitive.placed;
    }
    return sum;
}

double bits_each(std::size_t bytes, std::size_t triangles) {
    return 8 * static_cast<double>(bytes) / static_cast<double>(std::max<std::size_t>(1, triangles));
}

Json formats_to_json(const std::vector<FormatBytes>& formats, std::size_t triangles) {
    Json out = Json::object();
    for (const FormatBytes& format : formats) {
        out[format.name] = {{"bytes", format.bytes},
                            {"seam_bytes", format.seams},
                            {"bits_per_triangle", bits_each(format.bytes, triangles)}};
    }
    return out;
}

/// Adds the sizes in `more` to `sum`; removes formats from `sum` that `more` lacks.
void add_formats(std::vector<FormatBytes>& sum, const std::vector<FormatBytes>& more) {
    std::erase_if(sum, [&more](FormatBytes& format) {
        const auto other = std::ranges::find(more, format.name, &FormatBytes::name);
        if (other == more.end()) return true;
        format.bytes += other->bytes;
        format.seams += other->seams;
        return false;
    });
}

}  // namespace

Json primitives_to_json(const LoadedScene& scene) {
    Json out = Json::array();
    for (const LoadedPrimitive& primitive : scene.primitives) {
        Json attributes = Json::array();
        for (const Attribute& a : primitive.geometry.attributes) {
            attributes.push_back({{"name", a.name}, {"type", type_name(a.type)}, {"components", a.components}});
        }
        out.push_back({{"mesh", primitive.mesh},
                       {"primitive", primitive.number},
                       {"name", primitive.name},
                       {"mode", mode_name(primitive.mode)},
                       {"triangles", primitive.geometry.triangle_count()},
                       {"vertices", primitive.surface.vertex_count},
                       {"copies", primitive.geometry.vertex_count},
                       {"placed", primitive.placed},
                       {"attributes", std::move(attributes)}});
    }
    return out;
}

Json sum_to_json(const LoadedScene& scene) {
    const SceneSum sum = sum_of(scene);
    return {{"primitives", scene.primitives.size()},
            {"triangles", sum.triangles},
            {"placed_triangles", sum.placed_triangles},
            {"vertices", sum.vertices},
            {"copies", sum.copies}};
}

void print_primitives(const LoadedScene& scene) {
    print("  {} primitives, joined above\n", scene.primitives.size());
    print("    {:>5}{:>6}  {:<20} {:<9}{:>11}{:>11}{:>11}{:>8}  attributes\n", "mesh", "prim.", "name", "mode",
          "triangles", "vertices", "copies", "placed");
    const std::size_t rows = std::min(scene.primitives.size(), kMostRows);
    for (std::size_t i = 0; i < rows; ++i) {
        const LoadedPrimitive& primitive = scene.primitives[i];
        std::string attributes;
        for (const Attribute& a : primitive.geometry.attributes) {
            attributes += (attributes.empty() ? "" : ", ") + printable(a.name);
        }
        print("    {:>5}{:>6}  {:<20} {:<9}{:>11}{:>11}{:>11}{:>8}  {}\n", primitive.mesh, primitive.number,
              fitted(primitive.name, 20), mode_name(primitive.mode), primitive.geometry.triangle_count(),
              primitive.surface.vertex_count, primitive.geometry.vertex_count, primitive.placed, attributes);
    }
    tell_of_more(scene.primitives.size());
    const SceneSum sum = sum_of(scene);
    print("    {:<42}{:>11}{:>11}{:>11}{:>8}  {} triangles where they are placed\n", "sum", sum.triangles, sum.vertices,
          sum.copies, sum.placed, sum.placed_triangles);
}

Result<PrimitiveSizes> measure_primitives(const LoadedScene& scene, const RingChoice& choice, bool paper) {
    PrimitiveSizes out;
    ProgressBar bar("primitives", scene.primitives.size());
    for (const LoadedPrimitive& primitive : scene.primitives) {
        PrimitiveSizes::Row row{&primitive, 0, {}};
        const Result<FormatSet> set = make_formats(primitive.geometry, primitive.surface, choice, paper, {}, true);
        if (!set) return Error{set.error().code, primitive.label() + ": " + set.error().message};
        row.triangles = set->report.triangles;
        for (const MeasuredFormat& format : set->formats) {
            if (!format.invalid.empty() && out.invalid.empty()) {
                out.invalid = fmt::format("{}: {}: {}", primitive.label(), format.name, format.invalid);
            }
            row.formats.push_back({format.name, format.bytes, format.seam_bytes});
        }
        out.triangles += row.triangles;
        if (out.rows.empty()) {
            out.sum = row.formats;
        } else {
            add_formats(out.sum, row.formats);
        }
        out.rows.push_back(std::move(row));
        bar.step();
    }
    return out;
}

void add_primitive_sizes(const PrimitiveSizes& sizes, Json& mesh) {
    mesh["primitives"] = Json::array();
    for (const PrimitiveSizes::Row& row : sizes.rows) {
        mesh["primitives"].push_back({{"mesh", row.primitive->mesh},
                                      {"primitive", row.primitive->number},
                                      {"name", row.primitive->name},
                                      {"triangles", row.triangles},
                                      {"placed", row.primitive->placed},
                                      {"formats", formats_to_json(row.formats, row.triangles)}});
    }
    mesh["sum"] = {{"triangles", sizes.triangles}, {"formats", formats_to_json(sizes.sum, sizes.triangles)}};
}

void print_primitive_sizes(const PrimitiveSizes& sizes) {
    constexpr std::size_t kWidth = 18;
    print("  {} primitives, each by itself, bits/tri\n", sizes.rows.size());
    print("    {:>5}{:>6}  {:<20}{:>11}{:>8}", "mesh", "prim.", "name", "triangles", "placed");
    std::vector<std::string> names;
    for (const PrimitiveSizes::Row& row : sizes.rows) {
        for (const FormatBytes& format : row.formats) {
            if (std::ranges::find(names, format.name) == names.end()) names.push_back(format.name);
        }
    }
    for (const std::string& name : names) print("{:>{}}", name, kWidth);
    const auto print_cells = [&](const std::vector<FormatBytes>& formats, const auto& text) {
        for (const std::string& name : names) {
            const auto format = std::ranges::find(formats, name, &FormatBytes::name);
            print("{:>{}}", format == formats.end() ? "" : text(*format), kWidth);
        }
        print("\n");
    };
    print("\n");
    const auto bits_of = [](std::size_t triangles) {
        return [triangles](const FormatBytes& format) {
            return fmt::format("{:.2f}{}", bits_each(format.bytes, triangles),
                               format.seams == 0 ? "" : fmt::format(" +{:.2f}", bits_each(format.seams, triangles)));
        };
    };
    for (std::size_t i = 0; i < std::min(sizes.rows.size(), kMostRows); ++i) {
        const PrimitiveSizes::Row& row = sizes.rows[i];
        print("    {:>5}{:>6}  {:<20}{:>11}{:>8}", row.primitive->mesh, row.primitive->number,
              fitted(row.primitive->name, 20), row.triangles, row.primitive->placed);
        print_cells(row.formats, bits_of(row.triangles));
    }
    tell_of_more(sizes.rows.size());
    print("    {:<33}{:>11}{:>8}", "sum", sizes.triangles, "");
    print_cells(sizes.sum, bits_of(sizes.triangles));
    print("    {:<52}", "sum, bytes");
    print_cells(sizes.sum, [](const FormatBytes& format) { return fmt::format("{}", format.bytes + format.seams); });
    print("\n");
}

}  // namespace lacedring::app
