#pragma once
// The viewer: takes events and actions, draws frames. It is independent of the window system, so that a script can
// drive it like a window.

#include <functional>
#include <limits>
#include <memory>
#include <utility>

#include "app/view/scene/orbit.h"
#include "app/view/ui/controls.h"
#include "app/view/ui/picture_size.h"
#include "app/view/ui/selecting.h"
#include "app/view/ui/shader_reload.h"
#include "app/view/ui/state.h"
#include "app/view/ui/turntable.h"
#include "app/view/window/event.h"
#include "app/view/window/overlay.h"

namespace lacedring::view {

struct ViewerOptions {
    Input input;                ///< path may be empty
    gpu::CameraOptions camera;  ///< used for the first mesh only
    double scale = 1;           ///< pixels per nominal pixel
    bool panels = true;
    std::uint32_t frame_cap = 60;  ///< frames per second; 0: no limit
    bool keep_recent = true;       ///< save the list of opened files
    /// Most seconds that drawing a picture at rest may take, estimated from its time with one sample; it gets fewer
    /// samples if needed. Scripts have no limit, so that their pictures do not depend on the machine.
    double patience = std::numeric_limits<double>::infinity();
    /// Called by other threads when they have something for the next frame.
    std::function<void()> wake = [] {};
    /// Folder of shader sources to watch; empty: the one that the program was built from.
    std::filesystem::path shaders;
};

class Viewer {
  public:
    /// `threads` must outlive the viewer. Threads that the viewer starts may outlive it.
    static Result<std::unique_ptr<Viewer>> create(gpu::Context& context, Threads& threads,
                                                  const ViewerOptions& options);

    void handle(const Event& event);
    /// Errors: those of the action, which then changes nothing.
    Result<void> perform(const Action& action);
    /// Advances by `seconds` and draws a frame; draws nothing while the picture has no size.
    Result<void> frame(double seconds);
    /// Call when the last frame is on the screen, `seconds` after it began.
    void presented(double seconds);

    /// The last frame with panels, in VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL.
    const gpu::Image& image() const { return overlay_->image(); }
    /// Size of the picture: the window's, or smaller with the same aspect ratio if the device cannot draw that.
    VkExtent2D extent() const { return size_.extent(); }
    VkExtent2D window() const { return size_.window(); }
    bool visible() const { return size_.visible(); }
    /// The last picture, with panels if they are on. Waits for the device.
    Result<gpu::Picture> picture();
    /// The whole window, also with notices. Waits for the device.
    Result<gpu::Picture> window_picture();

    bool closing() const { return closing_; }
    /// Stops the thread that uploads. Returns false if it still uses the device after `patience`; then nothing on the
    /// device may be destroyed.
    bool stop(std::chrono::milliseconds patience) { return scene_.stop(patience); }
    /// Animating: the next frame differs without input.
    bool moving() const { return quiet_frames_ <= 3 || animated(); }
    /// Nothing moves or is awaited: the next frame would be the same.
    bool idle() const { return !moving() && !busy() && !state_.facts.progress.busy && !has_update(); }
    /// Nothing is pending: only input changes the picture.
    bool settled() const;
    /// A whole turn is being saved.
    bool turning() const { return turn_.running(); }
    /// "NAME - LacedRing"
    std::string title() const;
    /// Returns text for the clipboard, once; else "".
    std::string take_clipboard() { return std::exchange(clipboard_, {}); }

    State& state() { return state_; }
    Orbit& orbit() { return orbit_; }
    Scene& scene() { return scene_; }
    /// Null: no shaders are watched.
    const ShaderWatch* shaders() const { return shaders_.watch(); }
    /// Direction from the eye through a pixel of the picture.
    Vector ray(double x, double y) const { return ray_through(scene_, orbit_, area(), x, y); }

  private:
    /// What must be done to bring the composed image up to date.
    enum class Freshness { redraw, compose, current };

    Viewer(gpu::Context& context, Threads& threads, const ViewerOptions& options, Scene scene)
        : options_(options),
          context_(context),
          threads_(threads),
          scene_(std::move(scene)),
          loader_(threads, options.wake),
          paint_(threads) {}

    Result<void> on(action::Do what);
    Result<void> on(const action::Open& open);
    Result<void> on(const action::Set& set);
    Result<void> on(const action::FrameAll& all);
    Result<void> on(const action::LookFrom& from);
    Result<void> on(const action::Turn& turn);
    Result<void> on(const action::Pan& pan);
    Result<void> on(const action::Zoom& zoom);
    Result<void> on(const action::Pick& pick);
    Result<void> on(const action::Step& step);
    Result<void> on(const action::SavePicture& save);
    Result<void> on(const action::SaveTurn& save);

    bool has_update() const { return loader_.has_update() || update_.document || shaders_.has_update(); }
    bool animated() const;
    bool busy() const;
    /// Returns whether another ring or weld is chosen than was asked for.
    bool ring_due() const { return state_.choices.ring != asked_ || state_.choices.weld != asked_weld_; }
    bool difference_due() const { return scene_.drawn().mode != Mode::single && !state_.facts.difference; }
    void tell_error(const Result<void>& result);
    void stale(Freshness freshness) { freshness_ = std::min(freshness_, freshness); }
    void camera_moved();
    /// One pass and one sample; exact with one sample; exact with all samples.
    enum class Quality { rough, exact, fine };
    Shown shown(Quality quality) const;
    Shown shown(Quality quality, const gpu::Model& model) const;
    PaintLayer::Wanted wanted_paint() const;

    PictureArea area() const { return {static_cast<double>(extent().width), static_cast<double>(extent().height)}; }
    Result<void> resize();
    void cancel();
    void escape();
    void begin_ring();
    void open_next();
    void take_news();
    void take_document();
    void opened(const Document& document);
    void act();
    void advance(double seconds);
    void update_outlines();
    void update_paint();
    Result<bool> prepare(const Shown& picture);
    Result<void> draw();
    void tell_materials();
    void save_turn_picture();
    void end_turn();
    Result<void> compare();

    ViewerOptions options_;
    gpu::Context& context_;
    Threads& threads_;
    Scene scene_;
    std::unique_ptr<Overlay> overlay_;
    std::optional<gpu::Commands> commands_;
    State state_;
    Orbit orbit_;
    Controls controls_;
    Loader loader_;
    Loader::Update update_;  // arrived, but not shown yet
    ShaderReload shaders_;
    PaintLayer paint_;
    TurnSaver turn_;
    RingSettings asked_;  // of the last request to the loader
    Weld asked_weld_ = Weld::position;
    std::vector<std::string> queue_;  // files to try if the current one fails

    PictureSize size_;
    Selecting selecting_;
    Freshness freshness_ = Freshness::redraw;
    // Divider of the composed image: the first column of the right picture.
    double divider_ = 0;
    const OwningModel* drawn_model_ = nullptr;  // in the last picture
    // Seconds for the last exact picture with one sample, and with several.
    double exact_seconds_ = 0, fine_seconds_ = 1;
    // Seconds since the camera moved; -1: it has moved since the last frame.
    double still_seconds_ = 1;
    int quiet_frames_ = 0;  // frames since the last event
    const gpu::GpuMaterials* told_materials_ = nullptr;
    std::shared_ptr<const Tables> outlined_;  // the tables whose outlines are drawn
    const Document* presented_ = nullptr;     // the last document that was on the screen
    std::chrono::steady_clock::time_point presented_asked_{};
    std::string clipboard_;
    bool closing_ = false;
};

}  // namespace lacedring::view
