#pragma once
// The selected corner: finding it, applying operators to it, and marking it.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "app/view/scene/scene.h"
#include "app/view/session/document.h"

namespace lacedring::view {

struct Selection {
    CornerId corner = kNullCorner;  ///< of the document's corner table

    bool any() const { return !corner.is_null(); }
};

/// Position of the corner's vertex as drawn, in the mesh's coordinates.
std::array<double, 3> place_of(const Document& document, CornerId corner);

/// The corner of triangle t whose vertex is nearest to the ray, in the mesh's coordinates.
CornerId nearest_corner(const Document& document, std::uint32_t t, const std::array<double, 3>& eye,
                        const std::array<double, 3>& ray);

/// Distance at which the ray meets triangle t, in lengths of `ray`; empty if it misses t or is parallel to it.
std::optional<double> ray_meets(const Document& document, std::uint32_t t, const std::array<double, 3>& eye,
                                const std::array<double, 3>& ray);

/// The triangle that the ray meets first; empty if it misses all. Cost: O(T).
std::optional<std::uint32_t> ray_hit(const Document& document, const std::array<double, 3>& eye,
                                     const std::array<double, 3>& ray);

/// Applies the operator n, p, o, s, l or r; null at a border.
CornerId step(const Document& document, CornerId corner, char operation);

/// All corners around the vertex of a corner, found by swings in both directions.
std::vector<CornerId> around(const CornerTable& table, CornerId corner);

/// Colors of the selected triangle, its neighbors and the fan of its vertex. Later marks override earlier ones.
std::vector<Mark> selection_marks(const Document& document, CornerId corner);

/// Center and radius of a ball around the fan of the corner's vertex, in the mesh's coordinates.
std::pair<std::array<double, 3>, double> ball(const Document& document, CornerId corner);

constexpr std::uint32_t rgba(unsigned r, unsigned g, unsigned b, unsigned a = 255) {
    return r | g << 8 | b << 16 | a << 24;
}
constexpr std::uint32_t kSelectedColor = rgba(246, 190, 40), kOppositeColor = rgba(60, 130, 246),
                        kLeftColor = rgba(58, 190, 96), kRightColor = rgba(226, 74, 120),
                        kFanColor = rgba(150, 120, 220, 190);

}  // namespace lacedring::view
