// The keys and mouse actions are also listed in docs/viewer.md and panel_help.cpp.
#include "app/view/ui/controls.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/view/ui/settings.h"
#include "app/view/window/theme.h"

namespace lacedring::view {
namespace {

// Nominal pixels that the mouse may move during a click.
constexpr double kClick = 4;

/// The direction for a digit key, as in f3d: 1 front, 3 right, 7 top, 9 three-quarter.
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
            return up + front * 1e-4;
        case '9':
            return right * 0.5 + front * 0.8 + up * 0.4;
        default:
            return std::nullopt;
    }
}

std::optional<Action> key_action(const Event& event, const Choices& choices, const Vector& up) {
    const bool control = (event.modifiers & mod_control) != 0, shift = (event.modifiers & mod_shift) != 0;
    switch (event.code) {
        case key_escape:
            return action::Do::escape;
        case '/':  // with shift: ?
        case key_f1:
        case 'H':
            return toggle(choices, "help");
        case key_tab:
            return toggle(choices, "panels");
        case key_home:
        case key_enter:
        case 'F': {
            action::FrameAll all;
            all.camera.up = up;
            return all;
        }
        case '.':
            return action::Do::frame_selection;
        case 'T':
            if (shift) return action::SaveTurn{};
            return toggle(choices, "turntable");
        case key_f5:
            return action::Do::reload_shaders;
        case key_f12:
            return action::SavePicture{};
        case 'Q':
            if (control) return action::Do::close;
            return std::nullopt;
        case 'C':
            if (control) return action::Do::copy_camera;
            return std::nullopt;
        case 'D':
            return toggle(choices, "mode", "difference", "single");
        case 'X':
            return toggle(choices, "mode", "split", "single");
        case 'E':
            return toggle(choices, "ring-line");
        case 'G':
            return set("paint", "growth");
        case 'B':
            return action::Do::begin_ring;
        case 'V':
            return cycle(choices, "view", shift);
        case 'N':
        case 'P':
        case 'O':
        case 'S':
        case 'L':
        case 'R':
            return action::Step{static_cast<char>(event.code - 'A' + 'a')};
        default:
            break;
    }
    const std::optional<Vector> from = side(event.code, up);
    if (!from) return std::nullopt;
    return action::LookFrom{control ? *from * -1 : *from};
}

}  // namespace

void Controls::handle(const Event& event, const State& state, VkExtent2D extent, const Vector& up,
                      const std::function<void(Action)>& perform) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool over_panel = io.WantCaptureMouse && drag_ == Drag::none;
    const double width = std::max(1U, extent.width), height = std::max(1U, extent.height);
    const auto strayed = [&] { return std::hypot(event.x - press_x_, event.y - press_y_) >= px(kClick); };
    if (event.kind == Event::key) {
        if (!event.down || io.WantTextInput) return;
        if (std::optional<Action> action = key_action(event, state.choices, up)) perform(std::move(*action));
    } else if (event.kind == Event::scroll) {
        if (!over_panel) perform(action::Zoom{std::pow(1.15, event.y), x_, y_});
    } else if (event.kind == Event::button && event.down) {
        x_ = event.x;
        y_ = event.y;
        if (over_panel || drag_ != Drag::none) return;
        press_x_ = event.x;
        press_y_ = event.y;
        const bool shift = (event.modifiers & mod_shift) != 0, control = (event.modifiers & mod_control) != 0;
        const bool divider = state.choices.shown.mode == Mode::split &&
                             std::abs(event.x - state.choices.divider * width) < static_cast<double>(px(6));
        drag_ = event.code == 1   ? Drag::zoom
                : event.code == 2 ? Drag::pan
                : divider         ? Drag::divider
                : shift           ? Drag::pan
                : control         ? Drag::zoom
                                  : Drag::turn;
    } else if (event.kind == Event::button) {
        x_ = event.x;
        y_ = event.y;
        const bool click = drag_ == Drag::turn && event.code == 0 && !strayed();
        drag_ = Drag::none;
        if (click) perform(action::Pick{event.x, event.y});
    } else if (event.kind == Event::move) {
        const double dx = event.x - x_, dy = event.y - y_;
        x_ = event.x;
        y_ = event.y;
        if (drag_ == Drag::divider) perform(set("divider", std::clamp(event.x / width, 0.0, 1.0)));
        if (drag_ == Drag::none || drag_ == Drag::divider || !strayed()) return;
        if (drag_ == Drag::turn) perform(action::Turn{dx, dy});
        if (drag_ == Drag::pan) perform(action::Pan{dx, dy});
        if (drag_ == Drag::zoom) perform(action::Zoom{std::exp(-dy * 4 / height), width / 2 - 0.5, height / 2 - 0.5});
    }
}

}  // namespace lacedring::view
