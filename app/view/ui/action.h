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

/// Opens the first of the files that can be read.
struct Open {
    std::vector<std::string> paths;
};
/// Changes a choice. The value is one that the setting has.
struct Set {
    const Setting* setting;
    double value;
};
/// Cancels what is being done.
struct Cancel {};
/// Closes help, else cancels, else clears selection and errors.
struct Escape {};
struct FrameAll {
    gpu::CameraOptions camera;
};
struct FrameSelection {};
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
/// Begins the ring at the selected corner.
struct BeginRing {};
struct CopyCamera {};
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
struct ReloadShaders {};
struct Close {};

}  // namespace action

using Action = std::variant<action::Open, action::Set, action::Cancel, action::Escape, action::FrameAll,
                            action::FrameSelection, action::LookFrom, action::Turn, action::Pan, action::Zoom,
                            action::Pick, action::Step, action::BeginRing, action::CopyCamera, action::SavePicture,
                            action::SaveTurn, action::ReloadShaders, action::Close>;

}  // namespace lacedring::view
