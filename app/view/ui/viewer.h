#pragma once
// The viewer: events in, frames out. Knows of no window system, so that a script drives it as a window does.

#include <functional>
#include <memory>
#include <utility>

#include "app/view/scene/orbit.h"
#include "app/view/scene/painting.h"
#include "app/view/session/shader_watch.h"
#include "app/view/ui/state.h"
#include "app/view/window/event.h"
#include "app/view/window/overlay.h"

namespace lacedring::view {

struct ViewerOptions {
    Input input;                ///< path may be empty
    gpu::CameraOptions camera;  ///< for the first mesh
    double scale = 1;           ///< pixels a nominal pixel
    bool panels = true;
    std::uint32_t frame_cap = 60;  ///< pictures a second, 0: none
    bool keep_recent = true;       ///< files that were opened are remembered
    /// Called by other threads when they have something for the next frame.
    std::function<void()> wake = [] {};
    std::filesystem::path shaders;  ///< folder of sources to be watched; empty: those that the program was built from
};

class Viewer {
  public:
    /// `threads` must outlive the viewer; those that it starts may outlive it.
    static Result<std::unique_ptr<Viewer>> create(gpu::Context& context, Threads& threads,
                                                  const ViewerOptions& options);

    void handle(const Event& event);
    /// Everything for one picture `seconds` after the last one. Nothing is drawn while the picture has no size.
    Result<void> frame(double seconds);

    /// The last picture is on the screen, `seconds` after its frame began.
    void presented(double seconds);

    /// The last picture, panels and all, in VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL.
    const gpu::Image& image() const { return overlay_->image(); }
    /// Pixels of the picture: the window's, or fewer of the same shape where the device draws no picture that large.
    VkExtent2D extent() const { return extent_; }
    VkExtent2D window() const { return window_; }
    bool visible() const { return extent_.width != 0 && extent_.height != 0; }
    /// The last picture, with panels if they are on; else with nothing over it. Waits for the device.
    Result<gpu::Picture> picture() {
        return picture_of(state_.panels || state_.help ? overlay_->image() : scene_.composed());
    }
    /// All that is in the window, notices too.
    Result<gpu::Picture> window_picture() { return picture_of(overlay_->image()); }

    bool closing() const { return closing_; }
    /// Stops what threads do for it. False: one of them still uses the device after `patience`, and nothing on the
    /// device may be destroyed.
    bool stop(std::chrono::milliseconds patience) { return scene_.stop(patience); }
    /// The next picture will be another one by itself.
    bool moving() const { return quiet_frames_ <= 3 || animated_; }
    /// Nothing moves, nothing is awaited: the next picture would be the last one.
    bool idle() const { return !moving() && !busy_ && !state_.progress.busy && !news(); }
    /// The mesh as it was drawn is as it will stay, but for what a person does.
    bool settled() const { return settled_; }
    /// "NAME - LacedRing"
    std::string title() const;
    /// What is to be put on the clipboard, once.
    std::string take_clipboard() { return std::exchange(clipboard_, {}); }
    void save(const std::string& path);
    /// Begins a whole turn in so many pictures without panels, one a frame, each a PNG file in the folder, which is
    /// made if it is not there. Nothing else may turn the camera meanwhile. Errors: cannot_write, invalid_argument.
    Result<void> start_turntable(const std::string& folder, std::uint32_t pictures);

    State& state() { return state_; }
    Orbit& orbit() { return orbit_; }
    Scene& scene() { return scene_; }
    /// Null: there are no sources of shaders.
    const ShaderWatch* shaders() const { return watch_.get(); }
    /// From a point of the picture.
    Vector ray(double x, double y) const;
    void pick(double x, double y);
    Result<void> frame_all(const gpu::CameraOptions& options);

  private:
    Viewer(gpu::Context& context, Threads& threads, const ViewerOptions& options, Scene scene)
        : options_(options),
          context_(context),
          threads_(threads),
          scene_(std::move(scene)),
          loader_(threads, options.wake),
          paintings_(threads) {}
    bool news() const { return loader_.has_news() || news_.document || (watch_ && watch_->has_news()); }
    Result<void> resize();
    Result<void> make_images(std::uint32_t samples);
    void set_window(VkExtent2D window);
    Shown shown(bool moving, const gpu::Model* model) const;
    void take_news();
    void take_document();
    Result<bool> prepare(const Shown& picture);
    void watch_shaders();
    void take_shaders();
    void handle_mouse(const Event& event);
    void handle_key(const Event& event);
    void act();
    void opened(const std::string& path);
    void update_outlines();
    Result<void> update_paint();
    Result<void> take_paint_away();
    void advance(double seconds);
    Result<void> draw();
    /// Of the window's size, in VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL.
    Result<gpu::Picture> picture_of(const gpu::Image& image);
    void aim_turntable();
    void save_turntable_picture();
    void end_turntable();
    Result<void> compare();

    ViewerOptions options_;
    gpu::Context& context_;
    Threads& threads_;
    Scene scene_;
    std::unique_ptr<Overlay> overlay_;
    std::optional<gpu::Commands> commands_;
    State state_;
    Orbit orbit_;
    Loader loader_;
    std::unique_ptr<ShaderWatch> watch_;
    RingSettings asked_;
    std::vector<std::string> queue_;  // dropped, to be tried in turn

    VkExtent2D window_{}, extent_{}, made_{};
    std::uint32_t largest_ = 0;  // side of a picture; less than the device's limit where its memory does not hold that
    std::uint32_t made_samples_ = 0;
    int dragging_ = -1;
    bool dragging_divider_ = false;
    double mouse_x_ = 0, mouse_y_ = 0, press_x_ = 0, press_y_ = 0;
    bool dirty_ = true, compose_ = true, moved_ = false, settled_ = false, closing_ = false, busy_ = false,
         animated_ = false;
    bool difference_due_ = false;
    bool fresh_ = false;        // the model has not been drawn yet
    Shown drawn_;               // the last picture
    double exact_seconds_ = 0;  // that the last exact one took
    double still_seconds_ = 1;  // since the camera moved; 0: in this frame
    int quiet_frames_ = 0;
    Loader::News news_;  // not on the screen yet
    Paintings paintings_;
    std::shared_ptr<const Painting> laid_;  // what is laid over the triangles; kept until its successor is made
    struct Painted {
        CornerId corner = kNullCorner;
        Paint paint = Paint::none;
        std::uint32_t growth = 0;
        const Document* document = nullptr;
        bool operator==(const Painted&) const = default;
    } painted_;
    Painted wanted_paint() const;
    bool laid() const;
    CornerId marked_ = kNullCorner;  // the corner whose marks are laid
    Orbit before_turntable_;
    const Tables* outlined_ = nullptr;  // whose outlines are drawn
    const Document* shown_ = nullptr;   // was on the screen
    std::chrono::steady_clock::time_point shown_asked_{};
    std::string clipboard_;
};

}  // namespace lacedring::view
