#pragma once
// The passes that make one picture.

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
    /// For pictures of one view. `samples` is the supersampling of its pictures: lines get that much wider. `outlined`:
    /// Silhouettes (adjacency.h) are drawn over it.
    static Result<Painter> create(Context& context, View view, std::uint32_t samples, bool outlined = false);

    /// Another one for the same pictures and meshes, of shaders as they are now. What was planned by this one is not
    /// for that one.
    Result<Painter> again() const;

    /// Makes the pipelines of the mesh's source and path, too, if this is the first mesh that needs them.
    Result<DrawPlan> plan(Descriptors& descriptors, const GpuMesh& mesh, const Target& target);

    /// What the next pictures of that target are taken with. Not while one is being drawn.
    void set_frame(const Model& model, const Camera& camera, const Target& target);

    /// How triangles of the same depth at a pixel are told apart.
    enum class Ties {
        first_drawn,  ///< one pass, depth LESS: depends on the order of triangles
        by_number,    ///< the smallest original triangle, in three passes (docs/renderer.md)
    };
    /// Records everything from clearing to the last line; what the mesh is drawn from must be visible.
    void record(VkCommandBuffer commands, const GpuMesh& mesh, const DrawPlan& plan, const Target& target,
                Ties ties) const;

  private:
    /// Source and path of a mesh, and whether it has pulls_copies().
    using SurfaceKey = std::tuple<Source, Path, bool>;
    static SurfaceKey key_of(const GpuMesh& mesh) { return {mesh.source, mesh.path, mesh.pulls_copies()}; }
    /// The mesh has pulls_positions(), pulls_copies().
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
    Buffer nothing_;  // bound where a mesh has no such buffer
};

}  // namespace lacedring::gpu
