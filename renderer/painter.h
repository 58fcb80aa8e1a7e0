#pragma once
// The passes that make one picture.

#include <optional>
#include <string_view>
#include <vector>

#include "renderer/camera.h"
#include "renderer/gpu_mesh.h"
#include "renderer/pipeline.h"
#include "renderer/target.h"

namespace lr::gpu {

enum class View : std::uint32_t {
    smooth = LR_VIEW_SMOOTH,         ///< interpolated normals
    flat = LR_VIEW_FLAT,             ///< the triangles' own normals
    triangle_class = LR_VIEW_CLASS,  ///< what each triangle is to the ring, and the ring
    ring = LR_VIEW_RING,             ///< the vertices' order along the ring, and the ring
    wire = LR_VIEW_WIRE,             ///< flat, and the triangles' edges
    offsets = LR_VIEW_OFFSETS,       ///< significant bits of each triangle's offset along the ring, and the ring
};
/// What a view needs on the device beside the triangles.
UploadOptions upload_options(View view);
/// "smooth", "flat", "class", "ring", "wire", "offsets"
std::optional<View> view_named(std::string_view name);

/// A mesh ready to be drawn: one descriptor set a draw command.
struct DrawPlan {
    std::vector<VkDescriptorSet> sets;
};

class Painter {
  public:
    /// Makes the pipelines of one view. `samples` is the supersampling of its pictures: lines get that much wider.
    static Result<Painter> create(Context& context, View view, std::uint32_t samples);

    Result<DrawPlan> plan(Descriptors& descriptors, const GpuMesh& mesh, const Target& target) const;

    /// What the next pictures are taken with. Not while one is being drawn.
    void set_frame(const Model& model, const Camera& camera);

    /// How triangles of the same depth at a pixel are told apart.
    enum class Ties {
        first_drawn,  ///< one pass, depth LESS: depends on the order of triangles
        by_number,    ///< the smallest original triangle, in three passes (docs/renderer.md)
    };
    /// Records everything from clearing to the last line; the mesh's index buffer and commands must be visible.
    void record(VkCommandBuffer commands, const GpuMesh& mesh, const DrawPlan& plan, const Target& target,
                Ties ties) const;

  private:
    void draw_triangles(VkCommandBuffer commands, VkPipeline pipeline, const GpuMesh& mesh, const DrawPlan& plan) const;
    void draw_lines(VkCommandBuffer commands, const GpuMesh& mesh, const DrawPlan& plan) const;

    Context* context_ = nullptr;
    View view_ = View::smooth;
    std::uint32_t samples_ = 1;
    float line_width_ = 1;
    Layout layout_;
    PipelineHandle depth_, claim_, resolve_, single_, lines_;
    Buffer frame_;
    Buffer nothing_;  // bound where a mesh has no such buffer
};

}  // namespace lr::gpu
