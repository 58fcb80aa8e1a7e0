#pragma once
// Actions of the viewer, for keys, mouse, panels and scripts.

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "app/view/session/vector.h"
#include "renderer/draw/camera.h"

namespace lacedring::view {

struct Setting;

namespace action {

enum class Do {
    cancel,  ///< stops loading, or saving a turn
    escape,  ///< closes help, else cancels, else clears selection and errors
    frame_selection,
    begin_ring,  ///< at the selected corner
    copy_camera,
    reload_shaders,
    close
};
/// Opens the first file that can be read.
struct Open {
    std::vector<std::string> paths;
};
/// Sets a choice to a valid value of its setting.
struct Set {
    const Setting* setting;
    double value;
};
struct FrameAll {
    gpu::CameraOptions camera;
};
struct LookFrom {
    Vector direction;
};
// Camera movements, in pixels of the picture. Zoom keeps the point x, y, from the upper left corner, in place.
struct Turn {
    double dx, dy;
};
struct Pan {
    double dx, dy;
};
struct Zoom {
    double factor, x, y;
};
/// Selects the corner nearest to a pixel.
struct Pick {
    double x, y;
};
/// Moves the selection by an operator: n, p, o, s, l or r.
struct Step {
    char operation;
};
/// Saves the picture as a PNG file.
struct SavePicture {
    /// Empty: the first free name in the working folder.
    std::string path;
    bool window = false;  ///< with panels and notices
};
/// Saves a whole turn without panels, one picture per frame, as PNG files in a folder, which is created if missing.
struct SaveTurn {
    /// Empty: the first free name in the working folder.
    std::string folder;
    std::uint32_t pictures = 90;
};

}  // namespace action

using Action =
    std::variant<action::Do, action::Open, action::Set, action::FrameAll, action::LookFrom, action::Turn, action::Pan,
                 action::Zoom, action::Pick, action::Step, action::SavePicture, action::SaveTurn>;

}  // namespace lacedring::view
