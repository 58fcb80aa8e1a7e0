#pragma once
// The drawn picture: a model on the device, one or two pictures of it, and these composed into one image of the
// window's size. Knows of no window and no panel.

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>

#include "renderer/adjacency.h"
#include "renderer/renderer.h"
#include "shaders/compose_shared.h"

namespace lr::view {

enum class Mode { single, split, difference };

/// What a picture is of.
struct Shown {
    gpu::View view = gpu::View::smooth;
    gpu::Source source = gpu::Source::lean;
    gpu::Path path = gpu::Path::compute;
    Mode mode = Mode::single;   ///< of the two others, the left picture is of Source::plain
    bool exact = true;          ///< as `lacedring render` draws (docs/renderer.md), else in one pass
    bool decode_again = false;  ///< expands the stream for this picture even if it has been
};

/// Seconds on the device for the last picture.
struct SceneTimes {
    double decode = 0;
    double draw = 0;
};

class Scene {
  public:
    static Result<Scene> create(gpu::Context& context);

    /// Pixels of the composed image, and how many samples a pixel has along each side.
    Result<void> resize(VkExtent2D extent, std::uint32_t samples);
    /// Drops what was made of another model. Null: nothing is drawn.
    Result<void> set_model(std::shared_ptr<const gpu::Model> model);
    const gpu::Model* model() const { return model_.get(); }
    /// Draws outlines over the surface, asked of these LR tables of the model's mesh; null: none.
    Result<void> set_outlines(const EncodedLr* tables);
    /// RGBA a triangle of the mesh, to be laid over it; empty: none. Not while a frame is being drawn.
    Result<void> set_paint(std::span<const std::uint32_t> colours);

    /// Puts on the device what the picture needs and is not there. Errors: unsupported (a stream that the model does
    /// not have), and the device's.
    Result<void> prepare(const Shown& shown);
    /// Records the drawing of what was prepared, and leaves both pictures to be composed.
    Result<void> record_draw(VkCommandBuffer commands, const Shown& shown, const gpu::CameraOptions& camera);
    /// Records putting them together. `divider`: first column of the right picture.
    void record_compose(VkCommandBuffer commands, Mode mode, std::uint32_t divider) const;

    /// In VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL once composed.
    const gpu::Image& composed() const { return composed_; }
    VkExtent2D extent() const { return extent_; }

    /// Of the last record_draw whose commands have run. None without timestamps.
    std::optional<SceneTimes> times() const;
    /// The original triangle at a pixel of the picture drawn last, if any. Waits for the device.
    Result<std::optional<std::uint32_t>> triangle_at(std::uint32_t x, std::uint32_t y, bool right);
    /// Of the two pictures drawn last, mode split or difference. Waits for the device.
    Result<gpu::Difference> difference(const gpu::CameraOptions& camera, const Shown& shown);

  private:
    enum class Kind { ring, offsets, edges };
    static Kind kind_of(gpu::View view);
    using Key = std::tuple<gpu::Source, gpu::Path, Kind>;
    struct Plan {
        gpu::Descriptors descriptors;
        gpu::DrawPlan draw;
    };
    struct Entry {
        gpu::Drawable drawable;
        std::map<std::pair<gpu::View, int>, Plan> plans;  // by side
    };

    Result<Entry> upload(const Key& key);
    Result<gpu::Painter*> painter(gpu::View view);
    Result<void> draw_side(VkCommandBuffer commands, int side, const Shown& shown);
    static Key key_of(const Shown& shown, int side);
    Result<void> write_sets();

    gpu::Context* context_ = nullptr;
    std::optional<gpu::Commands> commands_;
    std::optional<gpu::Transfer> transfer_;
    gpu::Expander expander_;
    gpu::Layout layout_;
    gpu::PipelineHandle compose_;
    gpu::QueryPoolHandle queries_;
    bool timed_ = false;

    std::optional<gpu::Silhouettes> silhouettes_;
    std::optional<gpu::Adjacency> adjacency_;
    std::shared_ptr<const gpu::Model> model_;
    std::map<gpu::View, gpu::Painter> painters_;
    std::map<Key, Entry> entries_;

    VkExtent2D extent_{};
    std::uint32_t samples_ = 1;
    std::optional<gpu::Target> targets_[2];
    gpu::Image composed_;
    gpu::Buffer paint_, pixel_;
    bool painted_ = false;
    gpu::View view_ = gpu::View::smooth;  // drawn last
    gpu::Descriptors descriptors_;
    VkDescriptorSet sets_[2] = {};  // the left picture alone; both
};

}  // namespace lr::view
