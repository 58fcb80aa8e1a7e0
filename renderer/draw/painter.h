#pragma once
// Records the passes that draw one frame.

#include <map>
#include <tuple>
#include <utility>

#include "renderer/draw/camera.h"
#include "renderer/draw/surface.h"
#include "renderer/draw/target.h"
#include "renderer/draw/view.h"
#include "renderer/mesh/gpu_mesh.h"
#include "renderer/vk/pipeline.h"

namespace lacedring::gpu {

class Painter {
  public:
    /// Draws frames of one view. `samples`: samples per pixel along each side; lines get wider by this factor.
    /// `outlined`: Silhouettes (adjacency.h) will be drawn over the surface.
    static Result<Painter> create(Context& context, View view, std::uint32_t samples, bool outlined = false);

    /// Returns a new Painter whose pipelines are recreated from the current shaders. DrawPlans of this painter are not
    /// valid for the new one.
    Result<Painter> again() const;

    /// Allocates the descriptor sets that draw the mesh; creates the pipelines of its source and path at first use.
    Result<DrawPlan> plan(Descriptors& descriptors, const GpuMesh& mesh, const Target& target);

    /// Sets camera and line style of the next frames drawn to `target`. Must not be called while the device draws one.
    void set_frame(const Model& model, const Camera& camera, const Target& target);

    /// Which of several triangles with the same depth a pixel shows.
    enum class Ties {
        first_drawn,  ///< the first drawn: one pass, depth test LESS; depends on the order of triangles
        by_number,    ///< the one with the smallest original number: three passes (docs/renderer.md)
    };
    /// Records the whole frame: clearing, surface and lines. Earlier writes to the mesh's buffers must be visible.
    void record(VkCommandBuffer commands, const GpuMesh& mesh, const DrawPlan& plan, const Target& target,
                Ties ties) const;

  private:
    /// Source, path and pulls_copies() of a mesh.
    using SurfaceKey = std::tuple<Source, Path, bool>;
    static SurfaceKey key_of(const GpuMesh& mesh) { return {mesh.source, mesh.path, mesh.pulls_copies()}; }
    /// pulls_positions() of a mesh, and pulls_copies() if it pulls positions.
    using LineKey = std::pair<bool, bool>;
    static LineKey line_key_of(const GpuMesh& mesh) {
        return {mesh.pulls_positions(), mesh.pulls_positions() && mesh.pulls_copies()};
    }

    Result<void> make_surface(const SurfaceKey& key);
    Result<void> make_lines(const LineKey& key);
    void draw_lines(VkCommandBuffer commands, const GpuMesh& mesh, const DrawPlan& plan) const;

    Context* context_ = nullptr;
    View view_ = View::smooth;
    std::uint32_t samples_ = 1;
    bool outlined_ = false;
    float line_width_ = 1;
    Layout layout_;
    std::map<SurfaceKey, Surface> surfaces_;
    std::map<LineKey, PipelineHandle> lines_;
    Buffer frame_;
    Buffer nothing_;  // bound in place of a buffer that the mesh does not have
};

}  // namespace lacedring::gpu
