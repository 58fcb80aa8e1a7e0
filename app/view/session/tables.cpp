// Functions of Tables (document.h): makes them, and answers questions about a selected corner.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "app/view/session/document.h"
#include "app/view/session/vector.h"
#include "lacedring/lacedring.hpp"
#include "lacedring/operators.hpp"
#include "lacedring/streams.hpp"

namespace lacedring::view {
namespace {

/// The corner of the LR triangle at the same vertex; null for degenerate triangles.
CornerId to_lr(const Tables& tables, const Operators<LrView>& operators, const CornerTable& table, CornerId corner) {
    const std::uint32_t number = tables.number[triangle(corner).value];
    if (number == UINT32_MAX) return kNullCorner;
    CornerId c = Operators<LrView>::corner(TriangleId{number});
    for (int i = 0; i < 3; ++i, c = Operators<LrView>::next(c)) {
        if (tables.lr.vertex_order[operators.vertex(c).value] == table.vertex(corner).value) return c;
    }
    return kNullCorner;
}

CornerId from_lr(const Tables& tables, const Operators<LrView>& operators, const CornerTable& table, CornerId corner) {
    corner = operators.canonical(corner);
    if (corner.is_null()) return corner;
    const std::uint32_t t = tables.triangle[Operators<LrView>::triangle(corner).value];
    if (t == UINT32_MAX) return kNullCorner;
    const std::uint32_t vertex = tables.lr.vertex_order[operators.vertex(corner).value];
    for (std::uint32_t i = 0; i < 3; ++i) {
        const CornerId c = lacedring::corner(TriangleId{t}, i);
        if (table.vertex(c).value == vertex) return c;
    }
    return kNullCorner;
}

}  // namespace

double crease_angle(const Document& document) {
    const CornerTable& table = *document.table;
    const gpu::Model& model = *document.model;
    const auto at = [&](CornerId c) {
        const std::size_t v = document.copy_at(c);
        return Vector{model.positions[3 * v], model.positions[3 * v + 1], model.positions[3 * v + 2]};
    };
    const auto normal = [&](CornerId c) {
        const Vector a = at(c);
        return unit(cross(at(next(c)) - a, at(previous(c)) - a));
    };
    struct Fold {
        std::uint32_t a, b;
        double cosine;
    };
    constexpr std::array kAngles{40.0, 55.0, 70.0, 90.0};
    const auto cosine_of = [](double degrees) { return std::cos(degrees * std::numbers::pi / 180); };
    std::vector<Fold> folds;
    for (std::uint32_t i = 0; i < table.corners.size(); ++i) {
        const CornerId c{i}, o = table.opposite(c);
        if (o.is_null() || o.value < i) continue;
        const double cosine = dot(normal(c), normal(o));
        if (cosine < cosine_of(kAngles[0])) {
            folds.push_back({table.vertex(next(c)).value, table.vertex(previous(c)).value, cosine});
        }
    }
    // Folds that share vertices form a line. Lines of fewer than kLine edges do not look like creases.
    constexpr std::uint32_t kLine = 6;
    std::vector<std::uint32_t> root(table.vertex_count), edges(table.vertex_count);
    const auto find = [&](std::uint32_t v) {
        while (root[v] != v) v = root[v] = root[root[v]];
        return v;
    };
    for (const double angle : kAngles) {
        std::iota(root.begin(), root.end(), 0U);
        std::ranges::fill(edges, 0U);
        std::erase_if(folds, [&](const Fold& fold) { return fold.cosine >= cosine_of(angle); });
        for (const Fold& fold : folds) root[find(fold.a)] = find(fold.b);
        for (const Fold& fold : folds) ++edges[find(fold.a)];
        const auto lone = std::ranges::count_if(folds, [&](const Fold& fold) { return edges[find(fold.a)] < kLine; });
        if (5 * static_cast<std::size_t>(lone) <= folds.size()) return angle;
    }
    return 180;
}

Result<Tables> make_tables(std::shared_ptr<const Mesh> mesh, EncodedLr lr) {
    const Result<LrStreamView<LrView>> stream = view_lr(lr.words);
    if (!stream) return stream.error();
    const Operators<LrView> operators(stream->view);
    Tables out;
    out.mesh = std::move(mesh);
    out.view = stream->view;
    out.number.assign(out.mesh->triangle_count(), UINT32_MAX);
    out.triangle.assign(stream->view.triangle_numbers(), UINT32_MAX);
    std::size_t i = 0;
    for (std::uint32_t t = 0; t < out.triangle.size() && i < lr.triangle_order.size(); ++t) {
        if (!operators.is_canonical(TriangleId{t})) continue;
        out.triangle[t] = lr.triangle_order[i++];
        out.number[out.triangle[t]] = t;
    }
    out.lr = std::move(lr);
    return out;
}

CornerId lr_step(const Tables& tables, const CornerTable& table, CornerId corner, char operation) {
    const Operators<LrView> operators(tables.view);
    const CornerId c = to_lr(tables, operators, table, corner);
    if (c.is_null()) return c;
    const auto result = [&] {
        switch (operation) {
            case 'n':
                return Operators<LrView>::next(c);
            case 'p':
                return Operators<LrView>::previous(c);
            case 'o':
                return operators.opposite(c);
            case 's':
                return operators.swing(c);
            case 'l':
                return operators.left(c);
            default:
                return operators.right(c);
        }
    }();
    return result.is_null() ? result : from_lr(tables, operators, table, result);
}

std::string lr_text(const Tables& tables, const CornerTable& table, CornerId corner) {
    const LrView& view = tables.view;
    const Operators<LrView> operators(view);
    const CornerId c = to_lr(tables, operators, table, corner);
    if (c.is_null()) return "degenerate: in no table";
    const std::uint32_t t = Operators<LrView>::triangle(c).value;
    if (t < 2 * view.ring_vertices) {
        return fmt::format("corner {}, triangle {}: {}[{}] = {:08x}", c.value, t, t % 2 == 0 ? 'L' : 'R', t / 2,
                           view.lr[t]);
    }
    const std::size_t at = 6 * std::size_t{t - 2 * view.ring_vertices};
    const auto opposite = [&](std::size_t i) {
        const std::uint32_t o = view.vo[at + i];
        return o == UINT32_MAX ? std::string("border") : std::to_string(o);
    };
    return fmt::format("corner {}, T0: VO[{}] = {} {} {} | {} {} {}", c.value, at, view.vo[at] & ~word::kT0Flip,
                       view.vo[at + 1], view.vo[at + 2], opposite(3), opposite(4), opposite(5));
}

}  // namespace lacedring::view
