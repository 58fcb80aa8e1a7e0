#pragma once
// The viewer: events in, frames out. Knows of no window system, so that a script drives it as a window does.

#include <memory>
#include <utility>

#include "app/view/event.h"
#include "app/view/orbit.h"
#include "app/view/overlay.h"
#include "app/view/shader_watch.h"
#include "app/view/state.h"

namespace lr::view {

struct ViewerOptions {
    Input input;                ///< path may be empty
    gpu::CameraOptions camera;  ///< for the first mesh
    double scale = 1;           ///< pixels a nominal pixel
    bool panels = true;
    bool keep_recent = true;        ///< files that were opened are remembered
    std::filesystem::path shaders;  ///< folder of sources to be watched; empty: those that the program was built from
};

class Viewer {
  public:
    static Result<std::unique_ptr<Viewer>> create(gpu::Context& context, const ViewerOptions& options);

    void handle(const Event& event);
    /// Everything for one picture `seconds` after the last one. Nothing is drawn while the picture has no size.
    Result<void> frame(double seconds);

    /// The last picture, panels and all, in VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL.
    const gpu::Image& image() const { return overlay_->image(); }
    VkExtent2D extent() const { return extent_; }
    bool visible() const { return extent_.width != 0 && extent_.height != 0; }
    /// Of the last picture. Waits for the device.
    Result<gpu::Picture> picture();

    bool closing() const { return closing_; }
    /// Nothing moves, nothing is awaited: the next picture would be the last one.
    bool idle() const { return quiet_frames_ > 3 && !busy_ && !(watch_ && watch_->has_news()); }
    /// The mesh as it was drawn is as it will stay, but for what a person does.
    bool settled() const { return settled_; }
    /// "NAME - LacedRing"
    std::string title() const;
    /// What is to be put on the clipboard, once.
    std::string take_clipboard() { return std::exchange(clipboard_, {}); }
    void save(const std::string& path);

    State& state() { return state_; }
    Orbit& orbit() { return orbit_; }
    Scene& scene() { return scene_; }
    /// Null: there are no sources of shaders.
    const ShaderWatch* shaders() const { return watch_.get(); }
    /// From a point of the picture.
    Vector ray(double x, double y) const;
    void redraw() { dirty_ = true; }
    void pick(double x, double y);
    Result<void> frame_all(const gpu::CameraOptions& options);
    Shown shown(bool moving) const;

  private:
    Viewer(gpu::Context& context, const ViewerOptions& options, Scene scene)
        : options_(options), context_(context), scene_(std::move(scene)) {}
    Result<void> resize();
    void take_news();
    void watch_shaders();
    void take_shaders();
    void handle_mouse(const Event& event);
    void handle_key(const Event& event);
    void act();
    void opened(const std::string& path);
    void update_outlines();
    void update_paint();
    void advance(double seconds);
    Result<void> draw();
    void save_turntable();

    ViewerOptions options_;
    gpu::Context& context_;
    Scene scene_;
    std::unique_ptr<Overlay> overlay_;
    std::optional<gpu::Commands> commands_;
    State state_;
    Orbit orbit_;
    Loader loader_;
    std::unique_ptr<ShaderWatch> watch_;
    RingSettings asked_;
    std::vector<std::string> queue_;  // dropped, to be tried in turn

    VkExtent2D extent_{}, made_{};
    std::uint32_t made_samples_ = 0;
    int dragging_ = -1;
    bool dragging_divider_ = false;
    double mouse_x_ = 0, mouse_y_ = 0, press_x_ = 0, press_y_ = 0;
    bool dirty_ = true, compose_ = true, moving_ = false, settled_ = false, closing_ = false, busy_ = false;
    bool drawn_exact_ = false, difference_due_ = false;
    int quiet_frames_ = 0, still_frames_ = 0;
    struct Painted {
        CornerId corner = null_corner;
        Paint paint = Paint::none;
        double growth = 0;
        const Document* document = nullptr;
        bool operator==(const Painted&) const = default;
    } painted_;
    const Tables* outlined_ = nullptr;  // whose outlines are drawn
    std::string clipboard_;
};

}  // namespace lr::view
