#include "app/bench/resident.h"

#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <span>

#include "app/bench/operators.h"
#include "app/bench/resident_visits.h"
#include "app/cli/print.h"
#include "app/cli/progress.h"
#include "lacedring/lacedring.hpp"
#include "lacedring/operators.hpp"
#include "lacedring/streams.hpp"
#include "lacedring/topology.hpp"
#include "lrlab/rivals/corner_table_c.h"

namespace lacedring::app {
namespace {

constexpr int kPlanes = 8;
constexpr const char* kVisitNames[kVisits] = {"vertex",   "opposite", "valence", "normal", "vertex",
                                              "opposite", "valence",  "normal",  "contour"};

/// The visits in the corner table's numbering.
struct Reference {
    CornerTableCView table;
    Visits visits;                // visits.step: opposites
    std::vector<CornerId> swing;  // SQuad's visits.step
};

/// Maps vertices and corners of the corner table to those of a structure.
struct Numbering {
    // place[t]: 4 * the number of triangle t in the structure + the index (0, 1 or 2) of its first corner.
    std::vector<std::uint32_t> vertex_to, place;

    Numbering(const LrMap& map, const CornerTableCView& table)
        : vertex_to(table.vertices), place(table.triangle_numbers()) {
        for (std::uint32_t v = 0; v < map.vertex.size(); ++v) vertex_to[map.vertex[v].value] = v;
        for (std::uint32_t t = 0; t < map.triangle.size(); ++t) {
            if (!map.triangle[t].is_null()) place[map.triangle[t].value] = 4 * t + map.start[t];
        }
    }
    VertexId operator()(VertexId v) const { return VertexId{vertex_to[v.value]}; }
    CornerId operator()(CornerId c) const {
        if (c.is_null()) return c;
        const std::uint32_t p = place[c.value / 3];
        return CornerId{(p & ~3U) + (c.value % 3 + 3 - p % 4) % 3};
    }
};
struct SameNumbering {
    template <class Id>
    Id operator()(Id id) const {
        return id;
    }
};

void add_contours(const CornerTableCView& table, const std::vector<float>& positions, Visits& visits) {
    float low = INFINITY, high = -INFINITY;
    for (std::size_t i = 0; i < positions.size(); i += 3) {
        low = std::min(low, positions[i]);
        high = std::max(high, positions[i]);
    }
    for (int i = 0; i < kPlanes; ++i) {
        const double plane = low + (static_cast<double>(high) - low) * (i + 0.5) / kPlanes;
        const auto above = [&](CornerId c) { return positions[3 * std::size_t{table.vertex(c).value}] > plane; };
        std::vector<bool> seen(table.triangle_numbers(), false);
        for (std::uint32_t t = 0; t < table.triangle_numbers(); ++t) {
            Contour contour{table.corner(TriangleId{t}), 0, kNullCorner, plane};
            if (seen[t]) continue;
            // Find a corner that faces an edge cut by the plane.
            if (above(table.next(contour.seed)) == above(table.previous(contour.seed)))
                contour.seed = table.next(contour.seed);
            if (above(table.next(contour.seed)) == above(table.previous(contour.seed))) continue;
            CornerId c = contour.seed;
            for (; !c.is_null() && !seen[table.triangle(c).value]; ++contour.steps) {
                seen[table.triangle(c).value] = true;
                c = contour_step(table, positions, plane, c);
            }
            contour.last = c;
            visits.contour_triangles += contour.steps;
            visits.contours.push_back(contour);
        }
    }
}

Reference make_reference(const CornerTableCView& table, const std::vector<float>& positions, std::uint32_t sample) {
    Reference out{table, {}, {}};
    Visits& v = out.visits;
    v.corner_count = table.vertex_of.size();
    v.vertex_count = table.vertices;
    std::mt19937_64 random(1);
    v.sample = sample;
    for (std::size_t i = 0; i < (1 + Visits::kWarmUps) * sample; ++i) {
        const CornerId c{static_cast<std::uint32_t>(random() % v.corner_count)};
        VertexId at{static_cast<std::uint32_t>(random() % v.vertex_count)};
        if (table.corner(at).is_null()) at = table.vertex(c);
        v.corners.push_back(c);
        v.vertices.push_back(at);
        if (i >= sample) continue;
        v.vertex_of.push_back(table.vertex(c));
        v.step.push_back(table.opposite(c));
        out.swing.push_back(table.swing(c));
        v.valence.push_back(table.valence(at));
        v.normal.push_back(normal_z(table, positions, at));
    }
    for (std::uint32_t u = 0; u < table.vertices; ++u) {
        v.valence_sum += table.valence(VertexId{u});
        v.up += normal_z(table, positions, VertexId{u}) > 0 ? 1 : 0;
    }
    add_contours(table, positions, v);
    return out;
}

/// Translates the visits to a structure's numbering.
template <class Ops, class To>
Visits translate(const Reference& reference, const To& to) {
    constexpr bool swings = std::is_same_v<Ops, SquadView>;
    Visits v = reference.visits;
    if (swings) v.step = reference.swing;
    for (auto* ids : {&v.corners, &v.step}) {
        for (CornerId& c : *ids) c = to(c);
    }
    for (auto* ids : {&v.vertices, &v.vertex_of}) {
        for (VertexId& u : *ids) u = to(u);
    }
    for (Contour& contour : v.contours) {
        contour.seed = to(contour.seed);
        contour.last = to(contour.last);
    }
    const CornerTableCView& table = reference.table;
    for (std::uint32_t c = 0; c < table.vertex_of.size(); ++c) {
        v.vertex_sum += to(table.vertex(CornerId{c})).value;
        v.step_sum += summand(to(swings ? table.swing(CornerId{c}) : table.opposite(CornerId{c})));
    }
    return v;
}

std::vector<float> reorder(const std::vector<float>& positions, const std::vector<VertexId>& order) {
    std::vector<float> out;
    out.reserve(positions.size());
    for (const VertexId v : order) {
        for (std::size_t i = 0; i < 3; ++i) out.push_back(positions[3 * std::size_t{v.value} + i]);
    }
    return out;
}

std::span<const std::uint32_t> words_in(const PagedFile& file) {
    return {reinterpret_cast<const std::uint32_t*>(file.bytes().data()), file.bytes().size() / 4};
}

/// Writes the structures to paged files one after the other, so that no two are in memory at once.
class Maker {
  public:
    Maker(const Reference& reference, const std::vector<float>& positions, std::filesystem::path scratch,
          std::size_t page_bytes)
        : reference_(reference), positions_(positions), scratch_(std::move(scratch)), page_bytes_(page_bytes) {}

    /// `view(words)` makes the operators on the file's words.
    template <class View, class To>
    Result<void> add(const char* name, std::initializer_list<std::span<const std::uint32_t>> arrays, const To& to,
                     const std::vector<VertexId>& order, const View& view) {
        std::vector<std::span<const std::byte>> parts;
        for (const auto& array : arrays) parts.push_back(std::as_bytes(array));
        Result<PagedFile> file = PagedFile::make(scratch_, parts, page_bytes_);
        if (!file)
            return Error{file.error().code, "scratch file in " + scratch_.string() + ": " + file.error().message};
        auto ops = view(words_in(*file));
        using Ops = decltype(ops);
        structures.push_back(
            std::make_unique<PagedOperators<Ops>>(name, std::move(*file), ops, translate<Ops>(reference_, to),
                                                  order.empty() ? positions_ : reorder(positions_, order)));
        return {};
    }

    std::vector<std::unique_ptr<PagedStructure>> structures;

  private:
    const Reference& reference_;
    const std::vector<float>& positions_;
    std::filesystem::path scratch_;
    std::size_t page_bytes_;
};

Result<void> add_all(Maker& maker, const CornerTable& table, const CornerTableC& with_c, bool with_squad) {
    const CornerTableCView reference = with_c.view();
    const std::size_t c = with_c.vertex_of.size();
    Result<void> added = maker.add(
        "corner_table", {with_c.vertex_of, with_c.opposite_of, with_c.corner_of}, SameNumbering{}, {},
        [&](std::span<const std::uint32_t> words) {
            return CornerTableCView{{}, reference.vertices, words.first(c), words.subspan(c, c), words.subspan(2 * c)};
        });
    if (!added) return added;
    if (with_squad) {
        LrMap map;
        const Result<Squad> squad = build_squad(table, {}, &map);
        if (!squad) return squad.error();
        const std::size_t swings = squad->swings.size();
        added = maker.add(
            "squad", {squad->swings, squad->corners}, Numbering(map, reference), map.vertex,
            [&](std::span<const std::uint32_t> words) {
                return SquadView{{}, squad->vertices, squad->matched, words.first(swings), words.subspan(swings)};
            });
        if (!added) return added;
    }
    {
        LrMap map;
        const Result<LrTable> lr = build_lr(table, expand_rings(table, {.one_per_shell = true}), {}, &map);
        if (!lr) return lr.error();
        added = maker.add("lr", {serialize(*lr, {})}, Numbering(map, reference), map.vertex,
                          [](std::span<const std::uint32_t> words) { return Operators<LrView>(view_lr(words)->view); });
        if (!added) return added;
    }
    const Result<CompactChoice> choice = smallest_compact_lr(table, {}, recommended_periods(table.triangle_count()));
    if (!choice) return choice.error();
    return maker.add(
        "lr_compact", {serialize(choice->compact, {})}, Numbering(choice->map, reference), choice->map.vertex,
        [](std::span<const std::uint32_t> words) { return Operators<CompactLrView>(view_compact_lr(words)->view); });
}

/// 32 KiB; smaller if the corner table has few pages, larger if it has too many to map.
std::size_t choose_page(std::size_t bytes) {
    std::size_t page = PagedFile::kPageBytes;
    while (bytes / page < 512 && page > 4096) page /= 2;
    while (bytes / page > 32768) page *= 2;
    return page;
}

/// The memory limits in bytes, in whole pages, largest first.
std::vector<std::size_t> choose_limits(const ResidentOptions& options, std::size_t corner_table, std::size_t lr,
                                       std::size_t lr_compact, std::size_t page) {
    std::vector<std::size_t> out;
    const auto add = [&](double bytes) {
        out.push_back(
            std::max(static_cast<std::size_t>(std::ceil(bytes / static_cast<double>(page))), PagedFile::kMinPages) *
            page);
    };
    for (const double level : options.levels) add(level * static_cast<double>(corner_table));
    add(static_cast<double>(lr));
    add(static_cast<double>(lr_compact));
    add(static_cast<double>(lr) / 2);
    std::sort(out.begin(), out.end(), std::greater<>());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

Result<CornerTable> without_degenerate(CornerTable table) {
    if (table.topology.degenerate == 0) return table;
    std::vector<std::uint32_t> indices;
    for (std::uint32_t t = 0; t < table.triangle_count(); ++t) {
        for (std::uint32_t i = 0; i < 3 && !table.degenerate(TriangleId{t}); ++i) {
            indices.push_back(table.vertex(corner(TriangleId{t}, i)).value);
        }
    }
    return build_corner_table(indices, table.vertex_count);
}

}  // namespace

Result<ResidentFigures> measure_resident(const Mesh& mesh, CornerTable input, const ResidentOptions& options) {
    Result<CornerTable> table = without_degenerate(std::move(input));
    if (!table) return table.error();
    if (table->triangle_count() == 0) return Error{ErrorCode::malformed, "no triangles to visit"};
    std::error_code no_folder;
    const std::filesystem::path scratch = options.scratch.empty() ? std::filesystem::temp_directory_path(no_folder)
                                                                  : std::filesystem::path(options.scratch);
    if (no_folder) return Error{ErrorCode::cannot_write, "no folder for scratch files: " + no_folder.message()};
    std::vector<float> positions = positions_f32(mesh);
    for (const VertexId original : split_fans(*table)) {
        for (std::size_t i = 0; i < 3; ++i) positions.push_back(positions[3 * std::size_t{original.value} + i]);
    }

    ResidentFigures out;
    std::vector<std::unique_ptr<PagedStructure>> structures;
    {
        const CornerTableC with_c = build_corner_table_c(*table);
        const Reference reference = make_reference(with_c.view(), positions, options.sample);
        out.page_bytes = options.page_kib != 0 ? options.page_kib * 1024 : choose_page(4 * with_c.view().references());
        out.contour_triangles = reference.visits.contour_triangles;
        Maker maker(reference, positions, scratch, out.page_bytes);
        const std::string no_squad = no_squad_operators(*table);
        if (!no_squad.empty()) out.absent.emplace_back("squad", no_squad);
        if (const Result<void> added = add_all(maker, *table, with_c, no_squad.empty()); !added) return added.error();
        structures = std::move(maker.structures);
        out.page_bytes = structures.front()->file().page_bytes();
    }
    *table = {};
    out.sample = options.sample;
    const auto bytes = [&](std::size_t s) { return structures[s]->file().bytes().size(); };
    for (const auto& s : structures)
        out.structures.push_back({s->name(), s->file().bytes().size(), s->file().direct()});

    const std::size_t last = structures.size() - 1;  // lr_compact; lr is before it
    const std::vector<std::size_t> limits =
        choose_limits(options, bytes(0), bytes(last - 1), bytes(last), out.page_bytes);
    ProgressBar bar("operators, memory limited", limits.size() * kVisits * static_cast<std::uint64_t>(options.rounds));
    for (const std::size_t limit : limits) {
        ResidentFigures::Level level;
        level.limit_bytes = limit;
        level.corner_tables = static_cast<double>(limit) / static_cast<double>(bytes(0));
        level.resident_bytes.assign(structures.size(), 0);
        level.cells.assign(structures.size(), std::vector<ResidentFigures::Cell>(kVisits));
        for (const auto& s : structures) {
            s->file().limit(limit);
            if (out.levels.empty()) s->touch_all();
        }
        for (int visit = 0; visit < kVisits; ++visit) {
            std::vector<std::vector<double>> ns(structures.size());
            for (int round = 0; round < options.rounds; ++round) {
                for (std::size_t i = 0; i < structures.size(); ++i) {
                    const PagedStructure::Timing timing = structures[i]->time(static_cast<Visit>(visit));
                    if (!timing.right) {
                        return Error{ErrorCode::invalid_argument,
                                     fmt::format("{} disagrees with the corner table on {}", structures[i]->name(),
                                                 kVisitNames[visit])};
                    }
                    const auto operations = static_cast<double>(std::max<std::size_t>(1, timing.operations));
                    ns[i].push_back(timing.seconds / operations * 1e9);
                    level.cells[i][visit].pages_per_op +=
                        static_cast<double>(timing.pages) / operations / options.rounds;
                    level.resident_bytes[i] = std::max(level.resident_bytes[i], structures[i]->file().resident());
                }
                bar.step();
            }
            for (std::size_t i = 0; i < structures.size(); ++i) level.cells[i][visit].ns_per_op = median(ns[i]);
        }
        out.levels.push_back(std::move(level));
    }
    return out;
}

void print_resident(const ResidentFigures& figures) {
    print("  operators with resident memory limited, ns each; * pages were read from the scratch file\n");
    print("    pages of {} KiB, first in first out; {} random visits; {} triangles on contours{}\n",
          figures.page_bytes / 1024, figures.sample, figures.contour_triangles,
          figures.structures.front().direct ? "" : "; the file system's memory, not a disk, is read");
    for (const auto& [name, reason] : figures.absent) print("    {} is absent: {}\n", name, reason);
    const auto header = [&](const char* title) {
        print("    {:<34}", title);
        for (const auto& s : figures.structures) print("{:>14}", s.name);
        print("\n");
    };
    header("");
    print("      {:<32}", "file, MB");
    for (const auto& s : figures.structures) print("{:>14.1f}", static_cast<double>(s.bytes) / 1e6);
    print("\n");
    constexpr const char* titles[kVisits] = {
        "c.v, own order",        "c.o (SQuad c.s), own order", "valence, own order",
        "normal, own order",     "c.v, random order",          "c.o (SQuad c.s), random",
        "valence, random order", "normal, random order",       "contour"};
    for (std::size_t visit = 0; visit < kVisits; ++visit) {
        header(titles[visit]);
        for (const auto& level : figures.levels) {
            print("      {:>9.1f} MB = {:>6.3f} corner tables", static_cast<double>(level.limit_bytes) / 1e6,
                  level.corner_tables);
            for (const auto& cells : level.cells) {
                print("{:>13.1f}{}", cells[visit].ns_per_op, cells[visit].pages_per_op > 0 ? '*' : ' ');
            }
            print("\n");
        }
    }
}

nlohmann::ordered_json to_json(const ResidentFigures& figures) {
    using Json = nlohmann::ordered_json;
    Json structures = Json::object(), levels = Json::array();
    for (const auto& s : figures.structures) structures[s.name] = {{"bytes", s.bytes}, {"direct", s.direct}};
    for (const auto& level : figures.levels) {
        Json by_structure = Json::object();
        for (std::size_t i = 0; i < figures.structures.size(); ++i) {
            Json& entry = by_structure[figures.structures[i].name];
            entry["resident_bytes"] = level.resident_bytes[i];
            for (std::size_t visit = 0; visit < kVisits; ++visit) {
                const ResidentFigures::Cell& cell = level.cells[i][visit];
                const Json value = {{"ns_per_op", cell.ns_per_op}, {"pages_per_op", cell.pages_per_op}};
                if (visit == kContour) {
                    entry["contour"] = value;
                } else {
                    entry[visit < kRandomVertex ? "scan" : "random"][kVisitNames[visit]] = value;
                }
            }
        }
        levels.push_back({{"limit_bytes", level.limit_bytes},
                          {"corner_tables", level.corner_tables},
                          {"structures", std::move(by_structure)}});
    }
    Json absent = Json::object();
    for (const auto& [name, reason] : figures.absent) absent[name] = reason;
    return {{"page_bytes", figures.page_bytes},
            {"sample", figures.sample},
            {"contour_triangles", figures.contour_triangles},
            {"structures", std::move(structures)},
            {"absent", std::move(absent)},
            {"levels", std::move(levels)}};
}

}  // namespace lacedring::app
