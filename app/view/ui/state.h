#pragma once
// What was chosen, what the session knows, and what panels ask for. No window, no device.

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

/// Which side panel is open where the window is too narrow for both.
enum class Drawer { none, choices, numbers };

enum class Weld { position, attributes, none };

/// What a person, a script or the command line chose. settings.h gives most of it by name.
struct Choices {
    Shown shown;
    bool view_chosen = false;  ///< else files with materials are drawn with them
    double divider = 0.5;      ///< of the picture's width
    RingSettings ring;
    Weld weld = Weld::position;
    Paint paint = Paint::none;
    bool ring_line = true;  ///< over views that do not show the ring
    bool outlines = false;  ///< silhouettes, borders and creases, from adjacency alone
    bool panels = true;
    Drawer drawer = Drawer::none;
    bool help = false;
    bool turntable = false;
    double turntable_speed = 20;   ///< degrees a second
    std::uint32_t frame_cap = 60;  ///< frames a second; 0: as many as there can be
    // The ring-expander, corner by corner.
    double growth = 0;          ///< triangles so far
    double growth_speed = 500;  ///< triangles a second
    bool growing = false;

    bool has_outlines() const { return outlines || shown.view == gpu::View::silhouette; }
    /// Colors and lines laid over the surface.
    Layers layers() const;
};

/// Milliseconds of one drawn frame.
struct FrameCost {
    float decode = 0;  ///< on the device
    float draw = 0;    ///< on the device
    float cpu = 0;     ///< of our own thread, without waiting for the device
};

struct ShaderFacts {
    std::string folder;          ///< watched; empty: none
    std::string error;           ///< why the last edit is not drawn with
    std::uint32_t compiled = 0;  ///< so far
    std::uint32_t reloads = 0;   ///< how often pipelines were recreated
    std::uint32_t replaced = 0;  ///< shaders in use that are not as built in
    std::uint64_t looks = 0;     ///< at their files
};

/// Part of the window, in pixels.
struct Area {
    double left = 0, top = 0, right = 0, bottom = 0;
};

/// What the session knows.
struct Facts {
    std::shared_ptr<const Document> document;
    std::shared_ptr<const Tables> tables;
    std::shared_ptr<const app::FormatSet> formats;
    std::string error;
    std::string note;       ///< something short that happened: "saved ..."
    double note_until = 0;  ///< seconds of `clock`
    double clock = 0;
    Loader::Progress progress;
    std::deque<FrameCost> costs;
    double frame_seconds = 0;  ///< the last picture drawn anew: recorded, drawn, composed, panels
    double first_seconds = 0;  ///< from asking for a file or a ring until something of it was on the screen
    double shown_seconds = 0;  ///< from asking for the document until it was on the screen
    double longest_frame = 0;  ///< seconds from a look at the events to the picture that answers them
    double started = 0;        ///< seconds from the program's start to its first picture
    std::uint64_t device_bytes = 0, device_held = 0;  ///< in use; allocated
    Area free;                                        ///< of the window: not under a panel
    bool window_too_large = false;                    ///< for the device, which shows nothing in it
    std::uint32_t samples = 0;                        ///< along each side of a pixel that a picture at rest has
    std::string device;
    bool mesh_shaders = false;
    std::optional<gpu::Difference> difference;
    std::vector<std::string> files, recent, sample_files;
    Selection selection;
    ShaderFacts shaders;

    /// Shows a short message for so many seconds.
    void tell(std::string text, double seconds = 2) {
        note = std::move(text);
        note_until = clock + seconds;
    }
    /// Triangles that the ring-expander invades.
    double growth_end() const { return document ? static_cast<double>(document->expansion->corners.size()) : 0.0; }
};

struct State {
    Choices choices;
    Facts facts;
    std::vector<Action> actions;  ///< asked for by panels, done after they are drawn

    void ask(Action action) { actions.push_back(std::move(action)); }
};

}  // namespace lacedring::view
