#pragma once
// The drawn picture: a model on the device, one or two pictures of it, and these composed into one image of the
// window's size. Knows of no window and no panel.

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

/// What a picture is of.
struct Shown {
    gpu::View view = gpu::View::smooth;
    gpu::Source source = gpu::Source::lean;
    gpu::Path path = gpu::Path::compute;
    Mode mode = Mode::single;   ///< of the two others, the left picture is of Source::plain
    bool exact = true;          ///< as `lacedring render` draws (docs/renderer.md), else in one pass
    std::uint32_t samples = 3;  ///< of a pixel, along each side
    bool decode_again = false;  ///< expands the stream for this picture even if it has been

    bool operator==(const Shown&) const = default;
    int sides() const { return mode == Mode::single ? 1 : 2; }
};

/// Seconds on the device for the last picture.
struct SceneTimes {
    double decode = 0;
    double draw = 0;
};

/// A triangle of the mesh and its RGBA.
struct Mark {
    std::uint32_t triangle;
    std::uint32_t colour;
};

class Scene {
  public:
    /// `wake` is called, by another thread, when something that was awaited is there.
    static Result<Scene> create(gpu::Context& context, std::function<void()> wake);

    /// Pixels of the composed image. Pictures have one sample a pixel, or `samples` along each side; `sides` of them
    /// are drawn. What was drawn stays where these are the same.
    Result<void> resize(VkExtent2D extent, std::uint32_t samples, int sides);
    /// Takes another model once what `shown` needs of it is on the device: true. Until then, and if that fails, all
    /// stays as it is. Colours stay in any case: those of another mesh have to be taken away. Errors: those of prepare.
    Result<bool> adopt(const std::shared_ptr<const OwningModel>& model, const Shown& shown);
    const OwningModel* model() const { return model_.get(); }
    /// Draws outlines over the surface, asked of these LR tables of the model's surface; null: none.
    /// Edges at which the surface turns by more than `crease` degrees are among them.
    Result<void> set_outlines(const EncodedLr* tables, double crease);
    /// RGBA a triangle of the mesh, to be laid over it; empty: none. Not while a frame is being drawn.
    Result<void> set_paint(std::span<const std::uint32_t> colours);
    /// Colours of single triangles over those of set_paint, in the place of those set before. Likewise.
    Result<void> set_marks(std::span<const Mark> marks);
    /// A triangle of the mesh each, whose sides of the ring a line parts, under both; empty: none. `colours`: laid over
    /// the surface, too. Likewise.
    Result<void> set_sides(std::span<const gpu::GrowthTriangle> triangles, bool colours);
    /// How far it has grown, and how many of the last triangles are told from the others.
    void grow(std::uint32_t invaded, std::uint32_t fresh);

    /// Makes every pipeline anew, of the context's shaders as they are now. If one cannot be made, nothing changes.
    /// Waits for the device.
    Result<void> reload();

    /// Has what the picture needs put on the device, beside this thread; true once it is there. Errors: unsupported (a
    /// stream that the model does not have), and the device's.
    Result<bool> prepare(const Shown& shown);
    /// Stops putting models on the device for good. False: that still goes on after `patience`.
    bool stop(std::chrono::milliseconds patience) { return uploader_->stop(patience); }
    /// Nothing has been drawn since the last resize: compose cannot be recorded.
    bool blank() const { return blank_; }
    /// Records an empty picture, to be composed.
    void record_clear(VkCommandBuffer commands);
    /// Records the drawing of what was prepared, of a model, and leaves the pictures to be composed.
    Result<void> record_draw(VkCommandBuffer commands, const Shown& shown, const gpu::CameraOptions& camera);
    /// Records putting them together. `divider`: first column of the right picture.
    Result<void> record_compose(VkCommandBuffer commands, std::uint32_t divider);
    /// The last picture.
    const Shown& drawn() const { return drawn_; }
    /// Materials of the picture drawn last; null: it was drawn without them.
    const gpu::GpuMaterials* materials() const;
    /// The ring's line is laid over it: its edges are long enough.
    bool has_ring_line() const;

    /// In VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL once composed.
    const gpu::Image& composed() const { return composed_; }
    VkExtent2D extent() const { return extent_; }

    /// Of the last record_draw whose commands have run. None without timestamps.
    std::optional<SceneTimes> times() const;
    /// The original triangle at a pixel of the picture drawn last, if any. Waits for the device.
    Result<std::optional<std::uint32_t>> triangle_at(std::uint32_t x, std::uint32_t y, bool right);
    /// Of the two pictures drawn last, mode split or difference. Waits for the device.
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
    /// Makes the buffer so large, if it is not, and mapped.
    Result<void> hold(gpu::Buffer& buffer, const char* name, std::size_t bytes);
    Result<VkPipeline> compose_pipeline();

    gpu::Context* context_ = nullptr;
    std::optional<gpu::Commands> commands_;
    std::optional<gpu::Transfer> transfer_;
    std::unique_ptr<gpu::Expander> expander_;  // stays where it is: the uploader knows it
    gpu::Layout layout_;
    std::map<std::array<std::uint32_t, 3>, gpu::PipelineHandle> compose_;  // by its constants
    gpu::QueryPoolHandle queries_;
    bool timed_ = false;

    std::optional<gpu::Silhouettes> silhouettes_;
    std::optional<gpu::Adjacency> adjacency_;
    double crease_ = 0;
    std::shared_ptr<const OwningModel> model_;
    std::map<std::pair<gpu::View, std::uint32_t>, gpu::Painter> painters_;  // by samples
    Entries entries_;
    Entries adopted_;  // of the model that is to be taken
    std::shared_ptr<const OwningModel> adopting_;

    VkExtent2D extent_{};
    /// The pictures of one number of samples.
    struct Sides {
        std::optional<gpu::Target> targets[2];
        VkDescriptorSet sets[2] = {};  ///< for composing the left picture alone, and both
    };
    std::map<std::uint32_t, Sides> sides_;
    gpu::Image composed_;
    gpu::Buffer paint_, growth_, pixel_;
    bool painted_ = false, coloured_ = false, grows_ = false, parted_ = false, blank_ = true;
    std::vector<Mark> under_marks_;  // what set_marks covered
    std::uint32_t invaded_ = 0, fresh_ = 0;
    double edge_pixels_ = 0;  // of a mean edge, in the picture drawn last
    Shown drawn_;
    gpu::Descriptors descriptors_;
    std::unique_ptr<Uploader> uploader_;  // goes first
};

}  // namespace lacedring::view
