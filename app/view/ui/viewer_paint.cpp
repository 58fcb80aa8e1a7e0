// What is laid over the triangles, kept up with what was chosen.
#include <algorithm>

#include "app/view/ui/viewer.h"
#include "renderer/vk/try.h"

namespace lacedring::view {

Viewer::Painted Viewer::wanted_paint() const {
    const double growth = state_.paint == Paint::growth ? std::min(state_.growth, state_.growth_end()) : 0;
    return {state_.selection.corner, state_.paint, static_cast<std::uint32_t>(growth), state_.document.get()};
}

bool Viewer::laid() const {
    return !state_.document || painted_ == wanted_paint();
}

Result<void> Viewer::take_paint_away() {
    laid_.reset();
    marked_ = kNullCorner;
    painted_ = {};
    LR_TRY(scene_.set_growth({}));
    return scene_.set_paint({});
}

/// What there is to lay over the triangles. While it is being made, what is laid there stays.
Result<void> Viewer::update_paint() {
    const Painted wanted = wanted_paint();
    if (wanted == painted_ || !state_.document) return {};
    const Result<std::shared_ptr<const Painting>> got = paintings_.get(state_.document, state_.paint);
    if (!got) {
        state_.error = got.error().message;
        state_.paint = Paint::none;  // not tried again every frame
        return {};
    }
    const std::shared_ptr<const Painting>& painting = *got;
    const bool made = painting || state_.paint == Paint::none;
    if (made && painting != laid_) {
        LR_TRY(scene_.set_paint(painting ? painting->colours : std::span<const std::uint32_t>{}));
        LR_TRY(scene_.set_growth(painting ? painting->growth : std::span<const gpu::GrowthTriangle>{}));
        laid_ = painting;
        marked_ = kNullCorner;
    }
    if (marked_ != state_.selection.corner) {
        LR_TRY(scene_.set_marks(selection_marks(*state_.document, state_.selection.corner)));
        marked_ = state_.selection.corner;
        compose_ = true;
    }
    // The last tenth of a second is told from what was invaded before, until all is done.
    const bool done = state_.growth >= state_.growth_end();
    scene_.grow(wanted.growth, done ? 0 : static_cast<std::uint32_t>(std::max(3.0, state_.growth_speed * 0.1)));
    if (made) painted_ = wanted;
    compose_ |= made;
    return {};
}

}  // namespace lacedring::view
