// What keys and the mouse do. docs/viewer.md lists it for people, draw_help (panels.cpp) for people in a hurry.
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/view/ui/viewer.h"
#include "app/view/window/theme.h"

namespace lacedring::view {
namespace {

constexpr double kClick = 4;  // nominal pixels that a click may stray

/// As f3d: 1 front, 3 right, 7 top, 9 three-quarter; with control the other side.
std::optional<Vector> side(int key, const Vector& up) {
    const bool z_up = std::abs(up[2]) > 0.7;
    const Vector front = z_up ? Vector{0, -1, 0} : Vector{0, 0, 1};
    const Vector right{1, 0, 0};
    switch (key) {
        case '1':
            return front;
        case '3':
            return right;
        case '7':
            return Vector{up[0] + 1e-4 * front[0], up[1] + 1e-4 * front[1], up[2] + 1e-4 * front[2]};
        case '9':
            return Vector{0.5 * right[0] + 0.8 * front[0] + 0.4 * up[0], 0.5 * right[1] + 0.8 * front[1] + 0.4 * up[1],
                          0.5 * right[2] + 0.8 * front[2] + 0.4 * up[2]};
        default:
            return std::nullopt;
    }
}

}  // namespace

void Viewer::handle(const Event& in_window) {
    quiet_frames_ = 0;
    Event event = in_window;
    if ((event.kind == Event::move || event.kind == Event::button) && visible()) {
        event.x *= static_cast<double>(extent_.width) / window_.width;
        event.y *= static_cast<double>(extent_.height) / window_.height;
    }
    Overlay::feed(event);
    switch (event.kind) {
        case Event::resize:
            largest_ = context_.limits().maxImageDimension2D;
            set_window({static_cast<std::uint32_t>(std::max(0.0, event.x)),
                        static_cast<std::uint32_t>(std::max(0.0, event.y))});
            break;
        case Event::close:
            closing_ = true;
            break;
        case Event::drop:
            // The first of them that can be read is shown.
            queue_.assign(event.paths.begin(), event.paths.end());
            if (queue_.empty()) break;
            state_.error.clear();
            state_.open = queue_.front();
            queue_.erase(queue_.begin());
            break;
        case Event::key:
            if (event.down && !ImGui::GetIO().WantTextInput) handle_key(event);
            break;
        case Event::move:
        case Event::button:
        case Event::scroll:
            handle_mouse(event);
            break;
        default:
            break;
    }
}

void Viewer::handle_key(const Event& event) {
    const bool control = (event.modifiers & mod_control) != 0, shift = (event.modifiers & mod_shift) != 0;
    const auto note = [&](const char* text) { state_.tell(text); };
    switch (event.code) {
        case key_escape:
            if (state_.help) {
                state_.help = false;
            } else if (state_.turntable_job || (state_.progress.busy && !state_.progress.background)) {
                state_.cancel = true;
            } else {
                state_.selection = {};
                state_.error.clear();
                state_.shaders.error.clear();
            }
            return;
        case '/':  // with shift: ?
        case key_f1:
        case 'H':
            state_.help = !state_.help;
            return;
        case key_tab:
            state_.panels = !state_.panels;
            return;
        case key_home:
        case key_enter:
        case 'F':
            state_.frame_all = true;
            return;
        case '.':
            state_.frame_selection = true;
            return;
        case 'T':
            (shift ? state_.turntable_pictures : state_.turntable) ^= true;
            return;
        case key_f5:
            state_.reload_shaders = true;
            return;
        case key_f12:
            state_.screenshot = true;
            return;
        case 'Q':
            if (control) closing_ = true;
            return;
        case 'C':
            if (control) state_.copy_camera = true;
            return;
        case 'D':
            state_.shown.mode = state_.shown.mode == Mode::difference ? Mode::single : Mode::difference;
            state_.choices_changed = true;
            return;
        case 'X':
            state_.shown.mode = state_.shown.mode == Mode::split ? Mode::single : Mode::split;
            state_.choices_changed = true;
            return;
        case 'G':
            state_.paint = Paint::growth;
            state_.growth = 0;
            state_.growing = true;
            return;
        case 'B':
            if (state_.selection.any()) {
                note("the ring begins at the selected corner");
            } else {
                note(state_.ring.start.is_null() ? "click a triangle first" : "the ring begins at the first triangle");
            }
            state_.ring.start = state_.selection.corner;
            return;
        case 'V': {
            const auto at = std::ranges::find(kViews, state_.shown.view, &gpu::Named<gpu::View>::value);
            const auto i = static_cast<std::size_t>(at - kViews.begin());
            state_.shown.view = kViews[(i + (shift ? kViews.size() - 1 : 1)) % kViews.size()].value;
            state_.choices_changed = true;
            return;
        }
        case 'N':
        case 'P':
        case 'O':
        case 'S':
        case 'L':
        case 'R':
            if (state_.selection.any()) {
                state_.step = static_cast<char>(event.code - 'A' + 'a');
            } else {
                note("click a triangle first");
            }
            return;
        default:
            break;
    }
    if (std::optional<Vector> from = side(event.code, orbit_.options().up)) {
        if (control) {
            for (double& x : *from) x = -x;
        }
        orbit_.look_from(*from);
        dirty_ = true;
    }
}

void Viewer::handle_mouse(const Event& event) {
    const double height = extent_.height, width = extent_.width;
    const bool over_panel = ImGui::GetIO().WantCaptureMouse && dragging_ < 0 && !dragging_divider_;
    const auto from_middle_x = [&](double x) { return x + 0.5 - width / 2; };
    const auto from_middle_y = [&](double y) { return height / 2 - y - 0.5; };
    const double divider_x = state_.divider * width;
    if (event.kind == Event::scroll) {
        if (over_panel) return;
        orbit_.zoom(std::pow(1.15, event.y), from_middle_x(mouse_x_), from_middle_y(mouse_y_), height, width);
        dirty_ = moved_ = true;
        return;
    }
    if (event.kind == Event::button) {
        mouse_x_ = event.x;
        mouse_y_ = event.y;
        if (event.down) {
            if (over_panel || dragging_ >= 0) return;
            press_x_ = event.x;
            press_y_ = event.y;
            if (event.code == 0 && state_.shown.mode == Mode::split && std::abs(event.x - divider_x) < px(6)) {
                dragging_divider_ = true;
                return;
            }
            // Left turns, with shift it pans and with control it zooms; middle pans; right zooms.
            const bool shift = (event.modifiers & mod_shift) != 0, control = (event.modifiers & mod_control) != 0;
            dragging_ = event.code == 0 ? (shift ? 2 : control ? 1 : 0) : event.code;
            return;
        }
        const bool clicked = std::hypot(event.x - press_x_, event.y - press_y_) < px(kClick);
        if (dragging_ == 0 && event.code == 0 && clicked) pick(event.x, event.y);
        dragging_ = -1;
        dragging_divider_ = false;
        return;
    }
    const double dx = event.x - mouse_x_, dy = event.y - mouse_y_;
    mouse_x_ = event.x;
    mouse_y_ = event.y;
    if (dragging_divider_) {
        state_.divider = std::clamp(event.x / std::max(1.0, width), 0.0, 1.0);
        compose_ = true;
        return;
    }
    if (dragging_ < 0 || std::hypot(event.x - press_x_, event.y - press_y_) < px(kClick)) return;
    if (dragging_ == 0) orbit_.turn(dx, dy, height);
    if (dragging_ == 1) orbit_.zoom(std::exp(-dy * 4 / std::max(1.0, height)), 0, 0, height, width);
    if (dragging_ == 2) orbit_.pan(dx, dy, height, width);
    dirty_ = moved_ = true;
}

Vector Viewer::ray(double x, double y) const {
    // Through the middle of the sample that triangle_at reads.
    const double n = std::max(1U, made_samples_);
    const double within = (std::floor(n / 2) + 0.5) / n;
    return orbit_.ray(std::floor(x) + within - extent_.width / 2.0, extent_.height / 2.0 - std::floor(y) - within,
                      extent_.height, extent_.width);
}

void Viewer::pick(double x, double y) {
    if (!state_.document || x < 0 || y < 0 || x >= extent_.width || y >= extent_.height) return;
    const bool right = drawn_.mode == Mode::split && x >= state_.divider * extent_.width;
    const Result<std::optional<std::uint32_t>> hit =
        scene_.triangle_at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), right);
    if (!hit) {
        state_.error = hit.error().message;
        return;
    }
    state_.selection = {};
    if (!*hit || **hit >= state_.document->mesh->triangle_count()) return;
    std::uint32_t t = **hit;
    const Vector along = ray(x, y);
    // A device rounds vertices to parts of a pixel: near an edge the ray through the sample may meet the neighbour.
    if (!ray_meets(*state_.document, t, orbit_.eye(), along)) {
        t = ray_hit(*state_.document, orbit_.eye(), along).value_or(t);
    }
    state_.selection.corner = nearest_corner(*state_.document, t, orbit_.eye(), along);
}

}  // namespace lacedring::view
