#pragma once
// What the person chose, what there is to show, and what the panels ask for. No window, no device.

#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/view/scene/painting.h"
#include "app/view/scene/scene.h"
#include "app/view/scene/selection.h"
#include "app/view/session/document.h"
#include "app/view/session/loader.h"

namespace lacedring::view {

/// Milliseconds of one drawn frame.
struct FrameCost {
    float decode = 0;  ///< on the device
    float draw = 0;    ///< on the device
    float cpu = 0;     ///< of our own thread, without waiting for the device
};

/// Which side panel is open where the window is too narrow for both.
enum class Drawer { none, choices, numbers };

struct State {
    // Chosen.
    Shown shown;
    double divider = 0.5;  ///< of the picture's width
    std::uint32_t samples = 1;
    RingSettings ring;
    Paint paint = Paint::none;
    bool outlines = false;  ///< silhouettes, borders and creases, from adjacency alone
    bool panels = true;
    Drawer drawer = Drawer::none;
    bool help = false;
    bool turntable = false;
    double turntable_speed = 20;   ///< degrees a second
    std::uint32_t frame_cap = 60;  ///< pictures a second; 0: as many as there can be
    // The ring-expander, corner by corner.
    double growth = 0;          ///< triangles so far
    double growth_speed = 500;  ///< triangles a second
    bool growing = false;

    // There.
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
    double covered_below = 0;                         ///< pixels of the window under bar and selection
    bool window_too_large = false;                    ///< for the device, which shows nothing in it
    std::string device;
    bool mesh_shaders = false;
    std::optional<gpu::Difference> difference;
    std::vector<std::string> files, recent, sample_files;
    Selection selection;
    struct TurntableJob {
        std::string folder;
        std::uint32_t pictures = 0, done = 0;
    };
    std::optional<TurntableJob> turntable_job;  ///< pictures being written

    /// Tells something short for so many seconds.
    void tell(std::string text, double seconds = 2) {
        note = std::move(text);
        note_until = clock + seconds;
    }

    /// How far the ring-expander goes: triangles.
    double growth_end() const { return document ? static_cast<double>(document->expansion->corners.size()) : 0.0; }
    struct Shaders {
        std::string folder;          ///< watched; empty: none
        std::string error;           ///< why what was edited last is not drawn with
        std::uint32_t compiled = 0;  ///< so far
        std::uint32_t reloads = 0;   ///< how often pipelines were made anew
        std::uint32_t replaced = 0;  ///< shaders in use that are not as built in
        std::uint64_t looks = 0;     ///< at their files
    } shaders;

    // Asked for by panels and keys; the viewer does it and takes it away.
    std::optional<std::string> open;
    bool cancel = false;
    bool frame_all = false;
    bool frame_selection = false;
    bool copy_camera = false;
    bool screenshot = false;
    bool turntable_pictures = false;
    bool reload_shaders = false;
    bool choices_changed = false;  ///< the picture must be drawn again
    std::optional<char> step;      ///< n p o s l r: from the selected corner to another
};

}  // namespace lacedring::view
