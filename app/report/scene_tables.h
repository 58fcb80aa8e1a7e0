#pragma once
// Tables of a scene's primitives, for info and stats.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/command.h"
#include "app/cli/input.h"

namespace lacedring::app {

/// [{"mesh","primitive","name","mode","triangles","vertices","copies","placed","attributes":[{"name","type","components"}]}]
nlohmann::ordered_json primitives_to_json(const LoadedScene& scene);
/// {"primitives","triangles","placed_triangles","vertices","copies"}
nlohmann::ordered_json sum_to_json(const LoadedScene& scene);
/// Prints both as a table; of many primitives, only the first.
void print_primitives(const LoadedScene& scene);

/// Size of one format. `seams`: bytes of its seam section, not counted in `bytes`.
struct FormatBytes {
    std::string name;
    std::size_t bytes = 0, seams = 0;
};

/// The sizes of each primitive of a scene in the formats of a quick FormatSet, and their sum.
struct PrimitiveSizes {
    struct Row {
        const LoadedPrimitive* primitive = nullptr;
        std::size_t triangles = 0;  ///< without degenerate ones
        std::vector<FormatBytes> formats;
    };
    std::vector<Row> rows;
    std::size_t triangles = 0;
    std::vector<FormatBytes> sum;  ///< formats that every primitive has
    /// The first format that failed its validation, and why; empty: none.
    std::string invalid;
};

/// Errors: those of make_formats, with the primitive's label.
Result<PrimitiveSizes> measure_primitives(const LoadedScene& scene, const RingChoice& choice, bool paper);

/// Adds "primitives" and "sum" to the JSON of a mesh.
void add_primitive_sizes(const PrimitiveSizes& sizes, nlohmann::ordered_json& mesh);
void print_primitive_sizes(const PrimitiveSizes& sizes);

}  // namespace lacedring::app
