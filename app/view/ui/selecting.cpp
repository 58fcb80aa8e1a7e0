#include "app/view/ui/selecting.h"

#include <algorithm>
#include <cmath>

#include "renderer/vk/try.h"

namespace lacedring::view {
namespace {

constexpr int kFramesToPlace = 4;

}  // namespace

Vector ray_through(const Scene& scene, const Orbit& orbit, PictureArea area, double x, double y) {
    const double n = scene.drawn().samples;
    const double within = (std::floor(n / 2) + 0.5) / n;
    return orbit.ray(std::floor(x) + within - area.width / 2, area.height / 2 - std::floor(y) - within, area.height,
                     area.width);
}

Result<void> Selecting::pick(State& state, Scene& scene, const Orbit& orbit, PictureArea area, double x, double y) {
    const auto& document = state.facts.document;
    if (!document || x < 0 || y < 0 || x >= area.width || y >= area.height) return {};
    const bool right = scene.drawn().mode == Mode::split && x >= state.choices.divider * area.width;
    LR_ASSIGN(const std::optional<std::uint32_t> hit,
              scene.triangle_at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), right));
    Selection& selection = state.facts.selection;
    selection = {};
    if (!hit || *hit >= document->mesh->triangle_count()) return {};
    std::uint32_t t = *hit;
    const Vector along = ray_through(scene, orbit, area, x, y);
    // A device rounds vertices to fractions of a pixel: near an edge the ray may meet the neighbor instead.
    if (!ray_meets(*document, t, orbit.eye(), along)) t = ray_hit(*document, orbit.eye(), along).value_or(t);
    selection.corner = nearest_corner(*document, t, orbit.eye(), along);
    frames_ = kFramesToPlace;
    return {};
}

void Selecting::step(Facts& facts, char operation) {
    if (!facts.document || !facts.selection.any()) {
        facts.tell("click a triangle first");
        return;
    }
    const CornerId to = view::step(*facts.document, facts.selection.corner, operation);
    if (to.is_null()) {
        facts.tell("a border: there is no such corner");
        return;
    }
    facts.selection.corner = to;
    frames_ = kFramesToPlace;
}

bool Selecting::keep_in_sight(const Facts& facts, Orbit& orbit, PictureArea area) {
    if (frames_ == 0) return false;
    --frames_;
    if (!facts.document || !facts.selection.any()) return false;
    const auto at = orbit.project(place_of(*facts.document, facts.selection.corner), area.height, area.width);
    if (!at) return false;
    const auto [x, y] = *at;
    const Area& free = facts.free;
    if (x >= free.left && x < free.right && y >= free.top && y < free.bottom) return false;
    orbit.pan((free.left + free.right) / 2 - x, (free.top + free.bottom) / 2 - y, area.height, area.width);
    return true;
}

bool frame_selection(const Facts& facts, Orbit& orbit, PictureArea area) {
    if (!facts.document || !facts.selection.any()) return false;
    const auto [center, radius] = ball(*facts.document, facts.selection.corner);
    const Area& free = facts.free;
    const double seen = std::max(0.3 * area.height, std::min(free.right - free.left, free.bottom - free.top));
    orbit.look_at(center, radius * std::min(area.width, area.height) / seen);
    orbit.pan((free.left + free.right - area.width) / 2, (free.top + free.bottom - area.height) / 2, area.height,
              area.width);
    return true;
}

}  // namespace lacedring::view
