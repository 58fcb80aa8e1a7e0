#include "app/view/scene/selection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/view/session/vector.h"

namespace lacedring::view {
namespace {

/// Position of a vertex as drawn, in the mesh's coordinates.
Vector place(const gpu::Model& model, std::uint32_t v) {
    Vector out;
    for (std::size_t i = 0; i < 3; ++i) {
        out[i] = static_cast<double>(model.positions[3 * std::size_t{v} + i]) * model.radius + model.center[i];
    }
    return out;
}

}  // namespace

Vector place_of(const Document& document, CornerId corner) {
    return place(*document.model, document.copy_at(corner));
}

CornerId nearest_corner(const Document& document, std::uint32_t t, const Vector& eye, const Vector& ray) {
    CornerId best = kNullCorner;
    double distance = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < 3; ++i) {
        const CornerId c = lacedring::corner(TriangleId{t}, i);
        const Vector d = cross(place_of(document, c) - eye, ray);
        if (dot(d, d) < distance) {
            distance = dot(d, d);
            best = c;
        }
    }
    return best;
}

std::optional<double> ray_meets(const Document& document, std::uint32_t t, const Vector& eye, const Vector& ray) {
    const std::vector<std::uint32_t>& indices = document.mesh->indices;
    const Vector a = place(*document.model, indices[3 * std::size_t{t}]);
    const Vector ab = place(*document.model, indices[3 * std::size_t{t} + 1]) - a;
    const Vector ac = place(*document.model, indices[3 * std::size_t{t} + 2]) - a;
    const Vector p = cross(ray, ac);
    const double determinant = dot(ab, p);
    if (determinant == 0) return std::nullopt;
    const Vector s = eye - a;
    const double u = dot(s, p) / determinant;
    if (!(u >= 0 && u <= 1)) return std::nullopt;
    const Vector q = cross(s, ab);
    const double v = dot(ray, q) / determinant, along = dot(ac, q) / determinant;
    if (!(v >= 0 && u + v <= 1 && along > 0)) return std::nullopt;
    return along;
}

std::optional<std::uint32_t> ray_hit(const Document& document, const Vector& eye, const Vector& ray) {
    std::optional<std::uint32_t> hit;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::uint32_t t = 0; t < document.mesh->triangle_count(); ++t) {
        const std::optional<double> along = ray_meets(document, t, eye, ray);
        if (along && *along < nearest) {
            nearest = *along;
            hit = t;
        }
    }
    return hit;
}

CornerId step(const Document& document, CornerId corner, char operation) {
    const CornerTable& table = *document.table;
    switch (operation) {
        case 'n':
            return next(corner);
        case 'p':
            return previous(corner);
        case 'o':
            return table.opposite(corner);
        case 's':
            return table.swing(corner);
        case 'l':
            return table.left(corner);
        case 'r':
            return table.right(corner);
        default:
            return kNullCorner;
    }
}

std::vector<CornerId> around(const CornerTable& table, CornerId corner) {
    std::vector<CornerId> out{corner};
    for (CornerId c = table.swing(corner); !c.is_null() && c != corner; c = table.swing(c)) out.push_back(c);
    if (!table.swing(out.back()).is_null()) return out;
    // Stopped at a border: collect the rest in the other direction.
    for (CornerId c = table.right(corner); !c.is_null(); c = table.right(previous(c))) {
        if (out.size() > table.corners.size()) break;
        out.push_back(previous(c));
    }
    return out;
}

std::vector<Mark> selection_marks(const Document& document, CornerId corner) {
    std::vector<Mark> out;
    if (corner.is_null()) return out;
    const CornerTable& table = *document.table;
    const auto lay = [&](CornerId c, std::uint32_t color) {
        if (!c.is_null()) out.push_back({triangle(c).value, color});
    };
    for (const CornerId c : around(table, corner)) lay(c, kFanColor);
    lay(table.left(corner), kLeftColor);
    lay(table.right(corner), kRightColor);
    lay(table.opposite(corner), kOppositeColor);
    lay(corner, kSelectedColor);
    return out;
}

std::pair<Vector, double> ball(const Document& document, CornerId corner) {
    const Vector center = place_of(document, corner);
    double squared = 0;
    for (const CornerId c : around(*document.table, corner)) {
        for (const CornerId other : {next(c), previous(c)}) {
            const Vector d = place_of(document, other) - center;
            squared = std::max(squared, dot(d, d));
        }
    }
    return {center, std::sqrt(squared) * 1.6};
}

}  // namespace lacedring::view
