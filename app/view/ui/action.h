#pragma once
// What the viewer can be asked to do, by keys, mouse, panels and scripts alike.

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
    cancel,  ///< what is being done
    escape,  ///< closes help, else cancels, else clears selection and errors
    frame_selection,
    begin_ring,  ///< at the selected corner
    copy_camera,
    reload_shaders,
    close
};
/// Opens the first of the files that can be read.
struct Open {
    std::vector<std::string> paths;
};
/// Changes a choice. The value is one that the setting has.
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
// Pixels of the picture; zoom to a point, from its upper left corner.
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
/// From the selected corner to another: n p o s l r.
struct Step {
    char operation;
};
/// Empty: the first free name in the working folder. Likewise below.
struct SavePicture {
    std::string path;
    bool window = false;  ///< notices, too
};
/// A whole turn in so many pictures without panels, one a frame, each a PNG file in the folder, which is made if it is
/// not there.
struct SaveTurn {
    std::string folder;
    std::uint32_t pictures = 90;
};

}  // namespace action

using Action =
    std::variant<action::Do, action::Open, action::Set, action::FrameAll, action::LookFrom, action::Turn, action::Pan,
                 action::Zoom, action::Pick, action::Step, action::SavePicture, action::SaveTurn>;

}  // namespace lacedring::view
