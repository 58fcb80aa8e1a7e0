#pragma once
// The drawn picture: a model on the device, and one or two pictures of it, composed into one image of the window's
// size. Independent of the window and the panels.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "app/view/session/uploader.h"
#include "lacedring/lacedring.hpp"
#include "renderer/draw/adjacency.h"
#include "renderer/draw/renderer.h"
#include "shaders/viewer/compose_shared.h"

namespace lacedring::view {

enum class Mode { single, split, difference };

/// Settings of one picture: view, source and display options.
struct Shown {
    gpu::View view = gpu::View::smooth;
    gpu::Source source = gpu::Source::lean;
    gpu::Path path = gpu::Path::compute;
    /// In the modes split and difference, the left picture is of Source::plain.
    Mode mode = Mode::single;
    /// Draw exactly as `lacedring render` does (docs/renderer.md); else in one pass.
    bool exact = true;
    std::uint32_t samples = 3;  ///< along each side of a pixel
    /// Expand the stream again for this picture.
    bool decode_again = false;

    bool operator==(const Shown&) const = default;
    int sides() const { return mode == Mode::single ? 1 : 2; }
};

/// Seconds on the device for the last picture.
struct SceneTimes {
    double decode = 0;
    double draw = 0;
};

/// A triangle of the mesh, and its color as RGBA.
struct Mark {
    std::uint32_t triangle;
    std::uint32_t color;
};

class Scene {
  public:
    /// `wake` is called by another thread when an upload is done.
    static Result<Scene> create(gpu::Context& context, std::function<void()> wake);

    /// Makes the images: the composed one of `extent` pixels, and `sides` pictures with 1 sample per pixel, and with
    /// `samples` along each side of a pixel. Keeps images whose size does not change.
    Result<void> resize(VkExtent2D extent, std::uint32_t samples, int sides);
    /// Switches to `model` once the parts that `shown` needs are on the device; returns whether it has. Until then, and
    /// on failure, the scene is unchanged. Keeps paint, marks and sides: clear those of another mesh. Errors: those of
    /// prepare.
    Result<bool> adopt(const std::shared_ptr<const OwningModel>& model, const Shown& shown);
    const OwningModel* model() const { return model_.get(); }
    /// Draws outlines over the surface, found with the LR tables of the model's surface; null: none. Outlines include
    /// edges where the surface turns by more than `crease` degrees.
    Result<void> set_outlines(const EncodedLr* tables, double crease);
    // Layers over the surface. Do not set them while a frame is being drawn.
    /// Sets the paint: RGBA per triangle of the mesh; empty: none.
    Result<void> set_paint(std::span<const std::uint32_t> colors);
    /// Sets the colors of single triangles, over the paint. Replaces all earlier marks.
    Result<void> set_marks(std::span<const Mark> marks);
    /// Sets the side of the ring of each triangle of the mesh, under paint and marks; empty: none. A line separates the
    /// sides; `colors`: the sides are also colored.
    Result<void> set_sides(std::span<const gpu::GrowthTriangle> triangles, bool colors);
    /// Sets how many triangles are invaded, and how many of the last ones are highlighted.
    void grow(std::uint32_t invaded, std::uint32_t fresh);

    /// Recreates all pipelines from the context's current shaders. If one fails, nothing changes. Waits for the device.
    Result<void> reload();

    /// Starts uploading what the picture needs, on a thread; returns whether all of it is on the device. Errors:
    /// unsupported (the model lacks the stream), those of the device.
    Result<bool> prepare(const Shown& shown);
    /// Stops uploading for good. Returns false if an upload still runs after `patience`.
    bool stop(std::chrono::milliseconds patience) { return uploader_->stop(patience); }
    /// Nothing has been drawn since the last resize: compose cannot be recorded.
    bool blank() const { return blank_; }
    /// Records drawing an empty picture.
    void record_clear(VkCommandBuffer commands);
    /// Records drawing the prepared pictures of the model.
    Result<void> record_draw(VkCommandBuffer commands, const Shown& shown, const gpu::CameraOptions& camera);
    /// Records composing the pictures. `divider`: first column of the right picture.
    Result<void> record_compose(VkCommandBuffer commands, std::uint32_t divider);
    /// The picture drawn last.
    const Shown& drawn() const { return drawn_; }
    /// Materials of the picture drawn last; null: drawn without materials.
    const gpu::GpuMaterials* materials() const;
    /// Returns whether the ring's line is drawn over the picture. Meshes with very short edges are drawn without it.
    bool has_ring_line() const;

    /// The composed image; in VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL once composed.
    const gpu::Image& composed() const { return composed_; }
    VkExtent2D extent() const { return extent_; }

    /// Times of the last record_draw whose commands have run; empty if the device has no timestamps.
    std::optional<SceneTimes> times() const;
    /// The mesh's triangle at a pixel of the picture drawn last, if any. Waits for the device.
    Result<std::optional<std::uint32_t>> triangle_at(std::uint32_t x, std::uint32_t y, bool right);
    /// Compares the two pictures drawn last (Mode::split or difference). Waits for the device.
    Result<gpu::Difference> difference();

  private:
    struct Plan {
        gpu::Descriptors descriptors;
        gpu::DrawPlan draw;
    };
    struct Entry {
        UploadedMesh mesh;
        std::map<std::tuple<gpu::View, std::uint32_t, int>, Plan> plans;  // by view, samples and side
    };

    using Entries = std::map<UploadKey, Entry>;
    Result<bool> upload(const std::shared_ptr<const OwningModel>& model, const Shown& shown, Entries& entries);
    Result<gpu::Painter*> painter(gpu::View view, std::uint32_t samples);
    static UploadKey key_of(const Shown& shown, int side);
    Result<void> write_sets();
    /// Makes the buffer at least `bytes` large, and mapped.
    Result<void> hold(gpu::Buffer& buffer, const char* name, std::size_t bytes);
    Result<VkPipeline> compose_pipeline();

    gpu::Context* context_ = nullptr;
    std::optional<gpu::Commands> commands_;
    std::optional<gpu::Transfer> transfer_;
    std::unique_ptr<gpu::Expander> expander_;  // must not move: the uploader refers to it
    gpu::Layout layout_;
    std::map<std::array<std::uint32_t, 3>, gpu::PipelineHandle> compose_;  // by its specialization constants
    gpu::QueryPoolHandle queries_;
    bool timed_ = false;

    std::optional<gpu::Silhouettes> silhouettes_;
    std::optional<gpu::Adjacency> adjacency_;
    double crease_ = 0;
    std::shared_ptr<const OwningModel> model_;
    std::map<std::pair<gpu::View, std::uint32_t>, gpu::Painter> painters_;  // by view and samples
    Entries entries_;                                                       // of model_
    Entries adopted_;                                                       // of adopting_
    std::shared_ptr<const OwningModel> adopting_;                           // the model to switch to

    VkExtent2D extent_{};
    /// The pictures drawn with a given number of samples per pixel.
    struct Sides {
        std::optional<gpu::Target> targets[2];
        VkDescriptorSet sets[2] = {};  ///< for composing one picture; two
    };
    std::map<std::uint32_t, Sides> sides_;
    gpu::Image composed_;
    gpu::Buffer paint_, growth_, pixel_;
    bool painted_ = false, colored_ = false, grows_ = false, parted_ = false, blank_ = true;
    std::vector<Mark> under_marks_;  // the paint under the marks
    std::uint32_t invaded_ = 0, fresh_ = 0;
    // Mean length of an edge in the picture drawn last.
    double edge_pixels_ = 0;
    Shown drawn_;
    gpu::Descriptors descriptors_;
    std::unique_ptr<Uploader> uploader_;  // last member: destroyed first
};

}  // namespace lacedring::view
