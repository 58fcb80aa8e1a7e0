#pragma once
// The numbers of the paper's tables and figures, and these tables as Markdown (docs/results.md).

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/formats/formats.h"
#include "lrlab/paper/offsets.h"

namespace lacedring::app {

/// A column of a table that has one row per mesh.
struct Column {
    const char* title;
    int decimals;  ///< 0: a count, without mean and median
    double (*value)(const Mesh&, const FormatSet&);
};
/// Columns of the table "packed", "table1", "lean" (section 8) or "storage" (section 1); empty for any other name.
std::span<const Column> size_table(std::string_view name);

struct MeshRow {
    std::string path;
    std::vector<double> values;  ///< one per column; NaN: missing
};
/// Prints the table; with more than one mesh, mean and median below.
void print(std::span<const Column> columns, std::span<const MeshRow> rows);

/// Figures of rings made with one k (RingOptions::k). Paper: sections 6.1 and 7, Figure 8.
struct PeriodFigures {
    double triangles = 0;  ///< without degenerate ones
    std::uint32_t k = 0;   ///< 0: depth first
    OffsetCounts offsets;
    double lr_references = 0, lean_references = 0, compact_bits = 0;  ///< per triangle, without headers
    double acmr16 = 0, acmr32 = 0;                                    ///< of the triangles in lean's order
    double acmr32_ring = 0;                                           ///< of the ring slots alone (all but T0)
};
constexpr std::uint32_t kFigure8Periods[] = {1, 32, 0};
constexpr std::uint32_t kPeriods[] = {1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 0};
/// `ring.k` is ignored. Errors: those of build_corner_table, build_lr and build_compact_lr.
Result<std::vector<PeriodFigures>> figures_by_period(const Mesh& mesh, RingOptions ring,
                                                     std::span<const std::uint32_t> periods);
void print_offsets(const std::string& path, std::span<const PeriodFigures> periods);
void print_periods(const std::string& path, std::span<const PeriodFigures> periods);
nlohmann::ordered_json to_json(std::span<const PeriodFigures> periods);

/// Figures of standard LR for a number of seed corners tried per component: section 4.2.
struct SeedFigures {
    std::uint32_t seeds = 0;
    std::uint32_t isolated = 0, t0 = 0;
    double lr_references = 0;  ///< per triangle
};
constexpr std::uint32_t kSeedCounts[] = {1, 4, 16, 64};
struct SeedRow {
    std::string path;
    /// Vertices in use, including the copies that split_fans adds.
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    std::vector<SeedFigures> figures;  ///< one per entry of kSeedCounts
};
/// `ring.seeds` is ignored. Errors: those of build_corner_table and build_lr.
Result<SeedRow> figures_by_seeds(const std::string& path, const Mesh& mesh, RingOptions ring);
void print(std::span<const SeedRow> rows);
nlohmann::ordered_json to_json(const SeedRow& row);

}  // namespace lacedring::app
