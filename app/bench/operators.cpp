#include "app/bench/operators.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "app/bench/operator_kernels.h"
#include "app/cli/progress.h"
#include "lacedring/lacedring.hpp"
#include "lacedring/operators.hpp"
#include "lacedring/topology.hpp"
#include "lrlab/rivals/corner_table_c.h"
#include "lrlab/rivals/limit.h"
#include "lrlab/rivals/squad.h"
#include "lrlab/rivals/winged_edge.h"

namespace lacedring::app {
namespace {

constexpr std::size_t kNormal = 3;  // index of "normal" in the result of round()

/// One structure and the vertex positions in its own order.
template <class Ops>
class Bench {
  public:
    /// `order[v]`: the corner table's vertex that is the structure's vertex v; empty: the numbers are the same.
    Bench(const char* name, Ops ops, std::size_t references, std::size_t triangles, const std::vector<float>& positions,
          const std::vector<VertexId>& order)
        : ops_(std::move(ops)), positions_(positions) {
        if (!order.empty()) {
            for (std::size_t v = 0; v < order.size(); ++v) {
                std::copy_n(positions.begin() + static_cast<std::ptrdiff_t>(3 * std::size_t{order[v].value}), 3,
                            positions_.begin() + static_cast<std::ptrdiff_t>(3 * v));
            }
        }
        figures_.structure = name;
        figures_.references_per_triangle = static_cast<double>(references) / static_cast<double>(triangles);
        float low = INFINITY, high = -INFINITY;
        for (std::size_t i = 0; i < positions_.size(); i += 3) {
            low = std::min(low, positions_[i]);
            high = std::max(high, positions_[i]);
        }
        plane_ = low + (high - low) * 0.5F;
        for (std::uint32_t t = 0; t < ops_.store().triangle_numbers(); ++t) {
            const CornerId c = ops_.corner(TriangleId{t});
            if (!ops_.is_canonical(TriangleId{t})) continue;
            if (above(c) != above(ops_.next(c)) || above(c) != above(ops_.previous(c))) crossing_.push_back(c);
        }
    }

    /// Times every operator once. Returns a checksum per operator, which must be equal for all structures.
    std::vector<double> round() {
        std::vector<double> sums;
        const auto time = [&](const char* name, std::size_t elements, const auto& work) {
            double sum = 0;
            const double s = app::seconds([&] { sum = work(); });
            sums.push_back(sum);
            auto row =
                std::find_if(figures_.rows.begin(), figures_.rows.end(), [&](const auto& r) { return r.name == name; });
            if (row == figures_.rows.end()) row = figures_.rows.insert(row, {name, {}, elements});
            row->seconds.push_back(s);
        };
        const std::uint32_t triangles = ops_.store().triangle_numbers(), vertices = ops_.store().vertices;
        const std::size_t corners = std::size_t{3} * triangles;
        time("vertex", corners, [&] {
            // A maximum, which does not depend on the numbering.
            float sum = 0;
            each_corner([&](CornerId c) { sum = std::max(sum, positions_[3 * std::size_t{ops_.vertex(c).value}]); });
            return static_cast<double>(sum);
        });
        time("opposite", corners, [&] {
            std::uint64_t borders = 0;
            each_corner([&](CornerId c) { borders += step_of(ops_, c).is_null() ? 1 : 0; });
            return static_cast<double>(borders);
        });
        time("valence", vertices, [&] {
            std::uint64_t sum = 0;
            for (std::uint32_t v = 0; v < vertices; ++v) sum += ops_.valence(VertexId{v});
            return static_cast<double>(sum);
        });
        time("normal", vertices, [&] {
            std::uint64_t up = 0;
            for (std::uint32_t v = 0; v < vertices; ++v) up += normal_z(ops_, positions_, VertexId{v}) > 0 ? 1 : 0;
            return static_cast<double>(up);
        });
        std::size_t met = 0;
        std::vector<bool> seen(triangles, false);
        time("contour", 0, [&] {
            met = contour(seen);
            return static_cast<double>(met);
        });
        figures_.rows.back().elements = std::max<std::size_t>(met, 1);
        return sums;
    }

    OperatorFigures figures() const { return figures_; }

  private:
    template <class Visit>
    void each_corner(Visit visit) const {
        for (std::uint32_t t = 0; t < ops_.store().triangle_numbers(); ++t) {
            if (!ops_.is_canonical(TriangleId{t})) continue;
            CornerId c = ops_.corner(TriangleId{t});
            for (int k = 0; k < 3; ++k, c = ops_.next(c)) visit(c);
        }
    }
    const float* position(VertexId v) const { return positions_.data() + 3 * std::size_t{v.value}; }
    bool above(CornerId c) const { return position(ops_.vertex(c))[0] > plane_; }

    /// Follows every contour from triangle to triangle. Returns the number of triangles.
    std::size_t contour(std::vector<bool>& seen) const {
        std::size_t met = 0;
        for (const CornerId seed : crossing_) {
            if (seen[ops_.triangle(seed).value]) continue;
            // Begin with a corner that faces an edge cut by the plane.
            CornerId c = seed;
            if (above(ops_.next(c)) == above(ops_.previous(c))) c = ops_.next(c);
            while (!c.is_null() && !seen[ops_.triangle(c).value]) {
                seen[ops_.triangle(c).value] = true;
                ++met;
                c = above(c) == above(ops_.next(c)) ? ops_.opposite(ops_.next(c)) : ops_.opposite(ops_.previous(c));
            }
        }
        return met;
    }

    Ops ops_;
    std::vector<float> positions_;
    std::vector<CornerId> crossing_;
    float plane_ = 0;
    OperatorFigures figures_;
};

}  // namespace

double OperatorFigures::Row::ns_per_op() const {
    return median(seconds) / static_cast<double>(elements) * 1e9;
}

std::string no_squad_operators(const CornerTable& table) {
    std::vector<std::uint32_t> vertices;
    vertices.reserve(table.corners.size());
    for (const CornerTable::Corner& c : table.corners) vertices.push_back(c.vertex.value);
    const Valences valences = count_valences(vertices, table.vertex_count);
    if (valences.moderate()) return {};
    return fmt::format("c.v takes time proportional to the valence, and one vertex has {} triangles", valences.most);
}

Result<OperatorBench> measure_operators(const Mesh& mesh, CornerTable table, int rounds) {
    std::vector<float> positions = positions_f32(mesh);
    for (const VertexId original : split_fans(table)) {
        for (std::size_t i = 0; i < 3; ++i) positions.push_back(positions[3 * std::size_t{original.value} + i]);
    }
    OperatorBench out;
    const std::string no_squad = no_squad_operators(table);
    if (!no_squad.empty()) out.absent.emplace_back("squad", no_squad);
    const std::size_t triangles = mesh.triangle_count();
    constexpr std::uint64_t kBuilt = 5;
    ProgressBar bar("operators", kBuilt + static_cast<std::uint64_t>(rounds));
    const CornerTableC corner_table = build_corner_table_c(table);
    bar.step();
    const WingedEdge winged = build_winged_edge(table);
    bar.step();
    LrMap squad_map, lr_map;
    Squad squad;
    if (no_squad.empty()) {
        Result<Squad> built = build_squad(table, {}, &squad_map);
        if (!built) return built.error();
        squad = std::move(*built);
    }
    bar.step();
    const Result<LrTable> lr = build_lr(table, expand_rings(table, {.one_per_shell = true}), {}, &lr_map);
    if (!lr) return lr.error();
    bar.step();
    const Result<CompactChoice> compact = smallest_compact_lr(table, {}, recommended_periods(triangles));
    if (!compact) return compact.error();
    bar.step();
    table = {};

    const auto no_order = std::vector<VertexId>{};
    Bench a("corner_table", corner_table.view(), corner_table.view().references(), triangles, positions, no_order);
    Bench b("winged_edge", winged.view(), winged.view().references(), triangles, positions, no_order);
    std::optional<Bench<SquadView>> c;
    if (no_squad.empty()) {
        c.emplace("squad", squad.view(), squad.view().references(), triangles, positions, squad_map.vertex);
    }
    Bench d("lr", Operators<LrView>(lr->view()), lr->view().references(), triangles, positions, lr_map.vertex);
    Bench e("lr_compact", Operators<CompactLrView>(compact->compact.view()), compact->compact.view().bytes() / 4,
            triangles, positions, compact->map.vertex);
    for (int round = 0; round < rounds; ++round) {
        const std::vector<double> expected = a.round();
        for (const std::vector<double>& sums : {b.round(), c ? c->round() : expected, d.round(), e.round()}) {
            for (std::size_t i = 0; i < sums.size(); ++i) {
                // The sign of a normal's z near 0 depends on where the star begins. All else is exact.
                const double allowed = i == kNormal ? 2 + expected[i] * 1e-3 : 0;
                if (std::abs(sums[i] - expected[i]) <= allowed) continue;
                return Error{ErrorCode::invalid_argument, "structures disagree on an operator"};
            }
        }
        bar.step();
    }
    out.structures = {a.figures(), b.figures()};
    if (c) out.structures.push_back(c->figures());
    out.structures.push_back(d.figures());
    out.structures.push_back(e.figures());
    return out;
}

}  // namespace lacedring::app
