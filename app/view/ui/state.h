#pragma once
// The viewer's state: what the user chose, what the program knows, and the actions that panels ask for.

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "app/view/scene/painting.h"
#include "app/view/scene/scene.h"
#include "app/view/scene/selection.h"
#include "app/view/session/document.h"
#include "app/view/session/loader.h"
#include "app/view/ui/action.h"

namespace lacedring::view {

/// The side panel that is open in a window too narrow for both.
enum class Drawer { none, choices, numbers };

enum class Weld { position, attributes, none };

/// Choices of the user, a script or the command line. settings.h gives most of them by name.
struct Choices {
    Shown shown;
    /// A view was chosen; else files with materials are shown with them.
    bool view_chosen = false;
    /// Position of the divider, as a fraction of the picture's width.
    double divider = 0.5;
    RingSettings ring;
    Weld weld = Weld::position;
    Paint paint = Paint::none;
    /// Draw the ring over views that do not show it.
    bool ring_line = true;
    bool outlines = false;  ///< draw silhouettes, borders and creases
    bool panels = true;
    Drawer drawer = Drawer::none;
    bool help = false;
    bool turntable = false;
    double turntable_speed = 20;   ///< degrees per second
    std::uint32_t frame_cap = 60;  ///< frames per second; 0: no limit
    // Watching the ring-expander.
    double growth = 0;          ///< triangles invaded so far
    double growth_speed = 500;  ///< triangles per second
    bool growing = false;

    bool has_outlines() const { return outlines || shown.view == gpu::View::silhouette; }
    /// Colors and lines laid over the surface.
    Layers layers() const;
};

/// Milliseconds of one drawn frame.
struct FrameCost {
    float decode = 0;  ///< on the device
    float draw = 0;    ///< on the device
    /// Time of the drawing thread, without waiting for the device.
    float cpu = 0;
};

struct ShaderFacts {
    std::string folder;          ///< watched; empty: none
    std::string error;           ///< why the last edit is not in use
    std::uint32_t compiled = 0;  ///< shaders compiled so far
    /// Number of times that pipelines were recreated.
    std::uint32_t reloads = 0;
    /// Shaders in use that differ from the built-in ones.
    std::uint32_t replaced = 0;
    std::uint64_t checks = 0;  ///< completed checks of their files
};

/// Part of the window, in pixels.
struct Area {
    double left = 0, top = 0, right = 0, bottom = 0;
};

/// What the program knows and shows.
struct Facts {
    std::shared_ptr<const Document> document;
    std::shared_ptr<const Tables> tables;
    std::shared_ptr<const app::FormatSet> formats;
    std::string error;
    std::string note;       ///< a short message: "saved ..."
    double note_until = 0;  ///< shown until `clock` reaches this
    double clock = 0;       ///< seconds since the start
    Loader::Progress progress;
    std::deque<FrameCost> costs;
    /// Time of the last newly drawn frame, panels included.
    double frame_seconds = 0;
    /// From requesting a file or a ring until its first document was on the screen.
    double first_seconds = 0;
    /// From the request of the current document until it was on the screen.
    double shown_seconds = 0;
    /// Seconds from handling events to showing the resulting frame.
    double longest_frame = 0;
    /// Seconds from the program's start to its first frame.
    double started = 0;
    std::uint64_t device_bytes = 0;  ///< memory in use
    std::uint64_t device_held = 0;   ///< memory allocated
    Area free;                       ///< the part not covered by panels
    bool window_too_large = false;   ///< the device cannot show such a window
    /// Samples along each side of a pixel, for pictures at rest.
    std::uint32_t samples = 0;
    std::string device;
    bool mesh_shaders = false;
    std::optional<gpu::Difference> difference;
    std::vector<std::string> files, recent, sample_files;
    Selection selection;
    ShaderFacts shaders;

    /// Shows a short message for some seconds.
    void tell(std::string text, double seconds = 2) {
        note = std::move(text);
        note_until = clock + seconds;
    }
    /// Number of triangles that the ring-expander invades in the end.
    double growth_end() const { return document ? static_cast<double>(document->expansion->corners.size()) : 0.0; }
};

struct State {
    Choices choices;
    Facts facts;
    /// Asked for by panels, performed after they are drawn.
    std::vector<Action> actions;

    void ask(Action action) { actions.push_back(std::move(action)); }
};

}  // namespace lacedring::view
