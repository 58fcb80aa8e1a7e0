#include "app/report/paper_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/cli/print.h"

namespace lacedring::app {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

const MeasuredFormat* find(const FormatSet& set, std::string_view name) {
    const auto found = std::ranges::find(set.formats, name, &MeasuredFormat::name);
    return found == set.formats.end() ? nullptr : &*found;
}

double percent(std::uint32_t count, double triangles) {
    return 100.0 * count / triangles;
}
double percent(std::uint32_t count, const FormatSet& set) {
    return percent(count, set.triangles());
}
double references(const FormatSet& set, std::string_view name) {
    const MeasuredFormat* format = find(set, name);
    return format == nullptr ? kNone : static_cast<double>(format->references) / set.triangles();
}
double bits(const FormatSet& set, std::string_view name) {
    const MeasuredFormat* format = find(set, name);
    return format == nullptr ? kNone : 8 * static_cast<double>(format->bytes) / set.triangles();
}

double mesh_triangles(const Mesh& mesh, const FormatSet&) {
    return static_cast<double>(mesh.triangle_count());
}

// Table 1. If the LR tables cannot be built (too_large), their shares are 0 and their references missing.
constexpr Column kTable1[] = {
    {"n", 0, mesh_triangles},
    {"%v6", 1, [](const Mesh&, const FormatSet& s) { return s.report.valence6_percent; }},
    {"LR: m_i", 0, [](const Mesh&, const FormatSet& s) { return double(s.lr.isolated); }},
    {"%T0", 2, [](const Mesh&, const FormatSet& s) { return percent(s.lr.t0, s); }},
    {"%T0w", 2, [](const Mesh&, const FormatSet& s) { return percent(s.lr.t0_wart, s); }},
    {"%Ti", 2, [](const Mesh&, const FormatSet& s) { return percent(s.lr.t1_irregular + s.lr.t2_irregular, s); }},
    {"rpt", 3, [](const Mesh&, const FormatSet& s) { return references(s, "lr"); }},
    {"SQuad rpt", 3, [](const Mesh&, const FormatSet& s) { return references(s, "squad"); }},
    {"compact: k", 0,
     [](const Mesh&, const FormatSet& s) {
         const MeasuredFormat* format = find(s, "lr_compact");
         if (format == nullptr) return kNone;
         return format->k == 0 ? std::numeric_limits<double>::infinity() : double(format->k);
     }},
    {"m_i", 0, [](const Mesh&, const FormatSet& s) { return double(s.lr_compact.isolated); }},
    {"%T0", 2, [](const Mesh&, const FormatSet& s) { return percent(s.lr_compact.t0, s); }},
    {"%T0w", 2, [](const Mesh&, const FormatSet& s) { return percent(s.lr_compact.t0_wart, s); }},
    {"%Tl", 2, [](const Mesh&, const FormatSet& s) { return percent(s.lr_compact_long, s); }},
    {"%Ti", 2,
     [](const Mesh&, const FormatSet& s) { return percent(s.lr_compact.t1_irregular + s.lr_compact.t2_irregular, s); }},
    {"bpt", 2, [](const Mesh&, const FormatSet& s) { return bits(s, "lr_compact"); }},
};

// Section 8, last paragraph.
constexpr Column kLean[] = {
    {"triangles", 0, mesh_triangles},
    {"components", 0, [](const Mesh&, const FormatSet& s) { return double(s.report.components); }},
    {"lean", 4, [](const Mesh&, const FormatSet& s) { return references(s, "lean"); }},
    {"lean, no warts", 4, [](const Mesh&, const FormatSet& s) { return references(s, "lean_no_warts"); }},
    {"strips, restart", 3, [](const Mesh&, const FormatSet& s) { return references(s, "strip_restart"); }},
    {"strips, degenerate", 3, [](const Mesh&, const FormatSet& s) { return references(s, "strip_degenerate"); }},
    {"%T0", 2, [](const Mesh&, const FormatSet& s) { return percent(s.lean.t0, s); }},
    {"%T0w", 2, [](const Mesh&, const FormatSet& s) { return percent(s.lean.t0_wart, s); }},
    {"lean, bytes", 0, [](const Mesh&, const FormatSet& s) { return bits(s, "lean") / 8 * s.triangles(); }},
};

double acmr(const FormatSet& set, std::string_view name) {
    const MeasuredFormat* format = find(set, name);
    return format == nullptr ? kNone : analyze_fifo32(format->indices, format->vertex_count(set.vertices)).acmr;
}

// Not in the paper: the packed stream and its rivals.
constexpr Column kPacked[] = {
    {"triangles", 0, mesh_triangles},
    {"packed, bits", 3, [](const Mesh&, const FormatSet& s) { return bits(s, "packed"); }},
    {"cache profile, bits", 3, [](const Mesh&, const FormatSet& s) { return bits(s, "packed_cache"); }},
    {"its ACMR(32)", 3, [](const Mesh&, const FormatSet& s) { return acmr(s, "packed_cache"); }},
    {"best order's", 3, [](const Mesh&, const FormatSet& s) { return s.best_order ? s.best_order->acmr : kNone; }},
    {"index codec, bits", 2, [](const Mesh&, const FormatSet& s) { return bits(s, "meshopt_index_codec"); }},
    {"over packed", 1,
     [](const Mesh&, const FormatSet& s) { return bits(s, "meshopt_index_codec") / bits(s, "packed"); }},
    {"meshlets, bits", 1, [](const Mesh&, const FormatSet& s) { return bits(s, "meshlets"); }},
    {"strips, bits", 1, [](const Mesh&, const FormatSet& s) { return bits(s, "strip_restart"); }},
    {"LR, rpt", 3, [](const Mesh&, const FormatSet& s) { return bits(s, "lr") / 32; }},
};

// Section 1, in bits per triangle: connectivity plus three 16-bit coordinates per vertex in use. The corner table is
// the paper's: V and O only.
double coordinate_bits(const FormatSet& set) {
    return 48.0 * set.report.used_vertices / set.triangles();
}
double corner_table_bits(const FormatSet& set) {
    return 192.0 * set.report.triangles / set.triangles();
}
double total(const FormatSet& set, std::string_view name) {
    return bits(set, name) + coordinate_bits(set);
}
double saved_percent(const FormatSet& set, std::string_view name) {
    return 100 - 100 * total(set, name) / (corner_table_bits(set) + coordinate_bits(set));
}
constexpr Column kStorage[] = {
    {"coordinates", 1, [](const Mesh&, const FormatSet& s) { return coordinate_bits(s); }},
    {"corner table: total", 1,
     [](const Mesh&, const FormatSet& s) { return corner_table_bits(s) + coordinate_bits(s); }},
    {"connectivity %", 1,
     [](const Mesh&, const FormatSet& s) {
         return 100 * corner_table_bits(s) / (corner_table_bits(s) + coordinate_bits(s));
     }},
    {"LR: total", 1, [](const Mesh&, const FormatSet& s) { return total(s, "lr"); }},
    {"saved %", 1, [](const Mesh&, const FormatSet& s) { return saved_percent(s, "lr"); }},
    {"compact: total", 1, [](const Mesh&, const FormatSet& s) { return total(s, "lr_compact"); }},
    {"saved %", 1, [](const Mesh&, const FormatSet& s) { return saved_percent(s, "lr_compact"); }},
    {"lean: total", 1, [](const Mesh&, const FormatSet& s) { return total(s, "lean"); }},
    {"saved %", 1, [](const Mesh&, const FormatSet& s) { return saved_percent(s, "lean"); }},
};

using Row = std::vector<std::string>;

/// Prints a Markdown table. Cells are padded so that it is also readable as plain text.
void print_cells(const std::vector<Row>& rows) {
    std::vector<std::size_t> width(rows.front().size(), 3);
    for (const Row& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i) width[i] = std::max(width[i], row[i].size());
    }
    for (std::size_t r = 0; r < rows.size(); ++r) {
        for (std::size_t i = 0; i < width.size(); ++i) {
            i == 0 ? print("| {:<{}} |", rows[r][i], width[i]) : print(" {:>{}} |", rows[r][i], width[i]);
        }
        print("\n");
        if (r > 0) continue;
        for (std::size_t i = 0; i < width.size(); ++i) {
            i == 0 ? print("|:{:-<{}}|", "", width[i] + 1) : print("{:-<{}}:|", "", width[i] + 1);
        }
        print("\n");
    }
    print("\n");
}

std::string cell(double value, int decimals) {
    if (std::isnan(value)) return "-";
    if (std::isinf(value)) return "inf";
    return decimals == 0 ? fmt::format("{}", std::llround(value)) : fmt::format("{:.{}f}", value, decimals);
}
std::string name_of(const std::string& path) {
    return std::filesystem::path(path).stem().string();
}
std::string period_name(std::uint32_t k) {
    return k == 0 ? "inf" : std::to_string(k);
}

}  // namespace

std::span<const Column> size_table(std::string_view name) {
    if (name == "packed") return kPacked;
    if (name == "table1") return kTable1;
    if (name == "lean") return kLean;
    if (name == "storage") return kStorage;
    return {};
}

void print(std::span<const Column> columns, std::span<const MeshRow> rows) {
    std::vector<Row> cells{{"mesh"}};
    for (const Column& column : columns) cells[0].emplace_back(column.title);
    for (const MeshRow& row : rows) {
        Row& line = cells.emplace_back(Row{name_of(row.path)});
        for (std::size_t i = 0; i < columns.size(); ++i) line.push_back(cell(row.values[i], columns[i].decimals));
    }
    if (rows.size() > 1) {
        Row mean{"mean"}, median{"median"};
        for (std::size_t i = 0; i < columns.size(); ++i) {
            std::vector<double> values;
            double sum = 0;
            for (const MeshRow& row : rows) {
                if (columns[i].decimals == 0 || std::isnan(row.values[i])) continue;
                values.push_back(row.values[i]);
                sum += row.values[i];
            }
            std::ranges::sort(values);
            const std::size_t n = values.size();
            mean.push_back(n == 0 ? "" : cell(sum / static_cast<double>(n), columns[i].decimals));
            median.push_back(n == 0 ? "" : cell((values[(n - 1) / 2] + values[n / 2]) / 2, columns[i].decimals));
        }
        cells.push_back(mean);
        cells.push_back(median);
    }
    print_cells(cells);
}

void print_offsets(const std::string& path, std::span<const PeriodFigures> periods) {
    std::vector<Row> cells{{name_of(path) + ", % of triangles"}};
    std::size_t largest = 1;
    for (const PeriodFigures& period : periods) {
        cells[0].push_back("k = " + period_name(period.k));
        for (std::size_t b = 1; b < period.offsets.bits.size(); ++b) {
            if (period.offsets.bits[b] > 0) largest = std::max(largest, b);
        }
    }
    const auto add = [&](std::string title, const auto& count) {
        Row& line = cells.emplace_back(Row{std::move(title)});
        for (const PeriodFigures& period : periods)
            line.push_back(cell(percent(count(period.offsets), period.triangles), 2));
    };
    for (std::size_t b = 1; b <= largest; ++b) {
        add(fmt::format("{} bit{}", b, b == 1 ? "" : "s"), [&](const OffsetCounts& o) { return o.bits[b]; });
    }
    add("tip isolated", [](const OffsetCounts& o) { return o.off_ring; });
    add("T0", [](const OffsetCounts& o) { return o.t0; });
    print_cells(cells);
}

void print_periods(const std::string& path, std::span<const PeriodFigures> periods) {
    std::vector<Row> cells{{name_of(path) + ", k", "%T0", "up to 14 bits %", "LR rpt", "compact bpt", "lean rpt",
                            "ACMR(16)", "ACMR(32)", "without T0"}};
    for (const PeriodFigures& p : periods) {
        std::uint32_t small = 0;
        for (std::size_t b = 0; b <= 14; ++b) small += p.offsets.bits[b];
        cells.push_back({period_name(p.k), cell(percent(p.offsets.t0, p.triangles), 2),
                         cell(percent(small, p.triangles), 2), cell(p.lr_references, 3), cell(p.compact_bits, 2),
                         cell(p.lean_references, 3), cell(p.acmr16, 3), cell(p.acmr32, 3), cell(p.acmr32_ring, 3)});
    }
    print_cells(cells);
}

void print(std::span<const SeedRow> rows) {
    struct Group {
        const char* title;
        int decimals;
        double (*value)(const SeedRow&, const SeedFigures&);
    };
    constexpr Group kGroups[] = {
        {"m_i %", 3,
         [](const SeedRow& r, const SeedFigures& f) { return 100.0 * f.isolated / static_cast<double>(r.vertices); }},
        {"%T0", 2,
         [](const SeedRow& r, const SeedFigures& f) { return 100.0 * f.t0 / static_cast<double>(r.triangles); }},
        {"LR rpt", 3, [](const SeedRow&, const SeedFigures& f) { return f.lr_references; }},
    };
    std::vector<Row> cells{{"mesh"}};
    for (const SeedRow& row : rows) cells.push_back({name_of(row.path)});
    cells.push_back({"mean"});
    for (const Group& group : kGroups) {
        for (std::size_t i = 0; i < std::size(kSeedCounts); ++i) {
            cells.front().push_back(fmt::format("{}, {}", group.title, kSeedCounts[i]));
            double sum = 0;
            for (std::size_t r = 0; r < rows.size(); ++r) {
                const double value = group.value(rows[r], rows[r].figures[i]);
                cells[r + 1].push_back(cell(value, group.decimals));
                sum += value;
            }
            cells.back().push_back(cell(sum / static_cast<double>(rows.size()), group.decimals));
        }
    }
    if (rows.size() == 1) cells.pop_back();
    print_cells(cells);
}

nlohmann::ordered_json to_json(std::span<const PeriodFigures> periods) {
    auto out = nlohmann::ordered_json::array();
    for (const PeriodFigures& p : periods) {
        out.push_back({{"k", p.k == 0 ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(p.k)},
                       {"t0", p.offsets.t0},
                       {"tip_isolated", p.offsets.off_ring},
                       {"offset_bits", p.offsets.bits},
                       {"lr_references_per_triangle", p.lr_references},
                       {"lr_compact_bits_per_triangle", p.compact_bits},
                       {"lean_references_per_triangle", p.lean_references},
                       {"lean_acmr_fifo16", p.acmr16},
                       {"lean_acmr_fifo32", p.acmr32},
                       {"lean_acmr_fifo32_without_t0", p.acmr32_ring}});
    }
    return out;
}

nlohmann::ordered_json to_json(const SeedRow& row) {
    auto out = nlohmann::ordered_json::array();
    for (const SeedFigures& s : row.figures) {
        out.push_back({{"seeds", s.seeds},
                       {"isolated", s.isolated},
                       {"t0", s.t0},
                       {"lr_references_per_triangle", s.lr_references}});
    }
    return out;
}

}  // namespace lacedring::app
